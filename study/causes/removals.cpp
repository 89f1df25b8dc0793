#include "canyon/study/causes/removals.h"

namespace canyon::study {

ModelTable<Removal> removals() {
  using mission::MissionConfig;
  static constexpr ModelRow<Removal> kRows[] = {
      {"imu",
       {[](MissionConfig& c) { c.imu.errors = "none"; }, Breadth::kOneError, false, nullptr,
        "errors of the inertial sensor"},
       "the inertial sensor without errors"},
      {"alignment",
       {[](MissionConfig& c) { c.run.initial_attitude_error_deg.setZero(); }, Breadth::kOneError, true, nullptr,
        "the error of the initial attitude"},
       "no error of the initial attitude"},
      {"reflections_healed",
       {[](MissionConfig& c) { c.gnss.tracking.multipath_scale = 0.0; }, Breadth::kOneError, false, nullptr,
        "errors of reflected signals"},
       "reflections without error: hidden satellites that are received stay so"},
      {"reflections_dropped",
       {[](MissionConfig& c) {
          c.gnss.tracking.multipath_scale = 0.0;
          c.gnss.tracking.hidden_signals = gnss::HiddenSignals::kDropped;
        },
        Breadth::kOneError, false, "reflections_healed", "signals of hidden satellites that were used"},
       "reflections without error, and hidden satellites not received"},
      {"blockage",
       {[](MissionConfig& c) { c.gnss.tracking.hidden_signals = gnss::HiddenSignals::kInSight; }, Breadth::kOneError,
        false, nullptr, "satellites that are blocked"},
       "satellites that are not received are, as under a clear sky; reflections stay"},
      {"height",
       {[](MissionConfig& c) { c.run.truth_as_height = true; }, Breadth::kOneError, false, nullptr,
        "the error of the height"},
       "the pose's height is the true one"},
      {"buildings",
       {[](MissionConfig& c) {
          c.gnss.tracking.multipath_scale = 0.0;
          c.gnss.tracking.hidden_signals = gnss::HiddenSignals::kInSight;
        },
        Breadth::kSeveral, false, nullptr, "blocked satellites and reflected signals together"},
       "all satellites received as under a clear sky, and reflections without error"},
      {"navigation",
       {[](MissionConfig& c) { c.run.truth_as_pose = true; }, Breadth::kNavigation, false, nullptr,
        "errors of the estimated pose, by no one source alone"},
       "autonomy, deskewing and map get the true pose"},
  };
  return kRows;
}

}  // namespace canyon::study
