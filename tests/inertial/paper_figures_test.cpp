// The paper's figures 2, 3 and 7: a resting unit, dead reckoned by plain integration as the paper does, with its error
// chain as printed and as corrected.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/inertial/paper_figures.h"
#include "canyon/inertial/paper_formulas.h"

namespace canyon::inertial {
namespace {

struct Drift {
  CatalogueEntry entry;
  double seconds = 0.0;
  Eigen::Vector3d angle_deg, position_m;
};

/// Where a figure ends.
Drift end_of(const std::string& name, const char* chain) {
  for (const PaperFigure& figure : paper_figures()) {
    if (name != figure.name) continue;
    const PaperDrift d = *paper_drift(figure, chain, 1);
    Drift out{figure.entry(), figure.seconds, {}, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.angle_deg[static_cast<Eigen::Index>(axis)] = d.angle_deg[axis].back();
      out.position_m[static_cast<Eigen::Index>(axis)] = d.position_m[axis].back();
    }
    return out;
  }
  ADD_FAILURE() << "no " << name;
  return {};
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
  const Drift corrected = end_of("figures_2_and_3", "paper"), printed = end_of("figures_2_and_3", "paper_as_printed");
  const CatalogueEntry& e = corrected.entry;
  const double seconds = 1200.0, hours = seconds / kHour;
  EXPECT_EQ(corrected.seconds, seconds);
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

// Figure 7: ten minutes of the hobby unit at 125 Hz, offset 3 deg/min, about 30 deg and some kilometres, with the
// coefficients beside the figure (Q 0.2, 0.15 deg/s, 0.12 m/s^2) and those of the text (Q 0.15, 0.30, 0.15). As
// printed, the quantization term, 0.01745 sqrt(3 Q^2 / t), alone drifts 17 and 13 times the unit's own 3 deg/min.
void check_figure_7(const char* name, double quality_factor, double gyro, double accel) {
  const Drift corrected = end_of(name, "paper"), printed = end_of(name, "paper_as_printed");
  const PaperParameters& p = corrected.entry.paper;
  EXPECT_EQ(p.gyro.quality_factor, quality_factor);
  EXPECT_EQ(p.gyro.white_process, gyro);
  EXPECT_EQ(p.accel.white_process, accel);
  EXPECT_EQ(p.correlation_time_s, 10.0);
  const double seconds = 600.0;
  EXPECT_EQ(corrected.seconds, seconds);
  for (const auto& [form, d] : {std::pair{"corrected", corrected}, std::pair{"as printed", printed}})
    std::printf("%s, after 10 min, %s: angles %.1f %.1f %.1f deg, positions %.0f %.0f %.0f m\n", name, form,
                d.angle_deg.x(), d.angle_deg.y(), d.angle_deg.z(), d.position_m.x(), d.position_m.y(),
                d.position_m.z());
  const double angle_sigma = markov_angle_sigma(gyro, p.correlation_time_s, seconds);
  // Position of a Gauss-Markov acceleration for t >> tau: sigma sqrt(2 tau t^3 / 3).
  const double position_sigma = accel * std::sqrt(2.0 * p.correlation_time_s * std::pow(seconds, 3) / 3.0);
  const double printed_angle = printed_gyro_mean(corrected.entry) / kDegree * seconds;
  const double printed_position = 0.5 * printed_accel_mean(corrected.entry) * seconds * seconds;
  std::printf("  law: angles 30 +- %.1f deg, positions %.1f +- %.1f km; as printed %.0f deg, %.1f km\n", angle_sigma,
              0.5e-3 * 0.05 * seconds * seconds, 1e-3 * position_sigma, printed_angle, 1e-3 * printed_position);
  // The recursion's spread w sqrt(1 + 1/tau^2) / sqrt(1 - 1/tau^2), nearly white, over 75,000 samples; 4 sigma.
  const double printed_sigma = 1.02 * gyro * std::sqrt(seconds / 125.0) / (1.0 - 1.0 / p.correlation_time_s);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(corrected.angle_deg[axis], 30.0, 4.0 * angle_sigma) << axis;
    EXPECT_NEAR(corrected.position_m[axis], 0.5 * 0.05 * seconds * seconds, 4.0 * position_sigma) << axis;
    EXPECT_NEAR(printed.angle_deg[axis], printed_angle, 4.0 * printed_sigma + 0.01 * printed_angle) << axis;
    EXPECT_NEAR(printed.position_m[axis] / printed_position, 1.0, 0.04) << axis;
  }
  EXPECT_GT(printed_angle, 13.0 * 30.0);
}

TEST(PaperFigures, SevenTenMinutes) {
  check_figure_7("figure_7", 0.2, 0.15, 0.12);
}

TEST(PaperFigures, SevenWithTheTextsParameters) {
  check_figure_7("figure_7_text_parameters", 0.15, 0.30, 0.15);
}

}  // namespace
}  // namespace canyon::inertial
