// Headings, fields, pressures and poses: readings that each tell by themselves.
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/stress/measurement_models/seen_state.h"
#include "canyon/fusion/stress/measurement_models/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kInfinity;
using stress::Looks;

/// Headings, fields and pressures: floors, scales and limits of what they are told, and angles that go round.
StressFigure single_readings() {
  Looks looks;
  for (const bool usual : {true, false}) {
    SeenState seen(
        {}, usual ? ""
                  : "heading_sigma_floor_deg = 1\nmagnetic_declination_deg = -30\nmagnetic_inclination_deg = "
                    "-10\nmagnetic_strength_ut = 33\n"
                    "magnetometer_sigma_ut = 2\nbarometer_sigma_m = 3\nmap_pose_scale = 3\nrelative_pose_scale = 2");
    const double floor = (usual ? 0.05 : 1.0) * kPi / 180.0;
    const auto heading = seen.model("heading");
    for (const double yaw : {0.6, 3.0, -2.0}) {
      seen.state.nav.R_EU =
          Eigen::Quaterniond(kPlaceFrame.R_EW()) * rotation_from({.yaw_rad = yaw, .pitch_rad = 0.2, .roll_rad = 0.1});
      for (const double off : {-3.0, 0.01, 3.1})
        for (const double sigma : {0.1 * floor, 3.0 * floor}) {
          const auto m =
              heading->received(seen.view(), HeadingSample{kThen, 0.5 * kPi - yaw + off + 4.0 * kPi, sigma}, 0);
          if (!m) return {kInfinity, 1.0};
          looks.near(m->residual[0], off, 1e-13),
              looks.close(m->R(0, 0), std::pow(sigma > floor ? sigma : floor, 2), 16.0);
        }
    }
    // Nose up to what leaves a tenth of it level: 84.26 degrees.
    for (const double up_deg : {84.0, 84.5, 90.0, -84.0, -84.5}) {
      seen.state.nav.R_EU = Eigen::Quaterniond(kPlaceFrame.R_EW()) *
                            rotation_from({.yaw_rad = 1.0, .pitch_rad = up_deg * kDegree, .roll_rad = 0.0});
      looks.right(heading->received(seen.view(), HeadingSample{kThen, 0.3, 0.01}, 0).has_value() ==
                  (std::abs(up_deg) < 84.26));
    }
    const auto compass = seen.model("magnetometer");
    seen.state.nav.R_EU = Eigen::Quaterniond(kPlaceFrame.R_EW());
    const auto field = compass->received(seen.view(), MagnetometerSample{kThen, Vector3d(2e-6, -3e-6, 5e-6)}, 0);
    const double down = (usual ? 60.0 : -10.0) * kDegree, east = (usual ? 0.0 : -30.0) * kDegree,
                 strength = usual ? 50.0 : 33.0;
    looks.near((field->residual - Vector3d(2.0, -3.0, 5.0) +
                strength * Vector3d(std::cos(down) * std::sin(east), std::cos(down) * std::cos(east), -std::sin(down)))
                   .norm(),
               0.0, 1e-12);
    looks.near((field->R - (usual ? 1.0 : 4.0) * Measurement::Square::Identity(3, 3)).norm(), 0.0, 1e-14);
    const auto air = seen.model("barometer");
    const double height_m = geodetic_from_ecef(seen.state.nav.p_EU_E).h_m;
    for (const double pa : {22699.0, 22701.0, 60000.0, 101325.0, 127699.0, 127701.0}) {
      const auto m = air->received(seen.view(), BarometerSample{kThen, pa}, 0);
      looks.right(m.has_value() == (pa > 22700.0 && pa < 127700.0));
      if (m)
        looks.near(m->residual[0], standard_height_m(pa) - height_m, 1e-8),
            looks.close(m->R(0, 0), usual ? 0.25 : 9.0, 8.0);
    }
    DrawnNumbers draw(2);
    const Matrix6d P = draw.positive(6, 0.5), skewed = P + 0.1 * (draw.any(6, 6) - Matrix6d::Identity());
    PoseInMap pose{.t = kThen, .X_WB = {Eigen::Quaterniond::Identity(), {10.0, 20.0, 3.0}}, .covariance = skewed};
    const auto in_map = seen.model("map_pose")->received(seen.view(), pose, 0);
    looks.near((in_map->R - (usual ? 1.0 : 9.0) * 0.5 * (skewed + skewed.transpose())).norm(), 0.0, 1e-12);
  }
  for (const double scale : {1.0, 2.0}) {
    SeenState seen({"clone"}, scale == 1.0 ? "" : "relative_pose_scale = 2");
    seen.state.take_clone();
    DrawnNumbers draw(3);
    const Matrix6d P = draw.positive(6, 0.5);
    RelativePose moved{
        .source = kThen, .target = kThen, .X_TS = {Eigen::Quaterniond::Identity(), {0.1, -0.2, 0.3}}, .covariance = P};
    const auto model = seen.model("relative_pose");
    const auto m = model->received(seen.view(), moved, 0);
    if (!m) return {kInfinity, 1.0};
    looks.near((m->R - scale * scale * P).norm(), 0.0, 1e-12 * P.norm()),
        looks.near((m->residual.tail<3>() - Vector3d(0.1, -0.2, 0.3)).norm(), 0.0, 1e-8);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> single_reading_cases() {
  StressRows rows = measured_rows();
  rows.add("measurement_models/single_readings", single_readings);
  return rows.take();
}

}  // namespace canyon::fusion
