#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "canyon/mission/autonomy/planning/local_planner.h"
#include "canyon/mission/autonomy/planning/plan_parameters.h"

namespace canyon::mission {
namespace {

constexpr double kOffsetStep_m = 0.5;
/// Within which what is left of a line's way to its offset falls to 1/e. Of all shapes this alone stays itself when it
/// is begun anew from where the vehicle has come to, as happens with every scan.
constexpr std::array<double, 3> kBlend_m{1.5, 3.0, 6.0};

/// Lines that go sideways from where the vehicle is to an offset from the lane's middle. Driven in thought are those
/// that may still be the cheapest: the cheap ones first, each as long as what it has cost so far is less than the best.
class OffsetPlanner final : public LocalPlanner {
 public:
  explicit OffsetPlanner(const PlanParameters& p) : p_(p) {
    const int points = static_cast<int>((p_.horizon_m + kBeyondHorizon_m) / PlanLine::kSpacing_m);
    for (int i = 0; i <= points; ++i) {
      ahead_m_.push_back(i * PlanLine::kSpacing_m);
      for (std::size_t b = 0; b < kBlend_m.size(); ++b) left_[b].push_back(std::exp(-ahead_m_.back() / kBlend_m[b]));
    }
  }

  Clearances clearances() const override {
    return {.least_m = p_.clearance_m, .comfort_m = std::max(p_.clearance_m, p_.comfort_clearance_m)};
  }

  LocalPlan plan(const PlanTask& task) override {
    const double here = task.route.offset(task.body.pose.p_m + task.from_O_to_W, task.s_m) - task.lane_m;
    lay_out(task);
    offer(here);
    const double halting_m = halting_way_m(task.body, task.vehicle);
    for (Candidate& c : candidates_)
      c.beside_cost = p_.offset_cost_1_m * (std::abs(c.offset_m) + p_.change_share * std::abs(c.offset_m - chosen_m_));
    std::vector<std::size_t> order(candidates_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return candidates_[a].beside_cost < candidates_[b].beside_cost;
    });
    const Room room(task.body.pose, clearances(), task.blocked, task.vehicle);
    LocalPlan best;
    double best_cost = 1e300;
    std::size_t best_index = candidates_.size();
    for (const std::size_t i : order) {
      const Candidate& c = candidates_[i];
      if (c.beside_cost > best_cost) break;
      LocalPlan its{.line = line(task.lane_m + c.offset_m, here - c.offset_m, c.blend),
                    .arc = {},
                    .offset_m = c.offset_m,
                    .horizon_m = p_.horizon_m};
      Turning turning(turning_1_m_);
      its.arc = drive_in_thought(its.line, task.body, p_.horizon_m, task.tracker, room, 0.0, [&](const DrivenArc& arc) {
        return cost(0.0, arc, turning.of(arc), c.beside_cost) <= best_cost;
      });
      const double blocked_m = p_.horizon_m - std::min(p_.horizon_m, its.arc.free_m);
      const double crash = its.arc.ends_free ? 0.0 : crash_cost(halting_m, its.arc.free_m, its.arc.untouched_m);
      const double its_cost = cost(blocked_m, its.arc, turning.of(its.arc), c.beside_cost) + crash;
      if (its_cost > best_cost || (its_cost == best_cost && i > best_index)) continue;
      best_cost = its_cost;
      best_index = i;
      best = std::move(its);
    }
    chosen_m_ = best.offset_m;
    return best;
  }

 private:
  struct Candidate {
    double offset_m;
    std::size_t blend;
    double beside_cost;
  };

  void offer(double here_m) {
    const OffsetRange range = offset_range(p_, here_m);
    const int first = static_cast<int>(std::ceil(range.right_m / kOffsetStep_m)),
              last = static_cast<int>(std::floor(range.left_m / kOffsetStep_m));
    candidates_.clear();
    for (int k = first; k <= last; ++k)
      for (std::size_t b = 0; b < kBlend_m.size(); ++b) candidates_.push_back({k * kOffsetStep_m, b, 0.0});
  }

  /// Integral of the square of what an arc turns more than the route, taken further as the arc grows.
  class Turning {
   public:
    explicit Turning(const std::vector<double>& route_1_m) : route_(route_1_m) {}
    double of(const DrivenArc& arc) {
      for (; done_ < arc.curvature_1_m.size() && done_ < route_.size(); ++done_) {
        const double more = static_cast<double>(arc.curvature_1_m[done_]) - route_[done_];
        sum_ += DrivenArc::kStep_m * more * more;
      }
      return sum_;
    }

   private:
    const std::vector<double>& route_;
    std::size_t done_ = 0;
    double sum_ = 0.0;
  };

  /// The route ahead: places in O, directions to its left, and how it turns at every step of an arc.
  void lay_out(const PlanTask& task) {
    route_O_.clear();
    left_O_.clear();
    for (const double x : ahead_m_) {
      const double s = task.s_m + x;
      const Eigen::Vector2d u = task.route.direction(s);
      // After the route's end it goes straight on, so that the tracker has something to look at.
      const Eigen::Vector2d beyond = std::max(0.0, s - task.route.length_m()) * u;
      route_O_.emplace_back(task.route.at(s) + beyond - task.from_O_to_W);
      left_O_.emplace_back(-u.y(), u.x());
    }
    turning_1_m_.clear();
    for (double x = 0.5 * DrivenArc::kStep_m; x < p_.horizon_m + DrivenArc::kStep_m; x += DrivenArc::kStep_m)
      turning_1_m_.push_back(task.route.curvature(task.s_m + x));
  }

  /// To `to_m` beside the route, from `from_m` further off.
  PlanLine line(double to_m, double from_m, std::size_t blend) const {
    PlanLine out;
    out.points_O.reserve(route_O_.size());
    for (std::size_t i = 0; i < route_O_.size(); ++i)
      out.points_O.emplace_back(route_O_[i] + (to_m + from_m * left_[blend][i]) * left_O_[i]);
    return out;
  }

  /// Grows with every part of it: what an arc has cost so far is no more than what it will cost.
  double cost(double blocked_m, const DrivenArc& arc, double turning, double beside_cost) const {
    return p_.blocked_cost_1_m * blocked_m + p_.closeness_cost_1_m2 * arc.closeness_m2 + p_.turning_cost_m * turning +
           beside_cost;
  }

  PlanParameters p_;
  std::vector<Candidate> candidates_;
  std::vector<double> ahead_m_;                            ///< of the vehicle, of each point of a line
  std::array<std::vector<double>, kBlend_m.size()> left_;  ///< of a way to an offset, there
  std::vector<Eigen::Vector2d> route_O_, left_O_;
  std::vector<double> turning_1_m_;
  double chosen_m_ = 0.0;
};

}  // namespace

std::unique_ptr<LocalPlanner> make_offset_planner(const ModelParameters& own) {
  return std::make_unique<OffsetPlanner>(own.get<PlanParameters>());
}

}  // namespace canyon::mission
