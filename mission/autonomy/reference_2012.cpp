#include "canyon/mission/autonomy/reference_2012.h"

#include <algorithm>
#include <cmath>

#include "canyon/mission/autonomy/local_grid.h"
#include "canyon/mission/autonomy/route_driver.h"

namespace canyon::mission {

namespace {

constexpr double kSample = 0.5;      // m, between its checked points
constexpr double kOffsetStep = 0.5;  // m, between candidates
constexpr int kEnoughReturns = 100;  // fewer count as blind

/// The path from arc length s0 on, moving sideways from offset d0 to d1 over `blend` metres.
struct Candidate {
  double s0 = 0, d0 = 0, d1 = 0, blend = 6;

  Eigen::Vector2d at(const Path& route, double s) const {
    const double x = std::clamp((s - s0) / blend, 0.0, 1.0);
    const double d = d0 + (d1 - d0) * x * x * (3.0 - 2.0 * x);
    const Eigen::Vector2d u = route.direction(s);
    return route.at(s) + d * Eigen::Vector2d(-u.y(), u.x());
  }
};

class Reference2012 final : public Autonomy {
 public:
  Reference2012(const Reference2012Parameters& own, const AutonomyConfig& config, const PriorKnowledge& prior,
                GpsTime start)
      : own_(own),
        blind_after_s_(config.blind_after_s),
        driver_(config, prior),
        start_(start),
        grid_(own.grid),
        last_seen_(start) {}

  void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) override {
    if (static_cast<int>(scan.points.size()) < kEnoughReturns) return;
    last_seen_ = scan.t;
    points_.clear();
    for (const LidarPoint& point : scan.points) points_.emplace_back(point.x, point.y, point.z);
    grid_.add(points_, X_WL, estimate.X_WB, scan.t - start_);
    grid_.update_distances();
    plan(estimate);
  }

  std::optional<KeptReturns> keeps() const override {
    const LocalGridConfig& grid = own_.grid;
    return KeptReturns{.low_m = grid.min_depth_m,
                       .high_m = grid.max_obstacle_height_m,
                       .half_size_m = grid.half_size_m + 2.0 * grid.cell_m,
                       .enough = kEnoughReturns};
  }

  DriveCommand drive(const NavEstimate& estimate) override {
    const bool stands = driver_.update(estimate);
    const double speed = estimate.v_WB_W.head<2>().norm();
    DriveCommand command;
    command.curvature_1_m = driver_.pursue(estimate, chosen_.at(driver_.route(), driver_.target_s_m(speed)));
    if (stands) {
      state_ = driver_.done() ? AutonomyState::kDone : AutonomyState::kObserving;
      return command;
    }
    if (estimate.t - last_seen_ > blind_after_s_) {
      state_ = AutonomyState::kBlind;
      return command;
    }
    command.speed_m_s = allowed_speed();
    state_ = command.speed_m_s > 0.0 ? AutonomyState::kDriving : AutonomyState::kBlocked;
    return command;
  }

  AutonomyState state() const override { return state_; }
  int next_waypoint() const override { return driver_.next_waypoint(); }

 private:
  void plan(const NavEstimate& estimate) {
    const Eigen::Vector2d p = estimate.X_WB.p.head<2>();
    const Path& route = driver_.route();
    const double s = driver_.s_m(), here = route.offset(p, s);
    const double speed = estimate.v_WB_W.head<2>().norm();
    const int steps = static_cast<int>(std::floor(own_.max_offset_m / kOffsetStep));
    const PathChoiceConfig& choice = own_.choice;
    double best_cost = 1e300;
    Candidate best = chosen_;
    for (int k = -steps; k <= steps; ++k) {
      const Candidate candidate{s, here, k * kOffsetStep, std::max(5.0, 1.6 * speed)};
      double free_m = choice.horizon_m, closeness = 0.0;
      for (double x = 0.0; x <= choice.horizon_m; x += kSample) {
        const double distance = grid_.distance_m(candidate.at(route, s + x));
        if (distance < own_.clearance_m) {
          free_m = x;
          break;
        }
        closeness += kSample * std::max(0.0, choice.comfort_clearance_m - distance);
      }
      const double cost = choice.blocked_cost_1_m * (choice.horizon_m - free_m) +
                          choice.closeness_cost_1_m2 * closeness + choice.offset_cost_1_m * std::abs(candidate.d1) +
                          choice.change_cost_1_m * std::abs(candidate.d1 - chosen_.d1);
      if (cost < best_cost) {
        best_cost = cost;
        best = candidate;
        free_m_ = free_m;
        free_from_s_ = s;
      }
    }
    chosen_ = best;
  }

  double allowed_speed() const {
    const double v = driver_.allowed_speed_m_s();
    const double free_m = free_m_ - (driver_.s_m() - free_from_s_), margin_m = own_.choice.stop_margin_m;
    if (free_m_ >= own_.choice.horizon_m) return v;
    if (free_m < margin_m + 0.3) return 0.0;
    return std::min(v, driver_.braking_to_m_s(free_m - margin_m));
  }

  Reference2012Parameters own_;
  double blind_after_s_;
  RouteDriver driver_;
  GpsTime start_;
  LocalGrid grid_;
  std::vector<Eigen::Vector3f> points_;
  GpsTime last_seen_;
  Candidate chosen_;
  double free_m_ = 0.0, free_from_s_ = 0.0;
  AutonomyState state_ = AutonomyState::kBlind;
};

}  // namespace

void visit(FieldVisitor& f, PathChoiceConfig& c) {
  f.number("horizon_m", c.horizon_m, {5, 100}, "how far ahead each path is checked");
  f.number("stop_margin_m", c.stop_margin_m, {0, 20},
           "kept free ahead of the rear axle when halting before an obstacle");
  f.number("comfort_clearance_m", c.comfort_clearance_m, {0, 10}, "closer to an obstacle than this costs");
  f.number("blocked_cost_1_m", c.blocked_cost_1_m, {0, 1e3}, "cost of every metre of the horizon behind an obstacle");
  f.number("closeness_cost_1_m2", c.closeness_cost_1_m2, {0, 1e3},
           "cost of every metre driven one metre closer to an obstacle than comfortable");
  f.number("offset_cost_1_m", c.offset_cost_1_m, {0, 1e3}, "cost of every metre beside the centre line");
  f.number("change_cost_1_m", c.change_cost_1_m, {0, 1e3}, "cost of every metre beside the path chosen last");
}

void visit(FieldVisitor& f, Reference2012Parameters& c) {
  f.number("max_offset_m", c.max_offset_m, {0, 20},
           "reference_2012: how far it may leave the centre line of the street");
  f.number("clearance_m", c.clearance_m, {0.1, 5}, "reference_2012: from its axis to an obstacle");
  f.group("grid", c.grid, "reference_2012: its picture of the surroundings: a rolling height grid");
  f.group("choice", c.choice, "reference_2012: how it chooses among paths beside the centre line");
}

std::unique_ptr<Autonomy> make_reference_2012(const ModelParameters& own, const AutonomyConfig& config,
                                              const PriorKnowledge& prior, GpsTime start) {
  return std::make_unique<Reference2012>(own.get<Reference2012Parameters>(), config, prior, start);
}

}  // namespace canyon::mission
