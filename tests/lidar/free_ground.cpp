#include "canyon/tests/lidar/free_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "canyon/core/units.h"

namespace canyon::lidar::testing {
namespace {

/// Where a beam meets the ground: along it, and across the sensor's axis.
struct Meeting {
  double range_m, reach_m;
};

Meeting ground_met(const AimedShot& shot, const GroundPlane& ground) {
  const double falls = -shot.along_L.dot(ground.normal);
  const double range_m = falls > 1e-3 ? ground.height_m(shot.from_L) / falls : kOpen_m;
  return {range_m, (shot.from_L + range_m * shot.along_L).head<2>().norm()};
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::size_t bin_at(double range_m) {
  return static_cast<std::size_t>(std::max(range_m, 0.0) / GroundBin::kWidth_m);
}

}  // namespace

double GroundBin::median_intensity() const {
  return median(intensities);
}

double GroundBin::mean_intensity() const {
  return intensities.empty()
             ? 0.0
             : std::accumulate(intensities.begin(), intensities.end(), 0.0) / static_cast<double>(intensities.size());
}

double free_ground_m(const ShotColumn& column, const GroundPlane& ground) {
  double seen_m = 0.0;  // how far the beam below met the ground
  for (const AimedShot& shot : column.shots) {
    const Meeting meeting = ground_met(shot, ground);
    if (meeting.range_m >= kFarthestGround_m) break;
    if (shot.returned && !ground.holds(shot.p_L)) {
      const double stands_m = shot.p_L.head<2>().norm();
      return stands_m < meeting.reach_m ? stands_m : 0.5 * (seen_m + meeting.reach_m);
    }
    seen_m = meeting.reach_m;
  }
  return kOpen_m;
}

void count_ground(const std::vector<ShotColumn>& turn, const std::vector<double>& free_m, const GroundPlane& ground,
                  double step_rad, std::ptrdiff_t beside, GroundBins& out) {
  // A scan's walls stand a centimetre behind the last free ground; its rays are of single precision.
  constexpr double kWallsBehind_m = 0.02, kRounding_m = 1e-3;
  const auto columns = std::ssize(turn);
  const double lean = std::sin(std::acos(ground.normal.z()));
  for (std::ptrdiff_t c = 0; c < columns; ++c) {
    double nearest_m = kOpen_m, farthest_m = 0.0;
    for (std::ptrdiff_t other = c - beside; other <= c + beside; ++other) {
      const double up_to_m = free_m[static_cast<std::size_t>((other + columns) % columns)];
      nearest_m = std::min(nearest_m, up_to_m), farthest_m = std::max(farthest_m, up_to_m);
    }
    for (const AimedShot& shot : turn[static_cast<std::size_t>(c)].shots) {
      const Meeting meeting = ground_met(shot, ground);
      if (meeting.range_m >= kFarthestGround_m) break;
      // How far off a ring meets leaning ground changes from column to column.
      const double per_rad_m = meeting.range_m * meeting.range_m / ground.below_m * lean;
      const double slack_m = kRounding_m + 0.5 * static_cast<double>(beside) * step_rad * per_rad_m;
      const std::size_t from = bin_at(meeting.range_m - slack_m), to = bin_at(meeting.range_m + slack_m);
      if (meeting.reach_m < nearest_m && from == to) out[from].least += 1.0;
      if (meeting.reach_m < farthest_m + kWallsBehind_m)
        for (std::size_t k = from; k <= std::min(to, kGroundBins - 1); ++k) out[k].most += 1.0;
      if (meeting.reach_m >= free_m[static_cast<std::size_t>(c)]) continue;
      GroundBin& bin = out[bin_at(meeting.range_m)];
      bin.shots += 1.0;
      bin.incidence_deg += std::acos(-shot.along_L.dot(ground.normal)) / kDegree;
      if (!shot.returned || !ground.holds(shot.p_L)) continue;
      bin.returned += 1.0;
      bin.intensities.push_back(shot.intensity);
    }
  }
}

void print_free_ground(const std::vector<ShotColumn>& columns, const std::vector<double>& free_m) {
  constexpr std::size_t kSides = 8;
  std::array<std::vector<double>, kSides> up_to_m;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const long side = std::lround(columns[c].azimuth_rad / (2.0 * kPi) * kSides);
    up_to_m[static_cast<std::size_t>(side + 2 * static_cast<long>(kSides)) % kSides].push_back(
        std::min(free_m[c], kFarthestGround_m));
  }
  std::printf("ground free, medians from x towards y:");
  for (std::size_t side = 0; side < kSides; ++side)
    std::printf(" %.0f deg %.1f m%s", 360.0 / kSides * static_cast<double>(side), median(up_to_m[side]),
                side + 1 < kSides ? "," : "\n");
}

}  // namespace canyon::lidar::testing
