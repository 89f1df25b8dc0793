#include "canyon/tests/lidar/grazed_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar::testing {
namespace {

constexpr double kJudgedFrom_m = 10.0, kJudgedShots = 200.0, kJudgedFactor = 1.5;
constexpr double kJudgedReturns = 20.0;  // for a median intensity

double begin_of(std::size_t bin) {
  return GroundBin::kWidth_m * static_cast<double>(bin);
}

bool is_judged(const GroundBin& bin, std::size_t k) {
  return begin_of(k) >= kJudgedFrom_m && bin.shots >= kJudgedShots;
}

/// Where the sensor stands over asphalt that is level in W. Each turn has a piece of its own, with other grains.
Pose over_asphalt(const GroundPlane& ground, std::size_t turn) {
  return {Eigen::Quaterniond::FromTwoVectors(ground.normal, Eigen::Vector3d::UnitZ()),
          {0.3, 0.2 + 10.0 * static_cast<double>(turn), ground.below_m}};
}

/// Asphalt, and a wall in every column where its free ground ends. It leans as the sensor does, so that it ends its own
/// column and no other.
scene::Scene walled(const std::vector<ShotColumn>& columns, const std::vector<double>& free_m, const Pose& X_WL,
                    double step_rad) {
  // Walls close with their neighbours and stand just behind the last ground that was free. They are not so near that
  // beams, which do not all begin on the axis, pass beside them, and reach through the ground wherever it leans to.
  constexpr double kHalfSteps = 0.6, kBehind_m = 0.01, kNearest_m = 1.0, kHeight_m = 10.0;
  scene::SceneParts parts = empty_parts();
  add_ground(parts, 120.0);
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("walls", scene::ObjectKind::kWall);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (free_m[c] >= kFarthestGround_m) continue;
    const double off_m = std::max(free_m[c] + kBehind_m, kNearest_m);
    const Eigen::Vector3d ahead(std::cos(columns[c].azimuth_rad), std::sin(columns[c].azimuth_rad), 0.0);
    const Eigen::Vector3d aside = off_m * std::tan(kHalfSteps * step_rad) * Eigen::Vector3d(-ahead.y(), ahead.x(), 0.0);
    const Eigen::Vector3d up(0.0, 0.0, kHeight_m), right = off_m * ahead - aside, left = off_m * ahead + aside;
    mesh.quad(X_WL * (left - up), X_WL * (right - up), X_WL * (right + up), X_WL * (left + up),
              mesh.material("concrete"));
  }
  return scene::Scene(std::move(parts));
}

/// Directions that a part of a turn looked into.
class Looked {
 public:
  Looked(const RecordedTurn& turn, std::size_t steps) : at_(steps, false) {
    for (const ShotColumn& column : turn.columns)
      for (const std::size_t beside : {steps - 1, std::size_t{0}, std::size_t{1}})
        at_[(step(column.azimuth_rad) + beside) % steps] = true;
  }
  bool into(const LidarPoint& p) const { return at_[step(std::atan2(p.y, p.x))]; }

 private:
  std::size_t step(double azimuth_rad) const {
    const double turns = azimuth_rad / (2.0 * kPi);
    return static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(at_.size())) % at_.size();
  }
  std::vector<bool> at_;
};

/// Calls visit(bin, point) for each return from the ground that one of the recording's shots may have met.
template <class Visit>
void scan_ground(const LidarConfig& config, const GroundRecording& recording, std::size_t turn,
                 const scene::Scene& scene, const Pose& X_WL, const Visit& visit) {
  const Looked looked(recording.turns[turn], recording.steps);
  const auto scanner = make_scanner(config, 1);
  ASSERT_TRUE(scanner.ok()) << scanner.error().str();
  const LidarOutput out =
      (*scanner)->scan(static_cast<std::int64_t>(turn), kStart, standing(X_WL), scene::SceneAt(scene));
  for (std::size_t i = 0; i < out.truth.size(); ++i) {
    const LidarPointTruth& truth = out.truth[i];
    const LidarPoint& point = out.scan.points[i];
    if (scene.objects()[truth.object].kind != scene::ObjectKind::kTerrain || truth.range_m >= kFarthestGround_m)
      continue;
    if (std::find(recording.lasers.begin(), recording.lasers.end(), point.ring) == recording.lasers.end()) continue;
    if (looked.into(point)) visit(static_cast<std::size_t>(truth.range_m / GroundBin::kWidth_m), point);
  }
}

LidarConfig scanner_of(const GroundRecording& recording) {
  LidarConfig config = ideal_lidar();
  config.beams = recording.beams;
  config.azimuth_steps = static_cast<std::int64_t>(recording.steps);
  // Lasers that fire one after the other take their time; a hair slower than they can, for rounding.
  const double turn_s = static_cast<double>(recording.steps) * load_beam_table(recording.beams)->cycle_s;
  config.rate_hz = std::min(10.0, 0.9999 / std::max(turn_s, 1e-3));
  return config;
}

void print_table(const GroundComparison& both, const std::vector<GroundScan>& scans) {
  std::printf("        range  incidence    shots  simulated (may be)     returned");
  for (const GroundScan& scan : scans) std::printf("  %10s", scan.name.c_str());
  std::printf("   intensity: median, mean");
  for (const GroundScan& scan : scans) std::printf("  %16s", scan.name.c_str());
  std::printf("\n");
  for (std::size_t k = 0; k < kGroundBins; ++k) {
    const GroundBin& bin = both.recorded[k];
    if (bin.shots == 0.0) continue;
    std::printf("%5.1f-%4.1f m  %9.1f  %7.0f  %7.0f (%5.0f-%5.0f)  %9.3f", begin_of(k), begin_of(k + 1),
                bin.incidence_deg / bin.shots, bin.shots, both.scanned.front()[k].shots, bin.least, bin.most,
                bin.share());
    for (const GroundBins& scanned : both.scanned) std::printf("  %10.3f", scanned[k].share());
    std::printf("   %16.1f, %6.1f", bin.median_intensity(), bin.mean_intensity());
    for (const GroundBins& scanned : both.scanned)
      std::printf("  %8.1f, %6.1f", scanned[k].median_intensity(), scanned[k].mean_intensity());
    std::printf("%s\n", is_judged(bin, k) ? "" : "  (not judged)");
  }
}

bool is_off(double ours, double theirs) {
  return !(std::max(ours / theirs, theirs / ours) < kJudgedFactor);
}

}  // namespace

std::string beam_of_high(double range_at_10_percent_m, const std::string& reflection) {
  return "detector = \"radiometric\"\nrange_at_10_percent_m = " + std::to_string(range_at_10_percent_m) +
         "\nbrightness = \"varied\"\nwindows = \"lattice\"\nreflection = \"" + reflection + "\"\n";
}

std::vector<double> GroundComparison::judged_m() const {
  std::vector<double> out;
  for (std::size_t k = 0; k < kGroundBins; ++k)
    if (is_judged(recorded[k], k)) out.push_back(begin_of(k));
  return out;
}

std::vector<double> GroundComparison::misses_m(std::size_t scan) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < kGroundBins; ++k)
    if (is_judged(recorded[k], k) && is_off(scanned[scan][k].share(), recorded[k].share())) out.push_back(begin_of(k));
  return out;
}

std::vector<double> GroundComparison::intensities_judged_m(std::size_t scan) const {
  std::vector<double> out;
  for (std::size_t k = 0; k < kGroundBins; ++k)
    if (is_judged(recorded[k], k) && std::min(scanned[scan][k].returned, recorded[k].returned) >= kJudgedReturns)
      out.push_back(begin_of(k));
  return out;
}

std::vector<double> GroundComparison::intensity_misses_m(std::size_t scan) const {
  std::vector<double> out;
  for (const double from_m : intensities_judged_m(scan)) {
    const auto k = static_cast<std::size_t>(from_m / GroundBin::kWidth_m);
    if (is_off(scanned[scan][k].median_intensity(), recorded[k].median_intensity())) out.push_back(from_m);
  }
  return out;
}

void GroundComparison::expect_as_much_ground() const {
  for (std::size_t k = 0; k < kGroundBins; ++k) {
    if (begin_of(k) < kJudgedFrom_m) continue;
    EXPECT_GE(scanned.front()[k].shots, recorded[k].least) << begin_of(k);
    EXPECT_LE(scanned.front()[k].shots, recorded[k].most) << begin_of(k);
  }
}

GroundComparison compare_ground(const GroundRecording& recording, const std::vector<GroundScan>& scans) {
  GroundComparison out;
  out.scanned.resize(scans.size());
  const double step_rad = 2.0 * kPi / static_cast<double>(recording.steps);
  const LidarConfig ideal = scanner_of(recording);
  for (std::size_t t = 0; t < recording.turns.size(); ++t) {
    const RecordedTurn& turn = recording.turns[t];
    std::vector<double> free_m;
    for (const ShotColumn& column : turn.columns) free_m.push_back(free_ground_m(column, turn.ground));
    std::size_t shots = 0, returned = 0;
    for (const ShotColumn& column : turn.columns) {
      shots += column.shots.size();
      returned += static_cast<std::size_t>(
          std::count_if(column.shots.begin(), column.shots.end(), [](const AimedShot& s) { return s.returned; }));
    }
    std::printf("%zu shots in %zu columns, %zu returned; sensor %.2f m above the ground, which leans by %.1f deg\n",
                shots, turn.columns.size(), returned, turn.ground.below_m, std::acos(turn.ground.normal.z()) / kDegree);
    print_free_ground(turn.columns, free_m);
    count_ground(turn.columns, free_m, turn.ground, step_rad, recording.beside, out.recorded);
    const Pose X_WL = over_asphalt(turn.ground, t);
    const scene::Scene scene = walled(turn.columns, free_m, X_WL, step_rad);
    std::array<double, kGroundBins> bound{};  // whether it comes back or not: by a receiver that loses nothing
    scan_ground(ideal, recording, t, scene, X_WL, [&](std::size_t k, const LidarPoint&) { bound[k] += 1.0; });
    for (std::size_t s = 0; s < scans.size(); ++s) {
      LidarConfig config = ideal;
      set_keys(config, scans[s].keys);
      for (std::size_t k = 0; k < kGroundBins; ++k) out.scanned[s][k].shots += bound[k];
      scan_ground(config, recording, t, scene, X_WL, [&](std::size_t k, const LidarPoint& point) {
        out.scanned[s][k].returned += 1.0;
        out.scanned[s][k].intensities.push_back(100.0 * static_cast<double>(point.intensity));
      });
    }
  }
  print_table(out, scans);
  return out;
}

}  // namespace canyon::lidar::testing
