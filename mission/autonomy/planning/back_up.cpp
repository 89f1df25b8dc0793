#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/mission/autonomy/planning/recovery.h"

namespace canyon::mission {
namespace {

struct BackUpParameters {
  double wait_s = 2.0;
  double way_m = 6.0;
  double speed_m_s = 1.0;
};
void visit(FieldVisitor& f, BackUpParameters& p) {
  f.number("wait_s", p.wait_s, {0, 60}, "back_up: how long it stands before something that may go away");
  f.number("way_m", p.way_m, {0.5, 30}, "back_up: how far at most, each time");
  f.number("speed_m_s", p.speed_m_s, {0.1, 5}, "back_up: how fast");
}

constexpr double kRoomAhead_m = 8.0;  // of a way that is worth going on
constexpr double kMore_m = 0.5;       // once there is one
constexpr double kLeast_m = 0.5;      // a shorter way back is none
constexpr double kBraking_m_s2 = 0.5;

class BackUp final : public Recovery {
 public:
  explicit BackUp(const BackUpParameters& p) : p_(p) {}

  std::optional<DriveCommand> act(const RecoveryTask& task) override {
    if (backing_) return back(task);
    if (!task.blocked) {
      waiting_ = false;
      return std::nullopt;
    }
    if (!waiting_) {
      waiting_ = true;
      since_s_ = task.t_s;
    }
    if (task.t_s - since_s_ < p_.wait_s || !choose(task)) return std::nullopt;
    backing_ = true;
    from_m_ = task.driven_m;
    until_m_ = p_.way_m;
    return back(task);
  }

 private:
  /// Straight back if there is room, else on the arc with most of it.
  bool choose(const RecoveryTask& task) {
    const double most = std::tan(task.vehicle.max_steering_rad) / task.vehicle.wheelbase_m;
    double longest = kLeast_m;
    bool any = false;
    for (const double share : {0.0, 0.5, -0.5, 1.0, -1.0}) {
      const double way = room_m(task, share * most, p_.way_m);
      if (way < longest || (any && way == longest)) continue;
      longest = way;
      any = true;
      curvature_ = share * most;
    }
    return any;
  }

  static double room_m(const RecoveryTask& task, double curvature, double way_m) {
    return free_along(task.body.pose, curvature, -way_m, task.clearances, task.blocked_cells, task.vehicle);
  }

  DriveCommand back(const RecoveryTask& task) {
    const double gone = task.driven_m - from_m_;
    const bool way_ahead = task.plan.arc.ends_free || task.plan.arc.free_m > kRoomAhead_m;
    if (way_ahead) until_m_ = std::min(until_m_, gone + kMore_m);
    const double left = std::min(until_m_ - gone, room_m(task, curvature_, p_.way_m));
    DriveCommand command{.speed_m_s = 0.0, .curvature_1_m = curvature_};
    if (left > 0.1) {
      command.speed_m_s = -std::min(p_.speed_m_s, std::sqrt(2.0 * kBraking_m_s2 * left));
    } else if (std::abs(task.body.speed_m_s) < 0.1) {
      backing_ = waiting_ = false;
    }
    return command;
  }

  BackUpParameters p_;
  bool waiting_ = false, backing_ = false;
  double since_s_ = 0.0, from_m_ = 0.0, until_m_ = 0.0, curvature_ = 0.0;
};

}  // namespace

std::unique_ptr<Recovery> make_back_up(const ModelParameters& own) {
  return std::make_unique<BackUp>(own.get<BackUpParameters>());
}

double back_up_wait_s(const ModelParameters& own) {
  return own.get<BackUpParameters>().wait_s;
}

void back_up_parameters(ModelParameters& section) {
  section.add<BackUpParameters>();
}

}  // namespace canyon::mission
