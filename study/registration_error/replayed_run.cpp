#include "canyon/study/registration_error/replayed_run.h"

#include <cmath>
#include <utility>

#include "canyon/core/units.h"
#include "canyon/mission/run.h"

namespace canyon::study {
namespace {

/// Sums the squares of the keyframes' errors.
class KeyframeSquares final : public mission::Recorder {
 public:
  explicit KeyframeSquares(bool registered) : registered_(registered) {}

  Status keyframe(const mission::KeyframeRow& row) override {
    const Pose& X_WL = registered_ ? row.X_WL_registered : row.X_WL_prior;
    const Eigen::Vector3d position_m = X_WL.p - row.X_WL_true.p;
    const Eigen::Vector3d turned_deg = so3_log(row.X_WL_true.R.conjugate() * X_WL.R) / kDegree;
    position_m2_ += position_m.cwiseAbs2();
    turned_deg2_ += turned_deg.cwiseAbs2();
    ++count_;
    return Ok{};
  }
  double mean(double sum) const { return count_ > 0 ? sum / static_cast<double>(count_) : kNaN; }
  const Eigen::Vector3d& position_m2() const { return position_m2_; }
  const Eigen::Vector3d& turned_deg2() const { return turned_deg2_; }

 private:
  bool registered_;
  Eigen::Vector3d position_m2_ = Eigen::Vector3d::Zero(), turned_deg2_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

}  // namespace

Result<ReplayedRun> replay_run(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                               const Tape& tape, ReplayStores& stores, Replay replay) {
  const bool registered = lidar::registers(config.registration);
  KeyframeSquares keyframes(registered);
  mission::Omissions unread;
  mission::RunParts parts{.tape = &tape, .recorder = &keyframes, .autonomy = nullptr, .omissions = &unread};
  CANYON_TRY(parts.receiver, stores.fixes.sensor(config, mission, mission.start + tape.duration_s()));
  if (replay == Replay::kThrifty) {
    unread.autonomy = true;
    unread.map_by_filter = registered;
    CANYON_TRY(parts.scanner, stores.scans.scanner(config));
    CANYON_TRY(parts.registration, stores.scans.registration(config));
  }
  CANYON_TRY(const mission::RunRecord record, mission::run_mission(config, mission, nullptr, std::move(parts)));
  const lidar::MapQuality& map = registered ? record.registered_quality : record.prior_quality;
  const Eigen::Vector3d &p = keyframes.position_m2(), &r = keyframes.turned_deg2();
  ReplayedRun out;
  out.mean_square = {std::pow(map.map_error_rms_m, 2),
                     std::pow(map.map_error_up_rms_m, 2),
                     keyframes.mean(p.sum()),
                     keyframes.mean(p.x()),
                     keyframes.mean(p.y()),
                     keyframes.mean(p.z()),
                     keyframes.mean(r.x()),
                     keyframes.mean(r.y()),
                     keyframes.mean(r.z())};
  out.cpu_s = record.clock.total_s();
  return out;
}

}  // namespace canyon::study
