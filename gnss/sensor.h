#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/messages.h"
#include "core/result.h"
#include "core/truth.h"
#include "scene/scene_at.h"

namespace canyon::gnss {

/// What one due GNSS epoch gives: messages, and the parallel truth record.
struct GnssOutput {
  GnssEpoch epoch;  ///< empty for models that do not form pseudoranges
  GnssFix fix;
  GnssTruth truth;
};

/// Work done, for reports of cost and of what was left out.
struct GnssCounters {
  std::int64_t epochs = 0;
  std::int64_t occlusion_rays = 0;
  std::int64_t facets_tested = 0;
  std::int64_t reflected_paths = 0;
};

/// A GNSS receiver in the scene. `index` is the number of the epoch since the start (the random streams' sample index).
class GnssSensor {
 public:
  virtual ~GnssSensor() = default;
  virtual GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& v_A_W,
                             const scene::SceneAt& scene) = 0;
  virtual GnssCounters counters() const = 0;
};

/// [gnss] of a mission file. Each `choice` names a row of that effect's table.
struct GnssConfig {
  std::string model = "pseudorange";  ///< pseudorange | truth_plus_isotropic (the paper's low fidelity)
  double rate_hz = 2.0;
  double mask_deg = 10.0;
  Eigen::Vector3d lever_arm_m{-0.3, 0.0, 1.2};  ///< antenna in B

  // truth_plus_isotropic
  double isotropic_min_m = 0.3;
  double isotropic_max_m = 0.5;
  double isotropic_sigma_m = 0.23;  ///< what the fix claims per axis: sqrt(mean square / 3)

  // pseudorange
  std::string mode = "dgps";             ///< single | dgps
  double baseline_km = 5.0;              ///< distance of the base station, dgps
  std::string ionosphere = "single_layer";
  double vtec_tecu = 12.0;
  std::string troposphere = "saastamoinen_niell";
  double pressure_hpa = 1022.0;
  double temperature_c = 12.8;
  double relative_humidity = 0.80;
  std::string ephemeris_error = "gauss_markov";
  std::string paths = "specular1";       ///< none | visibility | specular1
  std::string multipath_rule = "paper_first_return";
  double cutoff_ns = 150.0;
  double code_noise_m = 0.3;             ///< 1-sigma at zenith-like C/N0 of 45 dB-Hz
  std::string solver = "least_squares";
  double solver_sigma_m = 0.5;           ///< assumed 1-sigma of a corrected pseudorange at zenith
  std::string nav_file;                  ///< RINEX navigation file; empty = built-in 24-slot constellation
};
void visit(FieldVisitor& f, GnssConfig& c);

/// Builds the configured sensor: reads the navigation file if one is named and checks that it covers [start, end].
Result<std::unique_ptr<GnssSensor>> make_gnss_sensor(const GnssConfig& config, std::uint64_t seed, GpsTime start, GpsTime end,
                                                     const scene::Scene& scene);

}  // namespace canyon::gnss
