// The paper's figures 2, 3 and 7: a resting unit, dead reckoned by plain integration as the paper does, with its error
// chain as printed and as corrected.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "core/units.h"
#include "inertial/error_chain.h"
#include "inertial/paper_formulas.h"

namespace canyon::inertial {
namespace {

struct Drift {
  Eigen::Vector3d angle_deg = Eigen::Vector3d::Zero(), position_m = Eigen::Vector3d::Zero();
};

/// Angles and positions after `seconds` of a unit that rests without gravity and Earth rate.
Drift drift(const char* chain_name, const CatalogueEntry& entry, std::uint64_t seed, double seconds) {
  const double rate_hz = 125.0;
  auto chain = *make_error_chain(chain_name, {.entry = entry, .seed = seed, .rate_hz = rate_hz});
  Drift out;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  for (std::int64_t k = 0; k < std::llround(seconds * rate_hz); ++k) {
    ImuSample s;
    s.dt_s = 1.0 / rate_hz;
    chain->corrupt(k, s);
    out.angle_deg += s.dtheta_U / kDegree;
    out.position_m += (v + 0.5 * s.dv_U) * s.dt_s;
    v += s.dv_U;
  }
  return out;
}

/// Mean error that the printed chain adds to every sample, SI.
double printed_mean(double thermal, const PaperTriad& p, const PaperParameters& all, double offset) {
  return thermal + quantization_as_printed(p.quality_factor, all.run_time_hr) +
         offset / (1.0 - 1.0 / all.correlation_time_s);
}

double printed_gyro_mean(const CatalogueEntry& e) {
  const PaperTriad& p = e.paper.gyro;
  const double w = 2.0 * kPi * p.resonance_hz;
  const double thermal = gyro_thermal_as_printed_m(p.quality_factor, p.mass_kg * w * w, e.paper.temperature_k,
                                                   p.mass_kg * w / p.quality_factor, p.bandwidth_hz);
  return printed_mean(thermal, p, e.paper, p.zero_offset * kDegree);
}

double printed_accel_mean(const CatalogueEntry& e) {
  const PaperTriad& p = e.paper.accel;
  const double w = 2.0 * kPi * p.resonance_hz;
  return printed_mean(accel_thermal_density(e.paper.temperature_k, w, p.mass_kg, p.quality_factor), p, e.paper,
                      p.zero_offset);
}

/// Angle of a Gauss-Markov rate of stationary sigma and correlation time tau after t.
double markov_angle_sigma(double sigma, double tau, double t) {
  return sigma * std::sqrt(2.0 * tau * (t - tau * (1.0 - std::exp(-t / tau))));
}

// Figures 2 and 3: 20 minutes, about 3 deg/h. The corrected chain gives the offset of 3 deg/h that its parameters hold,
// within what its Gauss-Markov part and thermal noise allow. The printed chain's quantization term alone, 0.01745
// sqrt(3 Q^2 / t) with the resonator's Q = 1000, is 52 rad/s: the printed formulas cannot have drawn the figure.
TEST(PaperFigures, TwoAndThreeTwentyMinutes) {
  const CatalogueEntry e = *load_catalogue_entry("high_grade_mems");
  const double seconds = 1200.0, hours = seconds / kHour;
  const Drift corrected = drift("paper", e, 1, seconds), printed = drift("paper_as_printed", e, 1, seconds);
  std::printf("figures 2 and 3, drift after 20 min, deg/h: corrected %.2f %.2f %.2f; as printed %.3g %.3g %.3g\n",
              corrected.angle_deg.x() / hours, corrected.angle_deg.y() / hours, corrected.angle_deg.z() / hours,
              printed.angle_deg.x() / hours, printed.angle_deg.y() / hours, printed.angle_deg.z() / hours);
  const PaperTriad& p = e.paper.gyro;
  const double thermal = gyro_thermal_density(e.paper.temperature_k, 2.0 * kPi * p.resonance_hz, p.mass_kg,
                                              p.quality_factor, p.drive_amplitude_m) /
                         kDegree;
  const double sigma = std::hypot(markov_angle_sigma(p.white_process, e.paper.correlation_time_s, seconds),
                                  thermal * std::sqrt(seconds));
  const double mean_printed = printed_gyro_mean(e) / kDegree * seconds;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(corrected.angle_deg[axis], 3.0 * hours, 4.0 * sigma) << axis;
    EXPECT_NEAR(printed.angle_deg[axis] / mean_printed, 1.0, 4.0 / std::sqrt(seconds * 125.0)) << axis;
  }
  EXPECT_GT(mean_printed / hours, 1e6);
}

// Figure 7: ten minutes of the hobby unit at 125 Hz, Q 0.2, tau 10 s, 0.12 / 0.15, offset 3 deg/min: about 30 deg and
// some kilometres. As printed, the quantization term (0.0148 rad/s, 51 deg/min) drifts 17 times the unit's own 3
// deg/min.
TEST(PaperFigures, SevenTenMinutes) {
  const CatalogueEntry e = *load_catalogue_entry("phidget_3_3_3");
  const double seconds = 600.0;
  const Drift corrected = drift("paper", e, 1, seconds), printed = drift("paper_as_printed", e, 1, seconds);
  for (const auto& [name, d] : {std::pair{"corrected", corrected}, std::pair{"as printed", printed}})
    std::printf("figure 7, after 10 min, %s: angles %.1f %.1f %.1f deg, positions %.0f %.0f %.0f m\n", name,
                d.angle_deg.x(), d.angle_deg.y(), d.angle_deg.z(), d.position_m.x(), d.position_m.y(),
                d.position_m.z());
  const PaperParameters& p = e.paper;
  const double angle_sigma = markov_angle_sigma(p.gyro.white_process, p.correlation_time_s, seconds);
  // Position of a Gauss-Markov acceleration for t >> tau: sigma sqrt(2 tau t^3 / 3).
  const double position_sigma =
      p.accel.white_process * std::sqrt(2.0 * p.correlation_time_s * std::pow(seconds, 3) / 3.0);
  const double printed_angle = printed_gyro_mean(e) / kDegree * seconds;
  const double printed_position = 0.5 * printed_accel_mean(e) * seconds * seconds;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(corrected.angle_deg[axis], 30.0, 4.0 * angle_sigma) << axis;
    EXPECT_NEAR(corrected.position_m[axis], 0.5 * 0.05 * seconds * seconds, 4.0 * position_sigma) << axis;
    EXPECT_NEAR(printed.angle_deg[axis] / printed_angle, 1.0, 0.02) << axis;  // 4 sigma of the spreads: 0.015
    EXPECT_NEAR(printed.position_m[axis] / printed_position, 1.0, 0.03) << axis;
  }
  EXPECT_GT(printed_angle, 17.0 * 30.0);
}

}  // namespace
}  // namespace canyon::inertial
