// What a unit would have recorded on a path of its own, and the texts that are written of it.
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "canyon/core/process/progress.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/simulation/simulated_log.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// Seven numbers of each line after the header, whatever parts them.
std::vector<std::array<double, 7>> numbers_of(const std::string& text, bool header) {
  std::vector<std::array<double, 7>> out;
  std::istringstream in(text);
  std::string line;
  if (header) std::getline(in, line);
  while (std::getline(in, line)) {
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream words(line);
    std::array<double, 7> row{};
    for (double& x : row) words >> x;
    out.push_back(row);
  }
  return out;
}

/// A unit with biases and noise on a figure of eight over the end of a week: true increments are those of the motion
/// over each interval, sum up to its turn and change of velocity, and errors are what was measured less what is true;
/// each text says so in its axes and units, to the last bit of its numbers and times of a nanosecond of 7e5 s.
StressFigure on_a_path(const char* errors) {
  Looks looks;
  MotionConfig config;
  config.path = "figure_eight";
  config.climb_m = 4.0, config.sway_deg = 15.0;
  PlacedMotion motion = *make_motion(config, 1);
  motion.start = GpsTime::from_week_sow(1700, 604799.0);
  motion.lever_arm_m = Vector3d(0.5, -0.3, 0.8);
  constexpr double kRate_hz = 50.0;
  const std::size_t samples = whole_samples(6.0, kRate_hz);
  looks.right(samples == 300 && whole_samples(0.3, 10.0) == 3 && whole_samples(0.29999, 10.0) == 2);
  const auto chain =
      make_error_chain(errors, {.entry = *load_catalogue_entry("adis16470"), .seed = 2, .rate_hz = kRate_hz});
  if (!chain) return {stress::kInfinity, 1.0};
  Progress progress("", 0.0);
  const SimulatedLog log = simulate_log(motion, kRate_hz, samples, **chain, progress);
  looks.right(log.truth.size() == samples && log.measured.size() == samples && log.accuracy.dtheta_rad < 1e-9 &&
              log.accuracy.dv_m_s < 1e-9);
  const auto again =
      make_error_chain(errors, {.entry = *load_catalogue_entry("adis16470"), .seed = 2, .rate_hz = kRate_hz});
  LogExtremes expected;
  for (std::size_t k = 0; k < samples; ++k) {
    const ImuSample exact =
        motion_increments(motion, static_cast<double>(k) / kRate_hz, static_cast<double>(k + 1) / kRate_hz);
    looks.near((log.truth[k].dtheta_U - exact.dtheta_U).norm() + (log.truth[k].dv_U - exact.dv_U).norm(), 0.0, 1e-300);
    looks.near(log.truth[k].t - motion.start, static_cast<double>(k + 1) / kRate_hz, 1e-9);
    ImuSample one = exact;
    (*again)->corrupt(static_cast<std::int64_t>(k), one);
    looks.right(one.dv_U == log.measured[k].dv_U && one.dtheta_U == log.measured[k].dtheta_U);
    expected.rate_rad_s = worse(expected.rate_rad_s, exact.dtheta_U.norm() * kRate_hz);
    expected.force_m_s2 = worse(expected.force_m_s2, exact.dv_U.norm() * kRate_hz);
    expected.speed_m_s = worse(expected.speed_m_s, motion.motion->at(static_cast<double>(k) / kRate_hz).v_WB_W.norm());
  }
  const LogExtremes found = extremes(log);
  // An interval is a difference of times of 6 s.
  looks.close(found.rate_rad_s, expected.rate_rad_s, 12.0 * kRate_hz),
      looks.close(found.force_m_s2, expected.force_m_s2, 12.0 * kRate_hz);
  looks.close(found.speed_m_s, expected.speed_m_s, 8.0);
  looks.right(found.lost == 0);
  const auto rates = numbers_of(rates_csv(log), true), increments = numbers_of(kf_gins_text(log), false),
             added = numbers_of(errors_csv(log), true);
  looks.right(rates.size() == samples && increments.size() == samples && added.size() == samples);
  if (rates.size() != samples || increments.size() != samples || added.size() != samples) return looks.figure();
  for (std::size_t k = 0; k < samples; ++k) {
    const ImuSample &m = log.measured[k], &t = log.truth[k];
    const double sow = 604799.0 + (m.t - motion.start);
    for (const auto* text : {&rates, &increments}) looks.near((*text)[k][0], sow, 2e-9);
    looks.near(added[k][0], 604799.0 + (t.t - motion.start), 2e-9);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const double hand = i == 0 ? 1.0 : -1.0;
      looks.close(rates[k][1 + i], m.dtheta_U[axis] / t.dt_s, 4.0),
          looks.close(rates[k][4 + i], m.dv_U[axis] / t.dt_s, 4.0);
      looks.close(increments[k][1 + i], hand * m.dtheta_U[axis], 1.0),
          looks.close(increments[k][4 + i], hand * m.dv_U[axis], 1.0);
      looks.near(added[k][1 + i], (m.dtheta_U[axis] - t.dtheta_U[axis]) / t.dt_s, 4.0 * kEpsilon * 10.0);
      looks.near(added[k][4 + i], (m.dv_U[axis] - t.dv_U[axis]) / t.dt_s, 4.0 * kEpsilon * 100.0);
    }
  }
  const NavigationFile truth = truth_file(log);
  looks.right(truth.records.size() == samples + 1);
  for (std::size_t k = 0; k <= samples; k += 7) {
    const KinematicState imu = motion.imu_at(static_cast<double>(k) / kRate_hz);
    looks.near(truth.records[k].t - motion.start, static_cast<double>(k) / kRate_hz, 2e-9);
    looks.near((truth.records[k].X_EU.p - motion.frame.to_E(imu.X_WB.p)).norm(), 0.0, 8.0 * kEpsilon * 6.4e6);
    looks.near((truth.records[k].v_EU_E - motion.frame.R_EW() * imu.v_WB_W).norm(), 0.0, 1e-13);
    looks.near(truth.records[k].X_EU.R.angularDistance(Eigen::Quaterniond(motion.frame.R_EW()) * imu.X_WB.R), 0.0,
               1e-7);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> simulated_log_cases() {
  StressRows rows;
  rows.of({StressGroup::kLong, "a simulated log over the end of a week, and its texts",
           "an axis of the other hand, means over the wrong interval, a time that begins anew at the week's end",
           "increments of the motion, errors as differences, texts to their last bit", "of the bound"});
  for (const char* errors : {"none", "datasheet", "full"})
    rows.add(std::string("imu/simulated_with_") + errors, [errors] { return on_a_path(errors); });
  return rows.take();
}

}  // namespace canyon::inertial
