// What a configuration of this floor asks for where it says nothing, key by key.
#include <string>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/stress_unsaid.h"
#include "canyon/inertial/aiding/barometer.h"
#include "canyon/inertial/aiding/magnetometer.h"
#include "canyon/inertial/aiding/odometer.h"
#include "canyon/inertial/catalogue.h"
#include "canyon/inertial/errors/error_figures.h"
#include "canyon/inertial/imu_config.h"
#include "canyon/inertial/mems/mems_figures.h"
#include "canyon/inertial/mems/pick_off.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using stress::said_nothing;

/// The keys of each part with their values. A figure counts the parts that differ.
StressFigure unsaid_settings() {
  int wrong = 0;
  wrong += said_nothing<ImuConfig>(
               R"({"sensor":"high_grade_mems","gyroscope":"","errors":"datasheet","leave_out":[],"rate_hz":100.0,)"
               R"("lever_arm_m":[0.0,0.0,0.4],"mounting_error_deg":0.0,"temperature_times_s":[],)"
               R"("temperatures_c":[],"vibration_m_s2":[0.0,0.0,0.0]})")
               ? 0
               : 1;
  wrong += said_nothing<BarometerConfig>(
               R"({"rate_hz":10.0,"undulation_m":-1000.0,"turn_on_bias_pa":50.0,"drift_pa":100.0,)"
               R"("drift_tau_s":7200.0,"noise_pa_per_sqrt_hz":0.4,"lag_s":0.1,"resolution_pa":0.0})")
               ? 0
               : 1;
  wrong += said_nothing<MagnetometerConfig>(
               R"({"rate_hz":20.0,"declination_deg":0.0,"inclination_deg":60.0,"strength_ut":50.0,)"
               R"("hard_iron_ut":3.0,"soft_iron_percent":2.0,"noise_ut_per_sqrt_hz":0.05,"resolution_ut":0.0})")
               ? 0
               : 1;
  wrong += said_nothing<OdometerConfig>(
               R"({"rate_hz":50.0,"wheel_m":[0.0,0.8,0.0],"metres_per_tick":0.02,"scale_percent":0.5,)"
               R"("slip_percent":0.2,"slip_tau_s":5.0,"slip_percent_per_m_s2":0.5})")
               ? 0
               : 1;
  wrong += said_nothing<MemsFigures>(
               R"({"given":false,"temperature_k":298.15,"integrator":"exact","gyro":{"mass_kg":1e-08,)"
               R"("resonance_hz":10000.0,"quality_factor":1000.0,"travel_m":1e-06,"drive_amplitude_m":5e-06,)"
               R"("split_hz":0.0,"range":0.0,"bandwidth_hz":0.0,"filter_order":2,"pick_off":"capacitive",)"
               R"("pick_off_figures":{"gap_m":2e-06,"bias_v":0.5,"capacitance_f":1e-13,"parasitic_f":2e-12,)"
               R"("amplifier_v_sqrt_hz":5e-09,"bridge_ohm":5000.0,"gauge_factor":100.0,"strain_per_m":100.0,)"
               R"("strain_cubic":0.01,"charge_c_per_m":1e-06,"leak_hz":0.1,"loss_tangent":0.002}},)"
               R"("accel":{"mass_kg":1e-09,"resonance_hz":5000.0,"quality_factor":1.0,"travel_m":1e-06,)"
               R"("drive_amplitude_m":5e-06,"split_hz":0.0,"range":0.0,"bandwidth_hz":0.0,"filter_order":2,)"
               R"("pick_off":"capacitive","pick_off_figures":{"gap_m":2e-06,"bias_v":0.5,"capacitance_f":1e-13,)"
               R"("parasitic_f":2e-12,"amplifier_v_sqrt_hz":5e-09,"bridge_ohm":5000.0,"gauge_factor":100.0,)"
               R"("strain_per_m":100.0,"strain_cubic":0.01,"charge_c_per_m":1e-06,"leak_hz":0.1,)"
               R"("loss_tangent":0.002}},"source":""})")
               ? 0
               : 1;
  wrong += said_nothing<ElementFigures>(
               R"({"mass_kg":1e-09,"resonance_hz":5000.0,"quality_factor":1.0,"travel_m":1e-06,)"
               R"("drive_amplitude_m":5e-06,"split_hz":0.0,"range":0.0,"bandwidth_hz":0.0,"filter_order":2,)"
               R"("pick_off":"capacitive","pick_off_figures":{"gap_m":2e-06,"bias_v":0.5,"capacitance_f":1e-13,)"
               R"("parasitic_f":2e-12,"amplifier_v_sqrt_hz":5e-09,"bridge_ohm":5000.0,"gauge_factor":100.0,)"
               R"("strain_per_m":100.0,"strain_cubic":0.01,"charge_c_per_m":1e-06,"leak_hz":0.1,)"
               R"("loss_tangent":0.002}})")
               ? 0
               : 1;
  wrong += said_nothing<PickOffFigures>(
               R"({"gap_m":2e-06,"bias_v":0.5,"capacitance_f":1e-13,"parasitic_f":2e-12,)"
               R"("amplifier_v_sqrt_hz":5e-09,"bridge_ohm":5000.0,"gauge_factor":100.0,"strain_per_m":100.0,)"
               R"("strain_cubic":0.01,"charge_c_per_m":1e-06,"leak_hz":0.1,"loss_tangent":0.002})")
               ? 0
               : 1;
  wrong += said_nothing<Sinusoid>(R"({"frequency_hz":50.0,"acceleration_m_s2":[0.0,0.0,0.0],"angle_deg":[0.0,0.0,0.0],)"
                                  R"("phase_deg":0.0})")
               ? 0
               : 1;
  wrong += said_nothing<MotionConfig>(
               R"({"path":"stationary","lat_deg":32.35,"lon_deg":-90.88,"height_m":60.0,"heading_deg":0.0,)"
               R"("pitch_deg":0.0,"roll_deg":0.0,"speed_m_s":10.0,"radius_m":50.0,"length_m":100.0,"width_m":60.0,)"
               R"("period_s":60.0,"climb_m":0.0,"sway_deg":0.0,"profile_s":[],"profile_m_s":[],"cone_deg":1.0,)"
               R"("cone_hz":10.0,"file":"","smoothing_s":0.0,"file_rate_hz":10.0,"vibration":{"sinusoid":[],)"
               R"("psd_hz":[],"psd_g2_per_hz":[],"psd_lines":50}})")
               ? 0
               : 1;
  // What has no keys of its own: none of these errors, and where their figures hold.
  const TriadFigures t;
  wrong += t.in_run_bias_tau_s == 3600.0 && t.flicker_low_hz == 1e-5 && t.flicker_high_hz == 0.1 ? 0 : 1;
  for (const double none : {t.white_per_sqrt_hz,
                            t.neighbour_correlation,
                            t.turn_on_bias,
                            t.in_run_bias,
                            t.bias_instability,
                            t.rate_random_walk,
                            t.ramp,
                            t.quantization_noise,
                            t.scale,
                            t.scale_asymmetry,
                            t.nonlinearity,
                            t.misalignment_rad,
                            t.package_rad,
                            t.cross_talk,
                            t.g_sensitivity,
                            t.bias_temperature,
                            t.scale_temperature,
                            t.vibration_rectification,
                            t.dead_band,
                            t.range,
                            t.resolution})
    wrong += none == 0.0 ? 0 : 1;
  const UnitFigures u;
  wrong += u.reference_temperature_c == 25.0 && u.latency_s == 0.0 && u.clock_skew == 0.0 ? 0 : 1;
  wrong += u.clock_jitter_s == 0.0 && u.loss_share == 0.0 && u.loss_length == 1.0 ? 0 : 1;
  const PaperParameters p;
  wrong += !p.given && p.temperature_k == 285.0 && p.correlation_time_s == 10.0 && p.run_time_hr == 0.5 ? 0 : 1;
  for (const PaperTriad& triad : {p.gyro, p.accel}) {
    wrong += triad.quality_factor == 1.0 && triad.mass_kg == 1e-8 && triad.resonance_hz == 5000.0 ? 0 : 1;
    wrong += triad.drive_amplitude_m == 0.0 && triad.bandwidth_hz == 100.0 && triad.white_process == 0.0 ? 0 : 1;
    wrong += triad.zero_offset == 0.0 && triad.quantization == 0.0 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> unsaid_setting_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "settings of which nothing is said",
           "a default that has changed, by which every run has",
           "the values as they are documented, written out: exact", "parts"});
  rows.add("unsaid_settings/inertial", unsaid_settings);
  return rows.take();
}

}  // namespace canyon::inertial
