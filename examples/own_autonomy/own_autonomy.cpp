// own_autonomy MISSION.toml [FIDELITY]: drives a mission with an autonomy of one's own, and says how it ended.
#include <cmath>
#include <cstdio>

#include "canyon/mission/run.h"

using namespace canyon;
/// Follows the route, and stops for what stands ahead.
class Careful final : public mission::Autonomy {
 public:
  explicit Careful(const mission::PriorKnowledge& known) : known_(known) {}

  void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) override {
    const Pose X_BL = estimate.X_WB.inverse() * X_WL;
    const double front_m = known_.vehicle.front_m, side_m = known_.vehicle.half_width_m + 0.3;
    int ahead = 0;
    for (const LidarPoint& point : scan.points) {
      const Eigen::Vector3d p_B = X_BL * Eigen::Vector3d(point.x, point.y, point.z);
      const bool in_lane = p_B.x() > front_m && p_B.x() < front_m + 5.0 && std::abs(p_B.y()) < side_m;
      ahead += in_lane && p_B.z() > 0.4 && p_B.z() < 2.0 ? 1 : 0;
    }
    blocked_ = ahead > 5;
  }

  DriveCommand drive(const NavEstimate& estimate) override {
    const Pose& X_WB = estimate.X_WB;
    s_m_ = known_.route.project(X_WB.p.head<2>(), s_m_, s_m_ + 5.0);
    while (next_ < known_.waypoint_s_m.size() && s_m_ > known_.waypoint_s_m[next_] - 0.5) ++next_;
    if (state() == mission::AutonomyState::kDone || blocked_) return {};
    const Eigen::Vector2d to_W = known_.route.at(s_m_ + 4.0);  // an arc to a point 4 m on: pure pursuit
    const Eigen::Vector2d to_B = (X_WB.inverse() * Eigen::Vector3d(to_W.x(), to_W.y(), X_WB.p.z())).head<2>();
    return {.speed_m_s = 3.0, .curvature_1_m = 2.0 * to_B.y() / to_B.squaredNorm()};
  }
  mission::AutonomyState state() const override {
    if (next_ == known_.waypoint_s_m.size()) return mission::AutonomyState::kDone;
    return blocked_ ? mission::AutonomyState::kBlocked : mission::AutonomyState::kDriving;
  }
  int next_waypoint() const override { return static_cast<int>(next_); }

 private:
  const mission::PriorKnowledge& known_;  // streets, waypoints, and the vehicle itself
  double s_m_ = 0.0;
  std::size_t next_ = 0;
  bool blocked_ = true;  // until the first scan
};
Result<mission::RunRecord> drive(const std::string& path, const std::string& fidelity) {
  CANYON_TRY(const auto file, mission::MissionFile::load(path));
  CANYON_TRY(const mission::MissionConfig config, file.resolve(fidelity));
  mission::SceneCache scenes;
  CANYON_TRY(const mission::PreparedMission prepared, mission::prepare(config, scenes));
  mission::RunParts parts;
  parts.autonomy = std::make_unique<Careful>(prepared.prior);
  return mission::run_mission(config, prepared, nullptr, std::move(parts));
}

int main(int argc, char** argv) {
  const auto record = drive(argc > 1 ? argv[1] : "", argc > 2 ? argv[2] : "low");
  if (!record) return std::fprintf(stderr, "%s\n", record.error().str().c_str()), 2;
  std::printf("%s after %.0f m\n", mission::name(*record->outcome), record->distance_m);
}
