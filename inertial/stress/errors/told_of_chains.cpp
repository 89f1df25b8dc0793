// What error chains say of themselves, and which links are in each.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using stress::Looks;

/// What a filter is told of a whole unit: roots of sums of squares of what its links leave at rest; and which links act
/// in which chain, by leaving all others out of the whole one: to the bit.
StressFigure told() {
  Looks looks;
  CatalogueEntry entry;
  const RandomStream draws(3, "stress.told");
  const auto size = [&](std::uint32_t n) { return draws.uniform(0.5, 2.0, 0, n); };
  entry.gyro.arw_deg_per_sqrt_hr.value = 0.2 * size(0), entry.accel.vrw_m_s_per_sqrt_hr.value = 0.1 * size(1);
  entry.gyro.turn_on_bias_deg_per_hr.value = 5.0 * size(2), entry.accel.turn_on_bias_mg.value = 0.8 * size(3);
  entry.gyro.in_run_bias_deg_per_hr.value = 2.0 * size(4), entry.accel.in_run_bias_mg.value = 0.1 * size(5);
  entry.gyro.in_run_bias_tau_s.value = 400.0, entry.accel.in_run_bias_tau_s.value = 700.0;
  entry.gyro.scale_ppm.value = 300.0 * size(6), entry.accel.scale_ppm.value = 200.0 * size(7);
  entry.gyro.misalignment_mrad.value = 1.0 * size(8), entry.accel.misalignment_mrad.value = 0.7 * size(9);
  entry.gyro.package_misalignment_mrad.value = 2.0 * size(10),
  entry.accel.package_misalignment_mrad.value = 1.5 * size(11);
  entry.gyro.bias_temperature_deg_per_hr_per_k.value = 0.3 * size(12),
  entry.accel.bias_temperature_mg_per_k.value = 0.05 * size(13);
  entry.gyro.g_sensitivity_deg_per_hr_per_g.value = 4.0 * size(14);
  entry.gyro.vibration_rectification_deg_per_hr_per_g2.value = 0.5 * size(15);
  entry.accel.vibration_rectification_mg_per_g2.value = 0.05 * size(16);
  entry.gyro.bias_instability_deg_per_hr.value = 1.0;
  entry.unit.reference_temperature_c.value = 20.0;
  Environment around;
  around.temperature_times_s = {0.0, 100.0}, around.temperatures_c = {-5.0, 35.0};
  around.vibration_rms_m_s2 = Vector3d(4.0, 12.0, 7.0);
  const double per_hour = kDegree / 3600.0, mg = 1e-3 * 9.80665, g = 9.80665;
  const double of_gyro =
                   std::sqrt(
                       std::pow(entry.gyro.turn_on_bias_deg_per_hr.value, 2) +
                       std::pow(25.0 * entry.gyro.bias_temperature_deg_per_hr_per_k.value, 2) +
                       std::pow(entry.gyro.g_sensitivity_deg_per_hr_per_g.value, 2) +
                       std::pow(entry.gyro.vibration_rectification_deg_per_hr_per_g2.value * 144.0 / (g * g), 2)) *
                   per_hour,
               of_accel =
                   std::sqrt(std::pow(entry.accel.turn_on_bias_mg.value, 2) +
                             std::pow(25.0 * entry.accel.bias_temperature_mg_per_k.value, 2) +
                             std::pow(entry.accel.vibration_rectification_mg_per_g2.value * 144.0 / (g * g), 2)) *
                   mg;
  const auto chain_of = [&](const char* name, const std::vector<std::string>& out) {
    return *make_error_chain(name,
                             {.entry = entry, .seed = 6, .rate_hz = 100.0, .leave_out = out, .environment = around});
  };
  const auto full = chain_of("full", {}), sheet = chain_of("datasheet", {}), white = chain_of("white_only", {});
  looks.close(full->noise().gyro.turn_on_bias_sigma, of_gyro, 32.0),
      looks.close(full->noise().accel.turn_on_bias_sigma, of_accel, 32.0);
  looks.close(full->noise().gyro.misalignment_sigma_rad,
              1e-3 * std::hypot(entry.gyro.misalignment_mrad.value, entry.gyro.package_misalignment_mrad.value), 16.0);
  looks.close(full->noise().accel.misalignment_sigma_rad,
              1e-3 * std::hypot(entry.accel.misalignment_mrad.value, entry.accel.package_misalignment_mrad.value),
              16.0);
  const struct {
    const TriadNoise &full, &sheet, &white;
    double density, bias, in_run, tau, scale, tilt;
  } rows[] = {
      {full->noise().gyro, sheet->noise().gyro, white->noise().gyro,
       entry.gyro.arw_deg_per_sqrt_hr.value * kDegree / 60.0, entry.gyro.turn_on_bias_deg_per_hr.value * per_hour,
       entry.gyro.in_run_bias_deg_per_hr.value * per_hour, 400.0, 1e-6 * entry.gyro.scale_ppm.value,
       1e-3 * entry.gyro.misalignment_mrad.value},
      {full->noise().accel, sheet->noise().accel, white->noise().accel, entry.accel.vrw_m_s_per_sqrt_hr.value / 60.0,
       entry.accel.turn_on_bias_mg.value * mg, entry.accel.in_run_bias_mg.value * mg, 700.0,
       1e-6 * entry.accel.scale_ppm.value, 1e-3 * entry.accel.misalignment_mrad.value}};
  for (const auto& r : rows) {
    for (const TriadNoise* n : {&r.full, &r.sheet}) {
      looks.close(n->white_per_sqrt_hz, r.density, 16.0), looks.close(n->in_run_bias_sigma, r.in_run, 16.0);
      looks.close(n->scale_sigma, r.scale, 16.0), looks.right(n->in_run_bias_tau_s == r.tau);
    }
    looks.close(r.sheet.turn_on_bias_sigma, r.bias, 16.0), looks.close(r.sheet.misalignment_sigma_rad, r.tilt, 16.0);
    looks.close(r.white.white_per_sqrt_hz, r.density, 16.0);
    looks.right(r.white.turn_on_bias_sigma == 0.0 && r.white.in_run_bias_sigma == 0.0 && r.white.scale_sigma == 0.0 &&
                r.white.misalignment_sigma_rad == 0.0 && r.white.in_run_bias_tau_s == 1500.0);
  }
  const auto same = [&](ErrorChain& a, ErrorChain& b) {
    bool all = true;
    for (std::int64_t k = 0; k < 40; ++k) {
      ImuSample x;
      x.dt_s = 0.01;
      x.dtheta_U = Vector3d(0.01, -0.02, 0.005), x.dv_U = Vector3d(0.1, 0.05, 0.098);
      ImuSample y = x;
      a.corrupt(k, x), b.corrupt(k, y);
      all = all && x.dtheta_U == y.dtheta_U && x.dv_U == y.dv_U;
    }
    return all;
  };
  std::vector<std::string> no_sheet, no_white;
  for (const auto& row : error_links()) {
    const std::string name = row.name;
    if (name != "scale_factor" && name != "misalignment" && name != "turn_on_bias" && name != "in_run_bias" &&
        name != "white_noise")
      no_sheet.push_back(name);
    if (name != "white_noise") no_white.push_back(name);
  }
  // The gyroscope's flicker stands for its drifting bias, where the entry says so.
  const auto with_flicker = chain_of("full", {}), without_drift = chain_of("full", {"in_run_bias"});
  looks.right(!same(*with_flicker, *without_drift));  // the accelerometer drifts
  entry.accel.in_run_bias_mg.value = 0.0;
  looks.right(same(*chain_of("full", {}), *chain_of("full", {"in_run_bias"})));
  looks.right(same(*chain_of("white_only", {}), *chain_of("full", no_white)));
  entry.in_run_bias_is_instability = false;
  looks.right(!same(*chain_of("full", {}), *chain_of("full", {"in_run_bias"})));
  looks.right(same(*chain_of("datasheet", {}), *chain_of("full", no_sheet)));
  looks.right(!same(*chain_of("datasheet", {"scale_factor"}), *chain_of("full", no_sheet)));
  entry.unit.latency_ms.value = 25.0, entry.unit.loss_percent.value = 1.0, entry.unit.loss_length.value = 4.0;
  looks.right(chain_of("full", {})->memory() == 3 + 5 && chain_of("full", {"latency"})->memory() == 5);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> told_of_chain_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "what a chain says of itself, and which links it has",
           "a figure of the other triad, a link of another chain",
           "roots of sums of squares, and the whole chain without the others to the bit", "of the bound"});
  rows.add("elements/told_of_chains", told);
  return rows.take();
}

}  // namespace canyon::inertial
