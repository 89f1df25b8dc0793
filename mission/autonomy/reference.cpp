#include "canyon/mission/autonomy/reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "canyon/mission/autonomy/perception/odometry_frame.h"
#include "canyon/mission/autonomy/route_driver.h"

namespace canyon::mission {
namespace {

constexpr double kSeenSlack_m = 1.0;  // between the last return in a direction and what counts as seen

template <auto Rows, class... At>
auto part(const ModelChoice<Rows>& choice, const At&... at) {
  return model_row(Rows(), choice.name).make(choice.own, at...);
}

class Reference final : public Autonomy {
 public:
  Reference(const ReferenceParameters& own, const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime start)
      : config_(config),
        vehicle_(prior.vehicle),
        start_(start),
        last_seen_(start),
        standing_since_(start),
        driver_(config, prior),
        perception_(part(own.perception.model, vehicle_)),
        lane_(part(own.lane.model)),
        planner_(part(own.planner.model)),
        tracker_(part(own.tracker.model, vehicle_)),
        speed_(part(own.speed.model)),
        recovery_(part(own.recovery.model)),
        self_check_(model_row(self_checks(), own.self_check.model.name).make.make(own.self_check.model.own)) {
    if (own.memory_by == "wheel") wheel_.emplace(Wheel{.t = start});
  }

  void count(const OdometerSample& sample) override {
    self_check_->count(sample);
    if (!wheel_) return;
    wheel_->way_m += sample.speed_m_s * sample.dt_s;
    wheel_->speed_m_s = sample.speed_m_s;
    wheel_->t = sample.t;
  }

  void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) override {
    self_check_->see(scan, X_WL, estimate);
    const PlanPose body = frame_.at(estimate);
    const Pose X_OB{estimate.X_WB.R, {body.p_m.x(), body.p_m.y(), 0.0}};
    const Pose X_OL{X_WL.R, X_WL.p - estimate.X_WB.p + X_OB.p};
    if (!perception_->see(scan, X_OL, X_OB, scan.t - start_)) return;
    plan(body, estimate, scan, X_OL, X_OB);
    last_seen_ = scan.t;
  }

  std::optional<KeptReturns> keeps() const override {
    KeptReturns keeps = perception_->keeps();
    if (const auto more = lane_->keeps()) keeps = both(keeps, *more);
    if (const auto more = self_check_->keeps()) keeps = both(keeps, *more);
    return keeps;
  }

  DriveCommand drive(const NavEstimate& estimate) override {
    const bool stands = driver_.update(estimate);
    frame_.follow(estimate, estimate.t - standing_since_ > halting_s(), counted(estimate.t));
    const DriveCommand command = decide(estimate.t, stands);
    steering_rad_ = steered_rad(steering_rad_, command.curvature_1_m, estimate.t - last_drive_, vehicle_);
    last_drive_ = estimate.t;
    if (command.speed_m_s != 0.0) standing_since_ = estimate.t;
    return command;
  }

  AutonomyState state() const override { return state_; }
  int next_waypoint() const override { return driver_.next_waypoint(); }

 private:
  /// After so long without being asked to go, it stands.
  double halting_s() const { return config_.cruise_m_s / vehicle_.max_deceleration_m_s2 + 1.0; }

  std::optional<OdometryFrame::Counted> counted(GpsTime t) {
    if (!wheel_) return std::nullopt;
    const double now_m = wheel_->way_m + (t - wheel_->t) * wheel_->speed_m_s;
    return OdometryFrame::Counted{now_m - std::exchange(wheel_->told_m, now_m), wheel_->speed_m_s,
                                  vehicle_.counted_wheel_left_m};
  }

  MovingBody moving() const { return {frame_.body(), frame_.speed_m_s(), steering_rad_}; }

  void plan(const PlanPose& body, const NavEstimate& estimate, const LidarScan& scan, const Pose& X_OL,
            const Pose& X_OB) {
    const Eigen::Vector2d to_W = estimate.X_WB.p.head<2>() - body.p_m;
    const double across_m2 = estimate.pose_covariance(4, 4);
    const double sigma_m = across_m2 > 0.0 ? std::sqrt(across_m2) : 0.0;
    const double lane_m = lane_->middle_m({driver_.route(), driver_.s_m(), to_W, body, sigma_m, scan.t - last_seen_,
                                           perception_->blocked(), &scan, &X_OL, &X_OB});
    MovingBody moving = this->moving();
    moving.pose = body;
    plan_ = planner_->plan(
        {driver_.route(), driver_.s_m(), to_W, lane_m, moving, perception_->blocked(), *tracker_, vehicle_});
    planned_at_m_ = frame_.driven_m();
    seen_m_ = seen_m(body);
  }

  /// Along the line, from the front bumper to where it goes out of what the last scan saw.
  double seen_m(const PlanPose& body) const {
    for (std::size_t i = 0; i < plan_.line.points_O.size(); ++i) {
      const Eigen::Vector2d d = plan_.line.points_O[i] - body.p_m;
      if (d.norm() > perception_->seen_m(d) + kSeenSlack_m)
        return std::max(0.0, static_cast<double>(i) * PlanLine::kSpacing_m - vehicle_.front_m);
    }
    return static_cast<double>(plan_.line.points_O.size()) * PlanLine::kSpacing_m;
  }

  DriveCommand decide(GpsTime t, bool stands) {
    DriveCommand command;
    if (self_check_->trust() == Trust::kLost) {
      state_ = AutonomyState::kLost;
      return command;
    }
    if (stands) {
      state_ = driver_.done() ? AutonomyState::kDone : AutonomyState::kObserving;
      return command;
    }
    if (plan_.line.empty() || t - last_seen_ > config_.blind_after_s) {
      state_ = AutonomyState::kBlind;
      return command;
    }
    command = tracked();
    state_ = command.speed_m_s > 0.0 ? AutonomyState::kDriving : AutonomyState::kBlocked;
    const auto instead = recovery_->act({t - start_, command.speed_m_s == 0.0, frame_.driven_m(), plan_, moving(),
                                         planner_->clearances(), perception_->blocked(), vehicle_});
    if (!instead) return command;
    state_ = AutonomyState::kBlocked;
    return *instead;
  }

  /// The plan, driven on from where the vehicle has come since it was made.
  DriveCommand tracked() {
    const PlanPose body = frame_.body();
    const double since_m = frame_.driven_m() - planned_at_m_;
    const std::size_t nearest = plan_.line.nearest(body.p_m, 0);
    DriveCommand command;
    command.curvature_1_m = tracker_->curvature_1_m(plan_.line, nearest, body, std::max(0.0, frame_.speed_m_s()));
    const auto gone = static_cast<std::size_t>(since_m / DrivenArc::kStep_m);
    const std::span<const float> curvature(plan_.arc.curvature_1_m);
    command.speed_m_s = speed_->allowed_m_s({.route_m_s = driver_.allowed_speed_m_s(),
                                             .free_to_end = plan_.arc.ends_free,
                                             .free_m = plan_.arc.free_m - since_m,
                                             .seen_m = seen_m_ - since_m,
                                             .curvature_1_m = curvature.subspan(std::min(gone, curvature.size())),
                                             .step_m = DrivenArc::kStep_m,
                                             .braking_m_s2 = config_.braking_m_s2,
                                             .lateral_m_s2 = config_.lateral_m_s2,
                                             .max_yaw_rate_rad_s = vehicle_.max_yaw_rate_rad_s});
    if (self_check_->trust() == Trust::kDoubtful)
      command.speed_m_s = std::min(command.speed_m_s, self_check_->speed_limit_m_s());
    return command;
  }

  AutonomyConfig config_;
  KnownVehicle vehicle_;
  GpsTime start_, last_seen_, standing_since_;
  GpsTime last_drive_ = start_;
  RouteDriver driver_;
  OdometryFrame frame_;
  /// What the odometer has counted; none: the frame goes by the estimate.
  struct Wheel {
    GpsTime t;  ///< of its last sample
    double way_m = 0.0, speed_m_s = 0.0;
    double told_m = 0.0;  ///< of that way, and of what has been reckoned on from it, to the frame
  };
  std::optional<Wheel> wheel_;
  std::unique_ptr<Perception> perception_;
  std::unique_ptr<LaneReference> lane_;
  std::unique_ptr<LocalPlanner> planner_;
  std::unique_ptr<Tracker> tracker_;
  std::unique_ptr<SpeedRule> speed_;
  std::unique_ptr<Recovery> recovery_;
  std::unique_ptr<SelfCheck> self_check_;
  LocalPlan plan_;
  double planned_at_m_ = 0.0, seen_m_ = 0.0, steering_rad_ = 0.0;
  AutonomyState state_ = AutonomyState::kBlind;
};

}  // namespace

void visit(FieldVisitor& f, ReferenceParameters& c) {
  f.group("perception", c.perception, "reference: where it cannot drive, from its scans");
  f.group("lane", c.lane, "reference: where the middle of its lane is");
  f.group("planner", c.planner, "reference: where it drives next");
  f.group("tracker", c.tracker, "reference: how it steers along that");
  f.group("speed", c.speed, "reference: how fast");
  f.group("recovery", c.recovery, "reference: what it does where no way is free");
  f.group("self_check", c.self_check, "reference: whether it believes its estimate");
  f.choice("memory_by", c.memory_by, {"estimate", "wheel"},
           "reference: whose speed tells it how far it has come from what it has seen; wheel = an odometer of its own");
}

bool counts_wheel(const AutonomyConfig& config) {
  if (config.model.name != "reference") return false;
  const auto& own = config.model.own.get<ReferenceParameters>();
  return own.memory_by == "wheel" || model_row(self_checks(), own.self_check.model.name).make.counts;
}

std::unique_ptr<Autonomy> make_reference(const ModelParameters& own, const AutonomyConfig& config,
                                         const PriorKnowledge& prior, GpsTime start) {
  return std::make_unique<Reference>(own.get<ReferenceParameters>(), config, prior, start);
}

}  // namespace canyon::mission
