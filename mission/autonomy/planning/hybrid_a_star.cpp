#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <queue>
#include <unordered_map>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/mission/autonomy/planning/local_planner.h"

namespace canyon::mission {
namespace {

struct HybridAStarParameters {
  double reach_m = 22.0;
  double room_m = 6.0;
  double least_clearance_m = 0.3;
  double calm_clearance_m = 0.8;
  double beside_cost_1_m = 0.3;
  double near_cost_1_m = 1.0;
  double bend_cost_m2 = 5.0;
  double switch_share = 0.5;
  std::int64_t most_nodes = 2000;
};
void visit(FieldVisitor& f, HybridAStarParameters& p) {
  f.number("reach_m", p.reach_m, {5, 60}, "hybrid_a_star: how far along the route it searches");
  f.number("room_m", p.room_m, {0, 30}, "hybrid_a_star: how far beside the middle of its lane it may go");
  f.number("least_clearance_m", p.least_clearance_m, {0.05, 3},
           "hybrid_a_star: from the body's outline to the middle of a blocked cell");
  f.number("calm_clearance_m", p.calm_clearance_m, {0, 5}, "hybrid_a_star: nearer than this costs");
  f.number("beside_cost_1_m", p.beside_cost_1_m, {0.01, 100},
           "hybrid_a_star: cost of a metre of way a metre beside the lane's middle, in metres of way");
  f.number("near_cost_1_m", p.near_cost_1_m, {0, 100},
           "hybrid_a_star: cost of a metre of way a metre nearer than calm");
  f.number("bend_cost_m2", p.bend_cost_m2, {0, 1e3},
           "hybrid_a_star: cost of a metre of way, times the square of its curvature beside the route's");
  f.number("switch_share", p.switch_share, {0, 0.95},
           "hybrid_a_star: cost of a metre of way a metre beside the last plan, as a share of beside_cost_1_m");
  f.integer("most_nodes", p.most_nodes, {10, 1000000},
            "hybrid_a_star: nodes that are opened at most; then the one that leads farthest counts");
}

constexpr double kStep_m = 1.0;       // of one piece of a way
constexpr double kCell_m = 0.5;       // of place, within which one node is kept
constexpr int kHeadings = 48;         // of a full turn, likewise
constexpr int kShotEvery = 8;         // nodes
constexpr double kShotBlend_m = 3.0;  // within which what is left of a shot's way to the lane falls to 1/e
constexpr double kBeyondEnd_m = 6.0;  // of a line after the reach, for the tracker to look at
/// Along a bend's inner side a metre of the route takes less than a metre of way.
constexpr double kLeastWay = 0.5;

/// Search over arcs that the vehicle can drive, through places and headings (hybrid A*: Dolgov, Thrun, Montemerlo and
/// Diebel 2010, "Path planning for autonomous vehicles in unknown semi-structured environments"), the body's rectangle
/// clear all along. As there, every few nodes it tries to get to the end at once: here by driving in thought to the
/// lane's middle and along it, as the tracker will; on a free street that is all. What is found is driven in thought as
/// a whole. It goes forwards only: backing up is the recovery's.
class HybridAStar final : public LocalPlanner {
 public:
  explicit HybridAStar(const HybridAStarParameters& p) : p_(p) {}

  Clearances clearances() const override {
    return {.least_m = p_.least_clearance_m, .comfort_m = std::max(p_.least_clearance_m, p_.calm_clearance_m)};
  }

  LocalPlan plan(const PlanTask& task) override {
    LocalPlan best;
    // A tracker cuts corners: first with room for that.
    for (const double room_m : {0.25, 0.0}) {
      Clearances wanted = clearances();
      wanted.least_m += room_m;
      wanted.comfort_m += room_m;
      const Search search(p_, wanted, task, last_);
      LocalPlan plan{.line = search.line(), .arc = {}, .offset_m = 0.0, .horizon_m = p_.reach_m};
      plan.arc =
          drive_in_thought(plan.line, task.body, p_.reach_m, clearances(), task.tracker, task.blocked, task.vehicle);
      if (best.line.empty() || plan.arc.free_m > best.arc.free_m) best = std::move(plan);
      if (best.arc.ends_free) break;
    }
    remember(task, best);
    return best;
  }

 private:
  /// The last line beside the lane's middle, metre by metre of the route.
  struct Beside {
    double from_s_m = 0.0;
    std::vector<double> offset_m;
    std::optional<double> at(double s_m) const {
      const double i = s_m - from_s_m;
      if (!(i >= 0.0) || i >= static_cast<double>(offset_m.size())) return std::nullopt;
      return offset_m[static_cast<std::size_t>(i)];
    }
  };

  class Search {
   public:
    Search(const HybridAStarParameters& p, const Clearances& clearances, const PlanTask& task, const Beside& last)
        : p_(p), clearances_(clearances), task_(task), last_(last), end_s_m_(task.s_m + p.reach_m) {
      const double at_start = task.blocked.clearance_m(task.body.pose, task.vehicle, clearances.comfort_m);
      start_clearance_m_ = std::max(0.0, at_start - 0.05);
      const double most = std::tan(task.vehicle.max_steering_rad) / task.vehicle.wheelbase_m;
      for (std::size_t i = 0; i < kappa_.size(); ++i) kappa_[i] = most * (static_cast<double>(i) / 4.0 - 1.0);
      Node first{.pose = task.body.pose, .s_m = task.s_m};
      first.beside_m = beside_m(first.pose, first.s_m);
      first.steering_rad = task.body.steering_rad;
      add(first);
      run();
    }

    /// From the body to the end, or to the node that leads farthest, and on beside the route there.
    PlanLine line() const {
      PlanLine line;
      std::vector<std::int32_t> way;
      for (std::int32_t i = end_; i >= 0; i = nodes_[static_cast<std::size_t>(i)].parent) way.push_back(i);
      line.points_O.push_back(task_.body.pose.p_m);
      for (std::size_t k = way.size() - 1; k-- > 0;) {
        const Node& node = nodes_[static_cast<std::size_t>(way[k])];
        const PlanPose from = nodes_[static_cast<std::size_t>(node.parent)].pose;
        for (double x = PlanLine::kSpacing_m; x <= kStep_m + 1e-9; x += PlanLine::kSpacing_m)
          line.points_O.push_back(from.along(node.kappa_1_m, x).p_m);
      }
      const Node& end = nodes_[static_cast<std::size_t>(end_)];
      const PlanLine rest = shot_line(end);
      line.points_O.insert(line.points_O.end(), rest.points_O.begin() + 1, rest.points_O.end());
      return line;
    }

   private:
    struct Node {
      PlanPose pose;
      double s_m = 0.0, beside_m = 0.0;
      double kappa_1_m = 0.0, steering_rad = 0.0;  ///< that led here, and what the wheels had then
      double way_m = 0.0, cost_m = 0.0;
      std::int32_t parent = -1;
    };
    struct Open {
      double bound_m;
      std::int32_t node;  ///< the negative of one less: its shot, whose whole cost the bound is
      bool operator>(const Open& o) const { return bound_m != o.bound_m ? bound_m > o.bound_m : node > o.node; }
    };

    double beside_m(const PlanPose& pose, double s_m) const {
      return task_.route.offset(pose.p_m + task_.from_O_to_W, s_m) - task_.lane_m;
    }
    /// Along the route rather than aside before something that bars it.
    static double farness_m(const Node& node) { return node.s_m - 0.5 * std::abs(node.beside_m); }
    double left_m(const Node& node) const { return kLeastWay * std::max(0.0, end_s_m_ - node.s_m); }

    std::uint64_t cell_of(const PlanPose& pose) const {
      const auto whole = [](double v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v))); };
      const double turn = wrap_pi(pose.yaw_rad) / (2.0 * std::numbers::pi) + 0.5;
      const Eigen::Vector2d d = (pose.p_m - task_.body.pose.p_m) / kCell_m;
      return ((whole(d.x()) & 0xffffU) << 32U) | ((whole(d.y()) & 0xffffU) << 16U) | whole(turn * kHeadings);
    }

    void add(const Node& node) {
      const auto [at, fresh] = best_.try_emplace(cell_of(node.pose), node.cost_m);
      if (!fresh) {
        if (at->second <= node.cost_m) return;
        at->second = node.cost_m;
      }
      nodes_.push_back(node);
      open_.push({node.cost_m + left_m(node), static_cast<std::int32_t>(nodes_.size()) - 1});
    }

    void run() {
      std::int64_t opened = 0;
      while (!open_.empty() && opened < p_.most_nodes) {
        const Open next = open_.top();
        open_.pop();
        if (next.node < 0) {
          end_ = -next.node - 1;
          return;
        }
        const Node node = nodes_[static_cast<std::size_t>(next.node)];
        if (best_[cell_of(node.pose)] < node.cost_m) continue;
        if (farness_m(node) > farness_m(nodes_[static_cast<std::size_t>(end_)])) end_ = next.node;
        if (node.s_m >= end_s_m_) {
          end_ = next.node;
          return;
        }
        if (opened++ % kShotEvery == 0) shoot(next.node);
        for (const double kappa : kappa_) step(next.node, kappa);
      }
    }

    void step(std::int32_t parent, double kappa) {
      Node node = nodes_[static_cast<std::size_t>(parent)];
      const double steering = std::atan(kappa * task_.vehicle.wheelbase_m);
      const double most = task_.vehicle.max_steering_rate_rad_s * kStep_m / std::max(1.0, task_.body.speed_m_s);
      if (std::abs(steering - node.steering_rad) > most + 1e-9) return;
      const PlanPose from = node.pose;
      double near_m2 = 0.0;
      for (double x = DrivenArc::kStep_m; x <= kStep_m + 1e-9; x += DrivenArc::kStep_m) {
        node.pose = from.along(kappa, x);
        const double clearance = task_.blocked.clearance_m(node.pose, task_.vehicle, clearances_.comfort_m);
        if (clearance < std::min(clearances_.least_m, start_clearance_m_ + 0.1 * (node.way_m + x))) return;
        near_m2 += DrivenArc::kStep_m * std::max(0.0, clearances_.comfort_m - clearance);
      }
      const double s = task_.route.project(node.pose.p_m + task_.from_O_to_W, node.s_m, node.s_m + 2.0 * kStep_m);
      node.s_m = std::min(s, node.s_m + kStep_m / kLeastWay);
      node.beside_m = beside_m(node.pose, node.s_m);
      if (std::abs(node.beside_m) > p_.room_m) return;
      const double more = kappa - task_.route.curvature(node.s_m);
      node.way_m += kStep_m;
      node.cost_m += kStep_m * (1.0 + beside_cost(node.s_m, node.beside_m) + p_.bend_cost_m2 * more * more) +
                     p_.near_cost_1_m * near_m2;
      node.kappa_1_m = kappa;
      node.steering_rad = steering;
      node.parent = parent;
      add(node);
    }

    double beside_cost(double s_m, double beside_m) const {
      const std::optional<double> before = last_.at(s_m);
      const double switched = before ? p_.switch_share * std::abs(beside_m - *before) : 0.0;
      return p_.beside_cost_1_m * (std::abs(beside_m) + switched);
    }

    PlanLine shot_line(const Node& node) const {
      PlanLine line;
      for (double x = 0.0; node.s_m + x <= end_s_m_ + kBeyondEnd_m; x += PlanLine::kSpacing_m) {
        const double s = node.s_m + x;
        const Eigen::Vector2d u = task_.route.direction(s);
        const Eigen::Vector2d beyond = std::max(0.0, s - task_.route.length_m()) * u;
        const double d = task_.lane_m + node.beside_m * std::exp(-x / kShotBlend_m);
        line.points_O.emplace_back(task_.route.at(s) + beyond + d * Eigen::Vector2d(-u.y(), u.x()) - task_.from_O_to_W);
      }
      return line;
    }

    /// To the lane's middle and along it to the end, if that is free.
    void shoot(std::int32_t from) {
      const Node& node = nodes_[static_cast<std::size_t>(from)];
      const double rest_m = std::max(0.0, end_s_m_ - node.s_m);
      const MovingBody body{node.pose, task_.body.speed_m_s, node.steering_rad};
      const DrivenArc arc =
          drive_in_thought(shot_line(node), body, rest_m, clearances_, task_.tracker, task_.blocked, task_.vehicle);
      if (!arc.ends_free) return;
      double cost = node.cost_m + rest_m + p_.near_cost_1_m * arc.closeness_m2;
      for (std::size_t i = 0; i < arc.curvature_1_m.size(); ++i) {
        const double x = static_cast<double>(i + 1) * DrivenArc::kStep_m;
        const double more = static_cast<double>(arc.curvature_1_m[i]) - task_.route.curvature(node.s_m + x);
        cost += DrivenArc::kStep_m * (beside_cost(node.s_m + x, node.beside_m * std::exp(-x / kShotBlend_m)) +
                                      p_.bend_cost_m2 * more * more);
      }
      open_.push({cost, -from - 1});
    }

    const HybridAStarParameters& p_;
    const Clearances clearances_;
    const PlanTask& task_;
    const Beside& last_;
    double end_s_m_, start_clearance_m_ = 0.0;
    std::array<double, 9> kappa_{};
    std::vector<Node> nodes_;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
    std::unordered_map<std::uint64_t, double> best_;
    std::int32_t end_ = 0;
  };

  void remember(const PlanTask& task, LocalPlan& plan) {
    last_.from_s_m = task.s_m;
    last_.offset_m.clear();
    double s = task.s_m;
    for (const Eigen::Vector2d& p : plan.line.points_O) {
      const Eigen::Vector2d p_W = p + task.from_O_to_W;
      s = task.route.project(p_W, s, s + 2.0);
      const double beside = task.route.offset(p_W, s) - task.lane_m;
      while (last_.from_s_m + static_cast<double>(last_.offset_m.size()) <= s) last_.offset_m.push_back(beside);
      if (s >= task.s_m + p_.reach_m) break;
      plan.offset_m = beside;
    }
  }

  HybridAStarParameters p_;
  Beside last_;
};

}  // namespace

std::unique_ptr<LocalPlanner> make_hybrid_a_star(const ModelParameters& own) {
  return std::make_unique<HybridAStar>(own.get<HybridAStarParameters>());
}

void hybrid_a_star_parameters(ModelParameters& section) {
  section.add<HybridAStarParameters>();
}

}  // namespace canyon::mission
