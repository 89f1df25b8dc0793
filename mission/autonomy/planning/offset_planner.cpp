#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/mission/autonomy/planning/local_planner.h"

namespace canyon::mission {
namespace {

struct OffsetPlannerParameters {
  double horizon_m = 22.0;
  double max_offset_m = 3.5;
  double clearance_m = 0.3;
  double comfort_clearance_m = 0.8;
  double blocked_cost_1_m = 4.0;
  double closeness_cost_1_m2 = 1.0;
  double offset_cost_1_m = 0.6;
  double change_share = 0.5;
  double turning_cost_m = 5.0;
};
void visit(FieldVisitor& f, OffsetPlannerParameters& p) {
  f.number("horizon_m", p.horizon_m, {5, 60}, "offsets: how far ahead each line is driven in thought");
  f.number("max_offset_m", p.max_offset_m, {0, 20}, "offsets: how far beside the middle of its lane it may go");
  f.number("clearance_m", p.clearance_m, {0.05, 3}, "offsets: from the body's outline to the middle of a blocked cell");
  f.number("comfort_clearance_m", p.comfort_clearance_m, {0, 5}, "offsets: nearer than this costs");
  f.number("blocked_cost_1_m", p.blocked_cost_1_m, {0, 1e3},
           "offsets: cost of every metre of the horizon after an obstacle");
  f.number("closeness_cost_1_m2", p.closeness_cost_1_m2, {0, 1e3},
           "offsets: cost of every metre driven one metre nearer than comfortable");
  f.number("offset_cost_1_m", p.offset_cost_1_m, {0.01, 1e3}, "offsets: cost of every metre beside the lane's middle");
  f.number(
      "change_share", p.change_share, {0, 0.95},
      "offsets: cost of every metre beside the line chosen last, as a share of offset_cost_1_m; less than 1, so that "
      "going back to the lane always pays");
  f.number("turning_cost_m", p.turning_cost_m, {0, 1e3},
           "offsets: cost of the squared curvature beside the route's own, per metre driven");
}

constexpr double kOffsetStep_m = 0.5;
/// Within which what is left of a line's way to its offset falls to 1/e. Of all shapes this alone stays itself when it
/// is begun anew from where the vehicle has come to, as happens with every scan.
constexpr std::array<double, 3> kBlend_m{1.5, 3.0, 6.0};
constexpr double kBeyond_m = 6.0;  // of a line after the horizon, for the tracker to look at

/// Lines that go sideways from where the vehicle is to an offset from the lane's middle.
class OffsetPlanner final : public LocalPlanner {
 public:
  explicit OffsetPlanner(const OffsetPlannerParameters& p) : p_(p) {}

  Clearances clearances() const override {
    return {.least_m = p_.clearance_m, .comfort_m = std::max(p_.clearance_m, p_.comfort_clearance_m)};
  }

  LocalPlan plan(const PlanTask& task) override {
    const int steps = static_cast<int>(std::floor(p_.max_offset_m / kOffsetStep_m));
    const double here = task.route.offset(task.body.pose.p_m + task.from_O_to_W, task.s_m) - task.lane_m;
    const std::vector<double> route_turning = curvature_ahead(task);
    LocalPlan best;
    double best_cost = 1e300;
    for (int k = -steps; k <= steps; ++k) {
      for (const double blend_m : kBlend_m) {
        LocalPlan candidate{.line = line(task, here, k * kOffsetStep_m, blend_m),
                            .arc = {},
                            .offset_m = k * kOffsetStep_m,
                            .horizon_m = p_.horizon_m};
        candidate.arc = drive_in_thought(candidate.line, task.body, p_.horizon_m, clearances(), task.tracker,
                                         task.blocked, task.vehicle);
        const double its = cost(candidate, route_turning);
        if (its >= best_cost) continue;
        best_cost = its;
        best = std::move(candidate);
      }
    }
    chosen_m_ = best.offset_m;
    return best;
  }

 private:
  PlanLine line(const PlanTask& task, double from_m, double to_m, double blend_m) const {
    PlanLine out;
    const int points = static_cast<int>((p_.horizon_m + kBeyond_m) / PlanLine::kSpacing_m);
    out.points_O.reserve(static_cast<std::size_t>(points) + 1);
    for (int i = 0; i <= points; ++i) {
      const double x = i * PlanLine::kSpacing_m, s = task.s_m + x;
      const double d = task.lane_m + to_m + (from_m - to_m) * std::exp(-x / blend_m);
      const Eigen::Vector2d u = task.route.direction(s);
      // After the route's end it goes straight on, so that the tracker has something to look at.
      const Eigen::Vector2d beyond = std::max(0.0, s - task.route.length_m()) * u;
      out.points_O.emplace_back(task.route.at(s) + beyond + d * Eigen::Vector2d(-u.y(), u.x()) - task.from_O_to_W);
    }
    return out;
  }

  /// Of the route ahead, at every step of an arc.
  std::vector<double> curvature_ahead(const PlanTask& task) const {
    std::vector<double> out;
    for (double x = 0.5 * DrivenArc::kStep_m; x < p_.horizon_m + DrivenArc::kStep_m; x += DrivenArc::kStep_m)
      out.push_back(task.route.curvature(task.s_m + x));
    return out;
  }

  /// Integral of the square of what an arc turns more than the route.
  static double turning_1_m(const DrivenArc& arc, const std::vector<double>& route_1_m) {
    double sum = 0.0;
    for (std::size_t i = 0; i < arc.curvature_1_m.size() && i < route_1_m.size(); ++i) {
      const double more = static_cast<double>(arc.curvature_1_m[i]) - route_1_m[i];
      sum += DrivenArc::kStep_m * more * more;
    }
    return sum;
  }

  double cost(const LocalPlan& plan, const std::vector<double>& route_1_m) const {
    return p_.blocked_cost_1_m * (p_.horizon_m - std::min(p_.horizon_m, plan.arc.free_m)) +
           p_.closeness_cost_1_m2 * plan.arc.closeness_m2 + p_.turning_cost_m * turning_1_m(plan.arc, route_1_m) +
           p_.offset_cost_1_m * (std::abs(plan.offset_m) + p_.change_share * std::abs(plan.offset_m - chosen_m_));
  }

  OffsetPlannerParameters p_;
  double chosen_m_ = 0.0;
};

}  // namespace

std::unique_ptr<LocalPlanner> make_offset_planner(const ModelParameters& own) {
  return std::make_unique<OffsetPlanner>(own.get<OffsetPlannerParameters>());
}

void offset_planner_parameters(ModelParameters& section) {
  section.add<OffsetPlannerParameters>();
}

}  // namespace canyon::mission
