#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "canyon/core/model_choice.h"
#include "canyon/core/need.h"
#include "canyon/gnss/satellites/constellation.h"

namespace canyon::gnss {

/// Error of the broadcast orbit and satellite clock, as it acts on the corrected range of a receiver: with dr =
/// broadcast minus true position, dT the same of the clock and u the line of sight from receiver to satellite, c dT - u
/// . dr.
class EphemerisError {
 public:
  virtual ~EphemerisError() = default;
  /// `satellite`: true, at transmission; receiver_E in E.
  virtual double range_m(SatelliteId sv, const SatelliteState& satellite, const Eigen::Vector3d& receiver_E,
                         GpsTime t) const = 0;
};

/// What models are built from beside their own keys.
struct EphemerisErrorSetup {
  std::uint64_t seed = 0;
  std::shared_ptr<const Constellation> satellites{};  ///< those of the sensor
  std::string systems{};                              ///< their systems' RINEX letters
  bool broadcast = false;                             ///< they are of navigation files
  std::vector<std::string>* warnings = nullptr;
};

/// The largest range error that a model gives, in either direction, m; of random ones that of
/// GaussMarkov::kMostSigmas.
using LargestEphemerisError = double(const ModelParameters& own);

using MakeEphemerisError =
    MakerAndNeed<Result<std::unique_ptr<EphemerisError>>(const ModelParameters& own, const EphemerisErrorSetup& at),
                 LargestEphemerisError>;
ModelTable<MakeEphemerisError> ephemeris_error_models();

std::unique_ptr<EphemerisError> make_gauss_markov_ephemeris(std::uint64_t seed, double sigma_m, double tau_s);
std::unique_ptr<EphemerisError> make_orbit_clock_2010(std::uint64_t seed);
std::unique_ptr<EphemerisError> make_orbit_clock_2021(std::uint64_t seed);
std::unique_ptr<EphemerisError> make_paper_printed_ephemeris();
std::unique_ptr<EphemerisError> make_paper_corrected_ephemeris();
Result<std::unique_ptr<EphemerisError>> make_gauss_markov(const ModelParameters& own, const EphemerisErrorSetup& at);
void gauss_markov_parameters(ModelParameters& section);
LargestEphemerisError largest_gauss_markov_m, largest_orbit_clock_2010_m, largest_orbit_clock_2021_m;
Result<std::unique_ptr<EphemerisError>> make_broadcast_minus_sp3(const ModelParameters& own,
                                                                 const EphemerisErrorSetup& at);
void broadcast_minus_sp3_parameters(ModelParameters& section);

}  // namespace canyon::gnss
