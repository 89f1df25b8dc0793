#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/core/truth.h"
#include "canyon/scene/scene_at.h"

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
  std::int64_t path_searches = 0;  ///< for the ways of one signal to one place of the antenna
  std::int64_t facets_tested = 0;
  std::int64_t reflected_paths = 0;
  std::int64_t diffracted_paths = 0;
};

/// A GNSS receiver in the scene. `index` is the number of the epoch since the start (the random streams' sample index).
///
/// A receiver has a memory: locks held, cycles counted. Epochs are measured in order, one index after the other, and
/// what measure() returns depends on its arguments and on the epochs since the receiver was last switched on, nothing
/// else. An index that does not follow the last one switches it on anew, as one that has been running for long: all
/// that can be tracked is in lock. So an epoch measured alone, or first, depends on its arguments alone, and a sequence
/// measured again gives the same bits. All errors that do not need memory (noise, clocks, delays) are functions of
/// seed, satellite and index or time, whatever was asked before. A sensor serves one vehicle; it is not thread-safe.
class GnssSensor {
 public:
  virtual ~GnssSensor() = default;
  virtual GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& v_A_W,
                             const scene::SceneAt& scene) = 0;
  virtual GnssCounters counters() const = 0;
  /// False where fixes come without satellites: counts of them and DOP jumps are then undefined.
  virtual bool has_satellites() const { return false; }
  /// What a user should be told once: damaged records of the navigation file that were skipped, one line each.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// [gnss] of a mission file. Each `choice` names a row of that effect's table.
struct GnssConfig {
  std::string model = "pseudorange";  ///< a row of sensor_models(); truth_plus_isotropic is the paper's low fidelity
  double rate_hz = 2.0;
  double mask_deg = 10.0;
  Eigen::Vector3d lever_arm_m{-0.3, 0.0, 1.2};  ///< antenna in B

  // truth_plus_isotropic
  double isotropic_min_m = 0.3;
  double isotropic_max_m = 0.5;
  double isotropic_sigma_m = 0.23;  ///< what the fix claims per axis: sqrt(mean square / 3)

  // truth_plus_white
  double white_sigma_m = 1.0;     ///< per horizontal axis
  double white_sigma_up_m = 2.0;  ///< vertical

  // satellite_count: three sigmas per axis
  double count_noise_max_m = 10.0;  ///< with four satellites
  double count_noise_min_m = 2.0;   ///< with twelve or more

  // pseudorange: what acts on the range, and what the receiver corrects
  std::string mode = "dgps";                    ///< a row of receiver_modes()
  double baseline_km = 5.0;                     ///< distance of the base station, dgps
  double ionosphere_gradient_mm_per_km = 2.0;   ///< 1-sigma of the vertical delay's difference to the base, dgps
  double troposphere_gradient_mm_per_km = 1.0;  ///< the same for the zenith wet delay
  double base_error_scale = 1.0;                ///< base station's own code noise and multipath, 1 = GAD-B; dgps
  std::string ionosphere = "single_layer";
  double vtec_tecu = 12.0;
  std::string ionosphere_correction = "half";  ///< what the receiver subtracts in mode single
  std::string troposphere = "saastamoinen_niell";
  double pressure_hpa = 1022.0;
  double temperature_c = 12.8;
  double relative_humidity = 0.80;
  double weather_height_m = 0.0;  ///< where these three hold
  std::string ephemeris_error = "gauss_markov";
  double ephemeris_sigma_m = 1.0;
  double ephemeris_tau_s = 3600.0;
  std::string receiver_clock = "tcxo";

  // pseudorange: propagation in the scene and reception
  std::string paths = "specular1";   ///< none | visibility | specular1 | specular2 | specular3 | launching
  std::string diffraction = "none";  ///< none | knife_edge | double_knife_edge
  bool ground_reflection = false;
  double surface_roughness_m = 0.0;  ///< standard deviation of the reflecting surfaces' height
  double foliage_db_per_m = 0.25;
  double foliage_max_db = 28.0;
  std::string multipath_rule = "paper_first_return";
  double cutoff_ns = 150.0;

  // pseudorange: antenna and receiver
  double cn0_zenith_dbhz = 45.0;
  std::string antenna = "sine";
  double antenna_horizon_loss_db = 7.0;
  double lhcp_rejection_db = 10.0;
  bool antenna_phase_centre = false;
  std::string modulation = "auto";        ///< auto | a name of modulation_names()
  std::string second_frequency = "L2";    ///< mode dual: L2 | L5
  std::string correlator = "early_late";  ///< early_late | double_delta
  std::string discriminator = "power";    ///< power | coherent
  double correlator_spacing_chips = 0.5;
  double front_end_mhz = 0.0;
  double code_loop_hz = 0.13;  ///< carrier-aided: 0.3 m of noise at 45 dB-Hz and half a chip
  double carrier_loop_hz = 15.0;
  double integration_ms = 20.0;
  double thermal_noise_scale = 1.0;
  double tracking_threshold_dbhz = 25.0;
  double reacquisition_margin_db = 3.0;
  double reacquisition_s = 1.0;

  // pseudorange: position
  std::string solver = "least_squares";
  std::string weighting = "elevation";  ///< a row of range_weightings()
  std::string raim = "none";            ///< a row of fault_exclusions()
  double raim_false_alarm = 1e-3;
  double solver_sigma_m = 0.5;  ///< assumed 1-sigma of a corrected pseudorange at zenith
  double max_gdop = 100.0;
  std::string estimator = "least_squares";   ///< least_squares | kalman
  double estimator_acceleration_m_s2 = 2.0;  ///< kalman: white acceleration per axis, m/s^2/sqrt(Hz)
  std::string systems = "G";                 ///< RINEX letters of the systems received
  std::string nav_file;                      ///< RINEX navigation file; none at all = built-in constellation
  std::vector<std::string> nav_files;        ///< further ones
  std::string almanac_file;                  ///< YUMA or SEM, for satellites that have no ephemeris
  std::string ionex_file;                    ///< maps, for ionosphere ionex
  std::vector<std::string> sp3_files;        ///< precise orbits, for ephemeris_error broadcast_minus_sp3
  std::string antex_file;                    ///< satellite antennas, for the same
};
void visit(FieldVisitor& f, GnssConfig& c);

/// Index of the epoch `t_s` after the start, in steps of the configured rate. Epochs looked at hours apart are not
/// consecutive, so each finds the receiver running, not still to regain what was hidden an hour ago.
std::int64_t epoch_index(const GnssConfig& config, double t_s);

/// Builds the configured sensor: reads the navigation file if one is named and checks that it covers [start, end].
Result<std::unique_ptr<GnssSensor>> make_gnss_sensor(const GnssConfig& config, std::uint64_t seed, GpsTime start,
                                                     GpsTime end, const scene::Scene& scene);

}  // namespace canyon::gnss
