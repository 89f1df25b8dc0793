#include "canyon/study/registration_error/response/recorded_keyframes.h"

#include <cmath>

#include "canyon/mission/run.h"

namespace canyon::study {
namespace {

class KeyframeKeeper final : public mission::Recorder {
 public:
  explicit KeyframeKeeper(RecordedKeyframes& out) : out_(out) {}

  Status node(const TapeNode& node) override {
    out_.motion.append(node.motion);
    return Ok{};
  }
  Status keyframe_input(const mission::KeyframeInput& input) override {
    out_.keyframes.push_back({.t = input.deskewed.t,
                              .X_WB_true = input.X_WB_true,
                              .distance_m = input.distance_m,
                              .scan = input.deskewed,
                              .pose_covariance = input.estimate.pose_covariance,
                              .motion_covariance = input.motion.covariance});
    return Ok{};
  }

 private:
  RecordedKeyframes& out_;
};

}  // namespace

Result<RecordedKeyframes> record_keyframes(const mission::MissionConfig& config,
                                           const mission::PreparedMission& mission, const Tape& tape) {
  mission::MissionConfig registering = config;
  registering.run.record_tape = false;
  if (!lidar::registers(config.registration)) registering.registration.method.name = "gicp";
  RecordedKeyframes out;
  out.start = mission.start;
  KeyframeKeeper keeper(out);
  mission::Omissions nobody;
  nobody.autonomy = nobody.maps = true;
  CANYON_TRY(const mission::RunRecord record,
             mission::run_mission(registering, mission, nullptr,
                                  {.tape = &tape, .recorder = &keeper, .autonomy = nullptr, .omissions = &nobody}));
  out.cpu_s = record.clock.total_s();
  return out;
}

std::vector<Stretch> stretches(const RecordedKeyframes& recorded, double length_m, std::size_t lead) {
  std::vector<Stretch> all, out;
  for (std::size_t k = lead; k < recorded.keyframes.size(); ++k) {
    const double from_m = length_m * std::floor(recorded.keyframes[k].distance_m / length_m);
    if (all.empty() || all.back().from_m != from_m) all.push_back({k - lead, k, k, from_m});
    all.back().end = k + 1;
  }
  for (const Stretch& stretch : all)
    if (stretch.end - stretch.begin >= kFewestInStretch) out.push_back(stretch);
  return out;
}

}  // namespace canyon::study
