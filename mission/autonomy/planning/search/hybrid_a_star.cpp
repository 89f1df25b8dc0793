#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

#include "canyon/mission/autonomy/planning/search/free_ways.h"

namespace canyon::mission {
namespace {

constexpr int kSteps = 6;  // of DrivenArc::kStep_m, in an arc: 1.5 m, longer than a cell's diagonal
constexpr double kArc_m = kSteps * DrivenArc::kStep_m;
/// What is steered for on an arc, as shares of the most.
constexpr std::array<double, 7> kSteered{0.0, 0.25, -0.25, 0.6, -0.6, 1.0, -1.0};
/// Ways on from a node to the lane, within which what is left to it falls to 1/e; tried from one in so many nodes.
constexpr std::array<double, 2> kShotBlend_m{3.0, 6.0};
constexpr std::size_t kShotEvery = 4;
/// Ways aside, tried from the start where whatever else there is touches something before it is halted on.
constexpr double kAside_m = 2.0, kAsideStep_m = 0.125, kAsideBlend_m = 1.5;
constexpr double kWorthSearching = 0.2;  // that a way may be cheaper than the best so far
constexpr double kPlaces_m = 0.5, kHeadings_rad = std::numbers::pi / 18.0;  // a cell of the search
constexpr double kMostTurned_rad = 100.0 / 180.0 * std::numbers::pi;        // from the route
constexpr double kMargin_m = 0.1;            // more clearance: the tracker drives what is found a little otherwise
constexpr std::size_t kMostExpanded = 2500;  // then the best so far is taken

/// Where an arc or a shot ends, or the search starts.
struct SearchNode {
  MovingBody body;
  LanePlaces::Place place;
  double driven_m = 0.0, cost = 0.0;      ///< since the start
  double untouched_m = 0.0;               ///< that may be driven on the same way, DrivenArc's
  double aside_m = 0.0;                   ///< so much further to the left the way still goes
  std::size_t from = 0;                   ///< node
  std::vector<Eigen::Vector2d> points_O;  ///< at every step since `from`
};

/// One search for the cheapest way of a task.
class WaySearch {
 public:
  WaySearch(const PlanTask& task, const PlanParameters& p, const Clearances& clearances,
            const std::vector<LanePlaces::Place>& last)
      : task_(task),
        p_(p),
        lane_(task),
        last_(last),
        room_(task.body.pose, {clearances.least_m + kMargin_m, clearances.comfort_m}, task.blocked, task.vehicle),
        speed_m_s_(std::max(kSlowestSteered_m_s, task.body.speed_m_s)),
        halting_m_(halting_way_m(task.body, task.vehicle)),
        start_(place_of(task.body.pose.p_m, task.s_m)),
        range_(offset_range(p, start_.beside_m)),
        free_ways_(task, p, range_, [&](const LanePlaces::Place& at) { return cost_1_m(at); }) {}

  /// Its nodes, from the start on.
  std::vector<SearchNode> cheapest() {
    nodes_ = {{.body = task_.body, .place = start_, .points_O = {}}};
    best_cost_ = cost_of_ending(nodes_[0]);
    keep(0);
    for (std::size_t expanded = 0; expanded < kMostExpanded && !open_.empty(); ++expanded) {
      const auto [at_least, from] = open_.top();
      if (at_least > best_cost_ - kWorthSearching) break;
      open_.pop();
      if (cheapest_.at(cell(nodes_[from].body.pose)) < nodes_[from].cost) continue;
      for (std::size_t k = 0; k < kShotBlend_m.size() && expanded % kShotEvery == 0; ++k)
        end(shot(from, kShotBlend_m[k], 0.0));
      for (const double steered : kSteered)
        if (auto node = arc(from, steered); node && end(*std::move(node))) keep(nodes_.size() - 1);
    }
    const auto touches = [&] { return missing_m(nodes_[best_]) > 0.0 && nodes_[best_].untouched_m < halting_m_; };
    for (double aside = -kAside_m; aside <= kAside_m && touches(); aside += kAsideStep_m) end(aside_by(aside));
    std::size_t best = best_;
    std::vector<SearchNode> way{nodes_[best]};
    for (; best != 0; best = nodes_[best].from) way.push_back(nodes_[nodes_[best].from]);
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  using Open = std::pair<double, std::size_t>;  // what a whole way costs at least, node; of equals the first one made

  /// Arcs inside of a bend come forward by more than their length.
  LanePlaces::Place place_of(const Eigen::Vector2d& p_O, double near_m) const {
    return lane_.of(p_O, near_m - kArc_m, near_m + 2.0 * kArc_m);
  }

  double cost_1_m(const LanePlaces::Place& at) const {
    return p_.offset_cost_1_m / p_.horizon_m *
           (std::abs(at.beside_m) + p_.change_share * std::abs(at.beside_m - last_beside_m(at.s_m)));
  }

  double last_beside_m(double s_m) const {
    if (last_.empty()) return 0.0;
    const auto after = std::find_if(last_.begin(), last_.end(), [&](const auto& at) { return at.s_m > s_m; });
    if (after == last_.begin()) return last_.front().beside_m;
    if (after == last_.end()) return last_.back().beside_m;
    const auto before = after - 1;
    const double share = (s_m - before->s_m) / (after->s_m - before->s_m);
    return before->beside_m + share * (after->beside_m - before->beside_m);
  }

  double missing_m(const SearchNode& n) const { return std::max(0.0, task_.s_m + p_.horizon_m - n.place.s_m); }

  double cost_of_ending(const SearchNode& n) const {
    const double missing = missing_m(n);
    const double crash = missing > 0.0 ? crash_cost(halting_m_, n.driven_m, n.untouched_m) : 0.0;
    return n.cost + p_.horizon_m * cost_1_m(n.place) + p_.blocked_cost_1_m * missing + crash;
  }

  std::uint64_t cell(const PlanPose& pose) const {
    constexpr std::int64_t kMiddle = 1 << 20;
    const Eigen::Vector2d d = pose.p_m - task_.body.pose.p_m;
    const auto x = static_cast<std::uint64_t>(std::llround(d.x() / kPlaces_m) + kMiddle);
    const auto y = static_cast<std::uint64_t>(std::llround(d.y() / kPlaces_m) + kMiddle);
    const auto turned =
        static_cast<std::uint64_t>(std::llround((pose.yaw_rad - task_.body.pose.yaw_rad) / kHeadings_rad) + kMiddle);
    return (x << 42U) | (y << 21U) | turned;
  }

  /// A way that ends there; whether it may go on.
  bool end(SearchNode node) {
    const double its_cost = cost_of_ending(node);
    nodes_.push_back(std::move(node));
    if (its_cost < best_cost_) {
      best_cost_ = its_cost;
      best_ = nodes_.size() - 1;
    }
    return missing_m(nodes_.back()) > 0.0;
  }

  /// A node to go on from, if none in its cell is as cheap.
  void keep(std::size_t index) {
    const SearchNode& n = nodes_[index];
    const auto [at, is_new] = cheapest_.try_emplace(cell(n.body.pose), n.cost);
    if (!is_new && at->second <= n.cost) return;
    at->second = n.cost;
    open_.emplace(n.cost + free_ways_.cost(n.place), index);
  }

  /// Driven on from a node; none where it comes too near to something, or leaves where ways are looked for.
  std::optional<SearchNode> arc(std::size_t from, double steered) const {
    SearchNode n = begun(from);
    const double wanted_1_m = std::tan(steered * task_.vehicle.max_steering_rad) / task_.vehicle.wheelbase_m;
    const double dt_s = DrivenArc::kStep_m / speed_m_s_, from_m = n.place.s_m;
    for (int k = 0; k < kSteps; ++k) {
      const double steering = n.body.steering_rad;
      n.body.steering_rad = steered_rad(steering, wanted_1_m, dt_s, task_.vehicle);
      step(n, std::tan(0.5 * (steering + n.body.steering_rad)) / task_.vehicle.wheelbase_m,
           from_m + (k + 0.5) * DrivenArc::kStep_m);
      const double clearance = room_.clearance_m(n.body.pose);
      if (!room_.allows(n.body.pose, clearance, n.driven_m)) return std::nullopt;
      n.cost += p_.closeness_cost_1_m2 * DrivenArc::kStep_m * std::max(0.0, room_.clearances().comfort_m - clearance);
    }
    arrive(n, kArc_m);
    if (n.place.beside_m < range_.right_m || n.place.beside_m > range_.left_m) return std::nullopt;
    const Eigen::Vector2d u = task_.route.direction(n.place.s_m), forward = n.body.pose.forward();
    if (u.dot(forward) < std::cos(kMostTurned_rad)) return std::nullopt;
    n.untouched_m = untouched_m(n);
    return n;
  }

  /// Driven by the tracker to so far beside the lane and along there, as far as that is free.
  SearchNode shot(std::size_t from, double blend_m, double beside_m) const {
    SearchNode n = begun(from);
    PlanLine line;
    const double to_m = task_.s_m + p_.horizon_m + kBeyondHorizon_m;
    for (double s = n.place.s_m; s < to_m; s += PlanLine::kSpacing_m)
      line.points_O.push_back(
          lane_.at({s, beside_m + (n.place.beside_m - beside_m) * std::exp((n.place.s_m - s) / blend_m)}));
    const DrivenArc driven =
        drive_in_thought(line, n.body, missing_m(n) + DrivenArc::kStep_m, task_.tracker, room_, n.driven_m);
    n.cost += p_.closeness_cost_1_m2 * driven.closeness_m2;
    n.untouched_m = n.driven_m + driven.untouched_m;
    const double from_m = n.place.s_m;
    int since = 0;
    for (std::size_t k = 0; k < driven.curvature_1_m.size(); ++k) {
      step(n, static_cast<double>(driven.curvature_1_m[k]),
           from_m + (static_cast<double>(k) + 0.5) * DrivenArc::kStep_m);
      if (++since == kSteps) arrive(n, kArc_m), since = 0;
    }
    if (since > 0) arrive(n, since * DrivenArc::kStep_m);
    return n;
  }

  SearchNode aside_by(double aside_m) const {
    SearchNode n = shot(0, kAsideBlend_m, start_.beside_m + aside_m);
    n.aside_m = start_.beside_m + aside_m - n.place.beside_m;
    return n;
  }

  SearchNode begun(std::size_t from) const {
    SearchNode n = nodes_[from];
    n.from = from;
    n.points_O.clear();
    return n;
  }

  /// On beside the lane as there, over what it still takes to halt.
  double untouched_m(const SearchNode& n) const {
    if (n.driven_m >= halting_m_) return n.driven_m;
    PlanLine line;
    for (double s = n.place.s_m; s < n.place.s_m + p_.horizon_m; s += PlanLine::kSpacing_m)
      line.points_O.push_back(lane_.at({s, n.place.beside_m}));
    return n.driven_m +
           drive_in_thought(line, n.body, halting_m_ - n.driven_m, task_.tracker, room_, n.driven_m).untouched_m;
  }

  void step(SearchNode& n, double curvature_1_m, double s_m) const {
    n.body.pose = n.body.pose.along(curvature_1_m, DrivenArc::kStep_m);
    n.driven_m += DrivenArc::kStep_m;
    n.points_O.push_back(n.body.pose.p_m);
    const double more = curvature_1_m - task_.route.curvature(s_m);
    n.cost += p_.turning_cost_m * DrivenArc::kStep_m * more * more;
  }

  void arrive(SearchNode& n, double driven_m) const {
    const LanePlaces::Place before = n.place;
    n.place = place_of(n.body.pose.p_m, before.s_m);
    n.cost += 0.5 * driven_m * (cost_1_m(before) + cost_1_m(n.place));
  }

  const PlanTask& task_;
  const PlanParameters& p_;
  LanePlaces lane_;
  const std::vector<LanePlaces::Place>& last_;
  Room room_;
  double speed_m_s_, halting_m_;
  LanePlaces::Place start_;
  OffsetRange range_;
  FreeWays free_ways_;
  std::vector<SearchNode> nodes_;
  std::size_t best_ = 0;  ///< node at the end of the cheapest way so far
  double best_cost_ = 0.0;
  std::unordered_map<std::uint64_t, double> cheapest_;  ///< cost of the cheapest node of each cell
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

/// Hybrid A* (Dolgov, Thrun, Montemerlo & Diebel 2010) along a route: arcs of a body with its limits of steering angle
/// and rate, one after another, of which each cell of place and heading keeps the cheapest, at the very pose that was
/// driven to. It is led by the cheapest way of a point that may turn on the spot, and now and then the tracker is
/// let drive the rest of a way along the lane. A way may end anywhere, and pays for what is missing to the horizon.
/// Their second stage, smoothing, is left to the tracker, and driving backwards to the recovery.
class HybridAStar final : public LocalPlanner {
 public:
  explicit HybridAStar(const PlanParameters& p) : p_(p) {}

  Clearances clearances() const override {
    return {.least_m = p_.clearance_m, .comfort_m = std::max(p_.clearance_m, p_.comfort_clearance_m)};
  }

  LocalPlan plan(const PlanTask& task) override {
    const std::vector<SearchNode> way = WaySearch(task, p_, clearances(), last_).cheapest();
    const SearchNode& end = way.back();
    LocalPlan plan{.line = line(task, way), .arc = {}, .offset_m = end.place.beside_m, .horizon_m = p_.horizon_m};
    plan.arc = drive_in_thought(plan.line, task.body, std::max(p_.horizon_m, end.driven_m), clearances(), task.tracker,
                                task.blocked, task.vehicle);
    last_.clear();
    for (const SearchNode& n : way) last_.push_back(n.place);
    return plan;
  }

 private:
  /// All that was driven, then on beside the lane, for the tracker to look at.
  PlanLine line(const PlanTask& task, const std::vector<SearchNode>& way) const {
    PlanLine out;
    out.points_O.push_back(way.front().body.pose.p_m);
    for (std::size_t i = 1; i < way.size(); ++i)
      out.points_O.insert(out.points_O.end(), way[i].points_O.begin(), way[i].points_O.end());
    const LanePlaces lane(task);
    const LanePlaces::Place end = way.back().place;
    const double to_m = std::max(end.s_m, task.s_m + p_.horizon_m) + kBeyondHorizon_m;
    for (double s = end.s_m + PlanLine::kSpacing_m; s < to_m; s += PlanLine::kSpacing_m)
      out.points_O.push_back(
          lane.at({s, end.beside_m + way.back().aside_m * (1.0 - std::exp((end.s_m - s) / kAsideBlend_m))}));
    return out;
  }

  PlanParameters p_;
  std::vector<LanePlaces::Place> last_;
};

}  // namespace

std::unique_ptr<LocalPlanner> make_hybrid_a_star(const ModelParameters& own) {
  return std::make_unique<HybridAStar>(own.get<PlanParameters>());
}

}  // namespace canyon::mission
