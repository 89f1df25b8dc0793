#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "canyon/core/model_table.h"
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

struct EphemerisErrorParameters {
  std::uint64_t seed = 0;
  double sigma_m = 1.0;   ///< gauss_markov
  double tau_s = 3600.0;  ///< gauss_markov
  /// broadcast_minus_sp3: what is compared.
  std::shared_ptr<const Constellation> broadcast{}, precise{};
};

using MakeEphemerisError = std::unique_ptr<EphemerisError>(const EphemerisErrorParameters&);
std::span<const ModelRow<MakeEphemerisError>> ephemeris_error_models();

std::unique_ptr<EphemerisError> make_gauss_markov_ephemeris(const EphemerisErrorParameters& p);
std::unique_ptr<EphemerisError> make_orbit_clock_2010(const EphemerisErrorParameters& p);
std::unique_ptr<EphemerisError> make_orbit_clock_2021(const EphemerisErrorParameters& p);
std::unique_ptr<EphemerisError> make_measured_ephemeris(const EphemerisErrorParameters& p);
std::unique_ptr<EphemerisError> make_paper_printed_ephemeris(const EphemerisErrorParameters& p);
std::unique_ptr<EphemerisError> make_paper_corrected_ephemeris(const EphemerisErrorParameters& p);

}  // namespace canyon::gnss
