#include "canyon/study/reproduce/detections.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::study {
namespace {

constexpr double kSame_m = 1.0;     // a thing held and a thing that stands are one within this
constexpr double kBeside_m = 0.2;   // from a direction to the middle of a cell that lies in it
constexpr double kNearest_m = 3.0;  // the vehicle's own body

double direction_rad(int k) {
  return (2.0 * k - (kDirections - 1)) * kDegree;
}

double counted_share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : kNaN;
}

}  // namespace

Ranges held_ranges(const std::vector<Eigen::Vector2d>& cells, const Eigen::Vector2d& p, double yaw_rad) {
  Ranges out(kDirections, kReach_m);
  for (const Eigen::Vector2d& cell : cells) {
    const Eigen::Vector2d d = cell - p;
    const double range_m = d.norm();
    if (range_m < kNearest_m || range_m >= kReach_m) continue;
    const double off_rad = std::remainder(std::atan2(d.y(), d.x()) - yaw_rad, 2.0 * kPi);
    for (int k = 0; k < kDirections; ++k) {
      double& nearest = out[static_cast<std::size_t>(k)];
      if (std::abs(off_rad - direction_rad(k)) * range_m < kBeside_m) nearest = std::min(nearest, range_m);
    }
  }
  return out;
}

Ranges true_ranges(const scene::SceneAt& scene, const Pose& X_WB) {
  Ranges out(kDirections, kReach_m);
  const double yaw_rad = yaw_pitch_roll(X_WB.R).yaw_rad;
  for (int k = 0; k < kDirections; ++k) {
    const double at = yaw_rad + direction_rad(k);
    const Eigen::Vector3d direction(std::cos(at), std::sin(at), 0.0);
    double& nearest = out[static_cast<std::size_t>(k)];
    for (const double height_m : {0.6, 1.2, 1.8}) {
      const Eigen::Vector3d from = X_WB.p + kNearest_m * direction + Eigen::Vector3d(0.0, 0.0, height_m);
      const scene::Hit hit = scene.trace({from, direction.cast<float>(), static_cast<float>(kReach_m - kNearest_m)});
      if (!hit.hit() || scene.object(scene.surface(hit.triangle).object).kind == scene::ObjectKind::kTerrain) continue;
      nearest = std::min(nearest, kNearest_m + hit.range_m);
    }
  }
  return out;
}

void Detections::add(const Ranges& held, const Ranges& truly) {
  for (std::size_t k = 0; k < held.size(); ++k) {
    ++directions_;
    const bool thing = truly[k] < kReach_m;
    things_ += thing ? 1 : 0;
    phantoms_ += held[k] < truly[k] - kSame_m ? 1 : 0;
    missed_ += thing && held[k] > truly[k] + kSame_m ? 1 : 0;
    if (!thing || held[k] >= kReach_m) continue;
    ++both_;
    squares_m2_ += std::pow(held[k] - truly[k], 2);
  }
}

double Detections::phantom_share() const {
  return counted_share(phantoms_, directions_);
}
double Detections::missed_share() const {
  return counted_share(missed_, things_);
}
double Detections::range_rms_m() const {
  return both_ > 0 ? std::sqrt(squares_m2_ / both_) : kNaN;
}

CommandDifference command_difference(const std::vector<DriveCommand>& a, const std::vector<DriveCommand>& b,
                                     double wheelbase_m) {
  const std::size_t rows = std::min(a.size(), b.size());
  if (rows == 0) return {};
  const auto angle_deg = [&](const DriveCommand& c) { return std::atan(c.curvature_1_m * wheelbase_m) / kDegree; };
  double steering2 = 0.0, speed2 = 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    steering2 += std::pow(angle_deg(a[i]) - angle_deg(b[i]), 2);
    speed2 += std::pow(a[i].speed_m_s - b[i].speed_m_s, 2);
  }
  return {std::sqrt(steering2 / static_cast<double>(rows)), std::sqrt(speed2 / static_cast<double>(rows))};
}

}  // namespace canyon::study
