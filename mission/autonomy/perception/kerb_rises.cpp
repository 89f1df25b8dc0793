#include "canyon/mission/autonomy/perception/kerb_rises.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Cholesky>

namespace canyon::mission {
namespace {

constexpr double kLeastRise_m = 0.06, kMostRise_m = 0.30;  // of a kerb; pavements are built 0.08 to 0.15 m high
constexpr double kRiseAcross_m = 0.12;        // within which it is climbed: noise of the range, seen slantwise
constexpr double kRiseAlong_m = 1.5;          // that a ring needs for it
constexpr double kPavement_m = 1.0;           // of the pavement, beside the kerb
constexpr double kLevel_m = 0.045;            // within which it is: slopes to the gutter, and noise
constexpr double kNextOn_m = 0.6;             // between returns that follow one another on one surface
constexpr double kRoadway_m = 2.5;            // beside the origin's line, where nothing but the street is
constexpr double kNearStreet_m = 0.6;         // about the street, of what may be ground
constexpr std::size_t kFewestOfRoadway = 30;  // returns of the roadway
constexpr std::size_t kSmooth = 3;            // returns that are averaged

/// A return in the street's own axes.
struct KerbReturn {
  double ahead_m, left_m, above_m;
  double turn_rad = 0.0;  ///< about the sensor, from ahead to the left
};

bool are_apart(const KerbReturn& one, const KerbReturn& next) {
  return std::hypot(next.ahead_m - one.ahead_m, next.left_m - one.left_m) > kNextOn_m;
}

/// Plane through the roadway: height, and by how much it rises ahead and to the left. What stands on it is left out,
/// round by round, from the plane that it is expected to be.
std::optional<Eigen::Vector3d> roadway_plane(const std::vector<KerbReturn>& all, Eigen::Vector3d plane) {
  for (const double room_m : {kNearStreet_m, 0.25, 0.08}) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    std::size_t count = 0;
    for (const KerbReturn& one : all) {
      const Eigen::Vector3d row(1.0, one.ahead_m, one.left_m);
      if (std::abs(one.left_m) > kRoadway_m || std::abs(one.above_m - plane.dot(row)) > room_m) continue;
      A += row * row.transpose();
      b += one.above_m * row;
      ++count;
    }
    if (count < kFewestOfRoadway) return std::nullopt;
    const Eigen::LDLT<Eigen::Matrix3d> solved(A);
    if (solved.info() != Eigen::Success || !(solved.rcond() > 1e-6)) return std::nullopt;
    plane = solved.solve(b);
  }
  return plane;
}

/// Averages of neighbours, which keep a rise where it is.
std::vector<KerbReturn> smoothed(const std::vector<KerbReturn>& ring) {
  std::vector<KerbReturn> out;
  for (std::size_t i = 0; i + kSmooth <= ring.size(); ++i) {
    KerbReturn mean{0.0, 0.0, 0.0};
    for (std::size_t k = i; k < i + kSmooth; ++k) {
      mean.ahead_m += ring[k].ahead_m / kSmooth;
      mean.left_m += ring[k].left_m / kSmooth;
      mean.above_m += ring[k].above_m / kSmooth;
    }
    out.push_back(mean);
  }
  return out;
}

/// Is there, from where a rise begins, a level top behind it? A car's side climbs on, along its front a ring sinks, and
/// a post is narrow.
bool has_top(const std::vector<KerbReturn>& outwards, std::size_t foot) {
  double least_m = kMostRise_m, most_m = kLeastRise_m;
  double reach_m = 0.0;
  for (std::size_t k = foot + 1; k < outwards.size(); ++k) {
    const double aside_m = std::abs(outwards[k].left_m - outwards[foot].left_m);
    if (are_apart(outwards[k - 1], outwards[k]) || aside_m > kPavement_m) break;
    if (aside_m < kRiseAcross_m) continue;
    const double rise_m = outwards[k].above_m - outwards[foot].above_m;
    if (rise_m < kLeastRise_m || rise_m > kMostRise_m) return false;
    least_m = std::min(least_m, rise_m);
    most_m = std::max(most_m, rise_m);
    reach_m = aside_m;
  }
  return reach_m > 0.5 * kPavement_m && most_m - least_m < kLevel_m;
}

/// The first rise outwards along returns that follow one another on one side of the street, nearest to it first.
std::optional<KerbReturn> first_rise(const std::vector<KerbReturn>& outwards) {
  for (std::size_t i = 0; i < outwards.size(); ++i) {
    for (std::size_t j = i + 1; j < outwards.size() && !are_apart(outwards[j - 1], outwards[j]); ++j) {
      if (std::abs(outwards[j].ahead_m - outwards[i].ahead_m) > kRiseAlong_m) break;
      if (std::abs(outwards[j].left_m - outwards[i].left_m) > kRiseAcross_m) break;
      if (outwards[j].above_m - outwards[i].above_m < kLeastRise_m) continue;
      if (!has_top(outwards, i)) return std::nullopt;  // a thing, and what is behind it is not seen
      return KerbReturn{0.5 * (outwards[i].ahead_m + outwards[j].ahead_m),
                        0.5 * (outwards[i].left_m + outwards[j].left_m), outwards[j].above_m};
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<Eigen::Vector2d> kerb_rises(const KerbTask& task) {
  const Eigen::Vector2d left(-task.along.y(), task.along.x());
  const Eigen::Matrix3d R = task.X_OL.R.toRotationMatrix();
  std::map<std::uint16_t, std::vector<KerbReturn>> rings;
  std::vector<KerbReturn> all;
  for (const LidarPoint& point : task.scan.points) {
    if (point.return_index != 0) continue;
    const Eigen::Vector3d p_O = R * Eigen::Vector3d(point.x, point.y, point.z) + task.X_OL.p;
    const Eigen::Vector2d d = p_O.head<2>() - task.origin, from = p_O.head<2>() - task.X_OL.p.head<2>();
    const KerbReturn seen{task.along.dot(d), left.dot(d), p_O.z() - task.ground_m,
                          std::atan2(left.dot(from), task.along.dot(from))};
    // What is not finite is not within.
    if (!(seen.ahead_m >= 0.0 && seen.ahead_m <= task.ahead_m && std::abs(seen.left_m) <= task.beside_m)) continue;
    rings[point.ring].push_back(seen);
    all.push_back(seen);
  }
  const double rise_ahead = -task.up.head<2>().dot(task.along) / task.up.z(),
               rise_left = -task.up.head<2>().dot(left) / task.up.z();
  const std::optional<Eigen::Vector3d> plane = roadway_plane(all, {0.0, rise_ahead, rise_left});
  std::vector<Eigen::Vector2d> found;
  if (!plane) return found;
  for (auto& [number, ring] : rings) {
    for (KerbReturn& one : ring) one.above_m -= plane->dot(Eigen::Vector3d(1.0, one.ahead_m, one.left_m));
    for (const double side : {1.0, -1.0}) {
      std::vector<KerbReturn> outwards;
      for (const KerbReturn& one : ring)
        if (side * one.left_m > 0.5 * kRoadway_m && std::abs(one.above_m) < kNearStreet_m) outwards.push_back(one);
      std::sort(outwards.begin(), outwards.end(),
                [&](const KerbReturn& a, const KerbReturn& b) { return side * a.turn_rad < side * b.turn_rad; });
      if (const auto rise = first_rise(smoothed(outwards)))
        found.push_back(task.origin + rise->ahead_m * task.along + rise->left_m * left);
    }
  }
  return found;
}

}  // namespace canyon::mission
