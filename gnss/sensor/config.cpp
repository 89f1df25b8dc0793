#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/troposphere.h"
#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/paths/diffraction/diffraction.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/receiver/code_correlation.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"
#include "canyon/gnss/receiver/multipath_rule.h"
#include "canyon/gnss/receiver/receiver_antenna.h"
#include "canyon/gnss/receiver/receiver_clock.h"
#include "canyon/gnss/sensor/sensor_models.h"
#include "canyon/gnss/solver/fault_exclusion.h"
#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/solver/weighting.h"

namespace canyon::gnss {

void visit(FieldVisitor& f, GnssConfig& c) {
  f.choice("model", c.model, model_names(sensor_models()), "how a fix is made");
  f.number("rate_hz", c.rate_hz, {0.01, 50.0}, "fixes per second");
  f.number("mask_deg", c.mask_deg, {0.0, 60.0}, "satellites below this elevation are not used");
  f.vector3("lever_arm_m", c.lever_arm_m, {-50.0, 50.0}, "antenna in the vehicle's frame B (x forward, y left, z up)");

  f.number("isotropic_min_m", c.isotropic_min_m, {0.0, 1e4}, "truth_plus_isotropic: shortest error");
  f.number("isotropic_max_m", c.isotropic_max_m, {0.0, 1e4}, "truth_plus_isotropic: longest error");
  f.number("isotropic_sigma_m", c.isotropic_sigma_m, {1e-6, 1e4},
           "truth_plus_isotropic: 1-sigma per axis that the fix claims");

  f.number("white_sigma_m", c.white_sigma_m, {0.0, 1e4}, "truth_plus_white: 1-sigma per horizontal axis");
  f.number("white_sigma_up_m", c.white_sigma_up_m, {0.0, 1e4}, "truth_plus_white: 1-sigma of the height");
  f.number("count_noise_max_m", c.count_noise_max_m, {0.0, 1e4},
           "satellite_count: three sigmas per axis with four satellites");
  f.number("count_noise_min_m", c.count_noise_min_m, {0.0, 1e4}, "satellite_count: the same with twelve or more");

  f.choice("mode", c.mode, model_names(receiver_modes()), "what the receiver corrects");
  f.number("baseline_km", c.baseline_km, {0.0, 500.0}, "dgps: distance of the base station");
  f.number("ionosphere_gradient_mm_per_km", c.ionosphere_gradient_mm_per_km, {0.0, 1000.0},
           "dgps: 1-sigma of the difference of the vertical ionospheric delay to the base");
  f.number("troposphere_gradient_mm_per_km", c.troposphere_gradient_mm_per_km, {0.0, 1000.0},
           "dgps: 1-sigma of the difference of the zenith wet delay to the base");
  f.number("base_error_scale", c.base_error_scale, {0.0, 100.0},
           "dgps: base station's own error, 1 = ground accuracy designator B");
  f.choice("ionosphere", c.ionosphere, model_names(ionosphere_models()), "ionospheric delay");
  f.number("vtec_tecu", c.vtec_tecu, {0.0, 500.0}, "vertical total electron content");
  f.choice("ionosphere_correction", c.ionosphere_correction, ionosphere_corrections(),
           "mode single, and of mode dual satellites whose second signal is lost: what the receiver subtracts for the "
           "ionosphere");
  f.choice("troposphere", c.troposphere, model_names(troposphere_models()), "tropospheric delay");
  f.number("pressure_hpa", c.pressure_hpa, {100.0, 1100.0}, "air pressure at weather_height_m");
  f.number("temperature_c", c.temperature_c, {-80.0, 60.0}, "air temperature there");
  f.number("relative_humidity", c.relative_humidity, {0.0, 1.0}, "relative humidity there");
  f.number("weather_height_m", c.weather_height_m, {-500.0, 9000.0},
           "height at which the weather was measured; the standard atmosphere carries it to the receiver's");
  f.choice("ephemeris_error", c.ephemeris_error, model_names(ephemeris_error_models()),
           "error of the broadcast orbit and satellite clock");
  f.number("ephemeris_sigma_m", c.ephemeris_sigma_m, {0.0, 1000.0},
           "ephemeris_error gauss_markov: 1-sigma of the range error");
  f.number("ephemeris_tau_s", c.ephemeris_tau_s, {60.0, 1e6}, "ephemeris_error gauss_markov: correlation time");
  f.choice("receiver_clock", c.receiver_clock, model_names(receiver_clock_models()), "receiver clock error");

  f.choice("paths", c.paths, model_names(path_models()), "propagation in the scene");
  f.choice("diffraction", c.diffraction, model_names(diffraction_models()), "what roofs and corners bend");
  f.flag("ground_reflection", c.ground_reflection, "the terrain around the antenna reflects");
  f.number("surface_roughness_m", c.surface_roughness_m, {0.0, 1.0},
           "standard deviation of the reflecting surfaces' height");
  f.number("foliage_db_per_m", c.foliage_db_per_m, {0.0, 10.0}, "specific attenuation of tree crowns");
  f.number("foliage_max_db", c.foliage_max_db, {0.1, 100.0}, "largest attenuation by foliage");
  f.choice("multipath_rule", c.multipath_rule, model_names(multipath_rules()),
           "range error from direct and reflected signals");
  f.number("cutoff_ns", c.cutoff_ns, {0.0, 10000.0}, "reflections later than this do not disturb a direct signal");
  f.number("cn0_zenith_dbhz", c.cn0_zenith_dbhz, {20.0, 60.0}, "C/N0 of a clear satellite at the zenith");
  f.choice("antenna", c.antenna, model_names(antenna_models()), "gain pattern and phase centre of the antenna");
  f.number("antenna_horizon_loss_db", c.antenna_horizon_loss_db, {0.0, 40.0},
           "antenna sine: gain at the horizon below that at the zenith");
  f.number("lhcp_rejection_db", c.lhcp_rejection_db, {0.0, 60.0},
           "antenna sine: gain for left-hand below right-hand polarization");
  f.flag("antenna_phase_centre", c.antenna_phase_centre, "the antenna's phase centre is off its nominal point");
  std::vector<std::string> modulations = modulation_names();
  modulations.insert(modulations.begin(), "auto");
  f.choice("modulation", c.modulation, modulations, "of the tracked signals; auto = each system's open signal");
  f.choice("second_frequency", c.second_frequency, {"L2", "L5"},
           "mode dual: L2 and its like (Galileo E5b, BeiDou B3I), or L5, E5a, B2a");
  f.choice("correlator", c.correlator, {"early_late", "double_delta"}, "one or two pairs of early and late");
  f.choice("discriminator", c.discriminator, {"power", "coherent"}, "early minus late of powers, or in phase");
  f.number("correlator_spacing_chips", c.correlator_spacing_chips, {0.01, 1.0}, "early to late, in the signal's chips");
  f.number("front_end_mhz", c.front_end_mhz, {0.0, 100.0},
           "two-sided bandwidth of the receiver, at least the signal's main lobes; 0 = infinite");
  f.number("code_loop_hz", c.code_loop_hz, {0.001, 20.0}, "noise bandwidth of the code loop");
  f.number("carrier_loop_hz", c.carrier_loop_hz, {0.5, 50.0}, "noise bandwidth of the carrier loop");
  f.number("integration_ms", c.integration_ms, {1.0, 40.0}, "predetection integration");
  f.number("thermal_noise_scale", c.thermal_noise_scale, {0.0, 100.0},
           "thermal noise of code, carrier and Doppler, 1 = physical");
  f.number("tracking_threshold_dbhz", c.tracking_threshold_dbhz, {0.0, 60.0},
           "signals weaker than this are not tracked");
  f.number("reacquisition_margin_db", c.reacquisition_margin_db, {0.0, 40.0},
           "a lost signal is found again only above the threshold by this");
  f.number("reacquisition_s", c.reacquisition_s, {0.0, 600.0}, "and after it has been there for so long");

  f.choice("solver", c.solver, model_names(position_solvers()), "how ranges become a position");
  f.choice("weighting", c.weighting, model_names(range_weightings()), "1-sigma assumed for each pseudorange");
  f.choice("raim", c.raim, model_names(fault_exclusions()), "test of the ranges against one another, and repair");
  f.number("raim_false_alarm", c.raim_false_alarm, {1e-9, 0.5}, "probability that a faultless epoch fails that test");
  f.number("solver_sigma_m", c.solver_sigma_m, {1e-3, 1000.0},
           "1-sigma the solver assumes for a corrected pseudorange at the zenith");
  f.number("max_gdop", c.max_gdop, {1.0, 1e6}, "fixes with a larger GDOP are refused");
  f.choice("estimator", c.estimator, {"least_squares", "kalman"},
           "least_squares = each epoch by itself; kalman = position, velocity and time filtered by the receiver, whose "
           "fixes then have errors that last");
  f.number("estimator_acceleration_m_s2", c.estimator_acceleration_m_s2, {1e-6, 1000.0},
           "kalman: white acceleration of the antenna per axis, m/s^2/sqrt(Hz)");
  f.text("systems", c.systems, "satellite systems received, of G R E C J");
  f.file("nav_file", c.nav_file, "",
         "RINEX 2, 3 or 4 navigation file, plain or gzip; without any, the built-in constellation");
  f.files("nav_files", c.nav_files, "further navigation files, read as one with nav_file");
  f.file("almanac_file", c.almanac_file, "", "YUMA or SEM almanac, alone or beside navigation files");
  f.file("ionex_file", c.ionex_file, "", "ionosphere ionex: maps of the electron content, IONEX");
  f.files("sp3_files", c.sp3_files, "ephemeris_error broadcast_minus_sp3: precise orbits and clocks, SP3");
  f.file(
      "antex_file", c.antex_file, "",
      "ephemeris_error broadcast_minus_sp3: ANTEX file with the satellites' antennas; without it their offsets count "
      "as error");
}

}  // namespace canyon::gnss
