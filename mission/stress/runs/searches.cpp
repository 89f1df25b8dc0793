// The search for a way, made again: of all arcs and shots in the order of what a whole way costs at least.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/mission/autonomy/planning/search/free_ways.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/stress/autonomy_parts.h"
#include "canyon/mission/stress/runs/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::Looks;
using Place = LanePlaces::Place;

/// The search as docs and header say it, with all its numbers in place: horizon 22 m, clearance 0.3 m and 0.1 m more,
/// comfort 0.8 m, costs of 4, 1, 0.6 (half of it beside the last way), 5, 100 and 1000.
class SearchAgain {
 public:
  struct Node {
    MovingBody body;
    Place place{};
    double driven = 0.0, cost = 0.0, untouched = 0.0, aside = 0.0;
    std::size_t from = 0;
    std::vector<Vector2d> points{};
  };

  SearchAgain(const PlanTask& task, std::vector<Place> last)
      : task_(task), last_(std::move(last)), end_m_(task.route.length_m()) {
    Node start;
    start.body = task.body, start.place = place_of(task.body.pose.p_m, task.s_m);
    const double off = std::abs(start.place.beside_m);
    range_ = off <= 3.5                 ? OffsetRange{-3.5, 3.5}
             : start.place.beside_m > 0 ? OffsetRange{worse(-3.5, off - 23.5), off + 3.5}
                                        : OffsetRange{-off - 3.5, -worse(-3.5, off - 23.5)};
    nodes_.push_back(start);
  }

  std::vector<Node> way() {
    const PlanParameters defaults;
    const FreeWays led_by(task_, defaults, range_, [this](const Place& at) { return a_metre(at); });
    std::set<std::pair<double, std::size_t>> open;
    std::map<std::array<long, 3>, double> kept;
    std::size_t best = 0;
    double least = whole(nodes_[0]);
    const auto keep = [&](std::size_t i) {
      const auto [at, anew] = kept.try_emplace(cell(nodes_[i].body.pose), nodes_[i].cost);
      if (!anew && at->second <= nodes_[i].cost) return;
      at->second = nodes_[i].cost;
      open.emplace(nodes_[i].cost + led_by.cost(nodes_[i].place), i);
    };
    const auto ends = [&](Node node) {
      nodes_.push_back(std::move(node));
      const double cost = whole(nodes_.back());
      if (cost < least) least = cost, best = nodes_.size() - 1;
      return missing(nodes_.back()) > 0.0;
    };
    keep(0);
    for (int expanded = 0; expanded < 2500 && !open.empty(); ++expanded) {
      const auto [at_least, i] = *open.begin();
      if (at_least > least - 0.2) break;
      open.erase(open.begin());
      if (kept.at(cell(nodes_[i].body.pose)) < nodes_[i].cost) continue;
      if (expanded % 4 == 0) ends(shot(i, 3.0, 0.0)), ends(shot(i, 6.0, 0.0));
      for (const double share : {0.0, 0.25, -0.25, 0.6, -0.6, 1.0, -1.0}) {
        Node node;
        if (arc(i, share, node) && ends(node)) keep(nodes_.size() - 1);
      }
    }
    const double v = task_.body.speed_m_s, start = nodes_[0].place.beside_m;
    for (int k = -16; k <= 16; ++k) {
      if (missing(nodes_[best]) <= 0.0 || nodes_[best].untouched >= 0.5 * v * v / 3.0) continue;
      Node turned = shot(0, 1.5, start + 0.125 * k);
      turned.aside = start + 0.125 * k - turned.place.beside_m;
      ends(turned);
    }
    std::vector<Node> way{nodes_[best]};
    while (best != 0) best = nodes_[best].from, way.push_back(nodes_[best]);
    std::reverse(way.begin(), way.end());
    return way;
  }

  Vector2d at(double s, double beside) const {
    const Vector2d u = task_.route.direction(s), left(-u.y(), u.x());
    return task_.route.at(s) + (s > end_m_ ? s - end_m_ : 0.0) * u + (task_.lane_m + beside) * left - task_.from_O_to_W;
  }

 private:
  Place place_of(const Vector2d& p_O, double near_m) const {
    const Vector2d p = p_O + task_.from_O_to_W;
    double s = task_.route.project(p, std::min(near_m - 1.5, end_m_), near_m + 3.0);
    if (s >= end_m_) s += worse(0.0, task_.route.direction(end_m_).dot(p - task_.route.at(end_m_)));
    return {s, task_.route.offset(p, s) - task_.lane_m};
  }
  double last_at(double s) const {
    if (last_.empty()) return 0.0;
    for (std::size_t i = 0; i < last_.size(); ++i) {
      if (last_[i].s_m <= s) continue;
      if (i == 0) return last_[0].beside_m;
      const double share = (s - last_[i - 1].s_m) / (last_[i].s_m - last_[i - 1].s_m);
      return last_[i - 1].beside_m + share * (last_[i].beside_m - last_[i - 1].beside_m);
    }
    return last_.back().beside_m;
  }
  double a_metre(const Place& at) const {
    return 0.6 / 22.0 * (std::abs(at.beside_m) + 0.5 * std::abs(at.beside_m - last_at(at.s_m)));
  }
  double missing(const Node& n) const { return worse(0.0, task_.s_m + 22.0 - n.place.s_m); }
  double whole(const Node& n) const {
    const double v = task_.body.speed_m_s, halts_in = 0.5 * v * v / 3.0;
    const double cannot_halt = missing(n) > 0.0 ? worse(0.0, halts_in - n.driven) : 0.0;
    const double touches = missing(n) > 0.0 ? worse(0.0, halts_in - n.untouched) : 0.0;
    return n.cost + 22.0 * a_metre(n.place) + 4.0 * missing(n) + 100.0 * cannot_halt + 1000.0 * touches;
  }
  std::array<long, 3> cell(const PlanPose& pose) const {
    const Vector2d d = pose.p_m - task_.body.pose.p_m;
    const double turned_deg = (pose.yaw_rad - task_.body.pose.yaw_rad) * 180.0 / 3.141592653589793;
    return {std::lround(2.0 * d.x()), std::lround(2.0 * d.y()), std::lround(turned_deg / 10.0)};
  }
  static constexpr double kMustKeep_m = 0.4;  // no way here begins nearer to anything
  void step(Node& n, double kappa, double s) const {
    n.body.pose = n.body.pose.along(kappa, 0.25);
    n.driven += 0.25;
    n.points.push_back(n.body.pose.p_m);
    const double more = kappa - task_.route.curvature(s);
    n.cost += 5.0 * 0.25 * more * more;
  }
  void arrive(Node& n, double driven) const {
    const Place before = n.place;
    n.place = place_of(n.body.pose.p_m, before.s_m);
    n.cost += 0.5 * driven * (a_metre(before) + a_metre(n.place));
  }
  bool arc(std::size_t from, double share, Node& n) const {
    n = nodes_[from], n.from = from, n.points.clear();
    const double angle = share * 0.5585, s = n.place.s_m, speed = worse(1.0, task_.body.speed_m_s);
    const double most = 0.7854 * 0.25 / speed;
    for (int k = 0; k < 6; ++k) {
      const double before = n.body.steering_rad;
      n.body.steering_rad += std::clamp(angle - before, -most, most);
      step(n, std::tan(0.5 * (before + n.body.steering_rad)) / 1.8, s + (k + 0.5) * 0.25);
      const double clear = task_.blocked.clearance_m(n.body.pose, task_.vehicle, 0.8);
      if (clear < kMustKeep_m) return false;
      n.cost += 0.25 * worse(0.0, 0.8 - clear);
    }
    arrive(n, 1.5);
    const double turned = task_.route.direction(n.place.s_m).dot(n.body.pose.forward());
    n.untouched = n.driven;
    const double v = task_.body.speed_m_s, still = 0.5 * v * v / 3.0 - n.driven;
    if (still > 0.0) {
      PlanLine on;
      for (double to = n.place.s_m; to < n.place.s_m + 22.0; to += 0.25)
        on.points_O.push_back(at(to, n.place.beside_m));
      n.untouched += drive_in_thought(on, n.body, still, {.least_m = kMustKeep_m, .comfort_m = 0.8}, task_.tracker,
                                      task_.blocked, task_.vehicle)
                         .untouched_m;
    }
    return n.place.beside_m >= range_.right_m && n.place.beside_m <= range_.left_m &&
           turned >= -std::sin(10.0 * 3.141592653589793 / 180.0);
  }
  Node shot(std::size_t from, double blend_m, double beside) const {
    Node n = nodes_[from];
    n.from = from, n.points.clear();
    PlanLine line;
    for (double s = n.place.s_m; s < task_.s_m + 28.0; s += 0.25)
      line.points_O.push_back(at(s, beside + (n.place.beside_m - beside) * std::exp((n.place.s_m - s) / blend_m)));
    const DrivenArc driven =
        drive_in_thought(line, n.body, missing(n) + 0.25, {.least_m = kMustKeep_m, .comfort_m = 0.8}, task_.tracker,
                         task_.blocked, task_.vehicle);
    n.cost += driven.closeness_m2;
    n.untouched = n.driven + driven.untouched_m;
    const double s = n.place.s_m;
    std::size_t k = 0;
    for (; k < driven.curvature_1_m.size(); ++k) {
      step(n, static_cast<double>(driven.curvature_1_m[k]), s + (static_cast<double>(k) + 0.5) * 0.25);
      if (k % 6 == 5) arrive(n, 1.5);
    }
    if (k % 6 != 0) arrive(n, 0.25 * static_cast<double>(k % 6));
    return n;
  }

  const PlanTask& task_;
  std::vector<Place> last_;
  double end_m_;
  OffsetRange range_{};
  std::vector<Node> nodes_;
};

struct Searched {
  std::vector<Vector2d> route;
  MovingBody body;
  double s_m, lane_m;
  int posts;
  double wall_m = 1e300;  ///< across all of it
};

/// The same way, step by step, and once more a metre on, with the way chosen before: sums of some hundred terms.
StressFigure searched_again(const Searched& given, std::uint64_t seed) {
  Looks looks;
  const RandomStream draws(seed, "stress.searches");
  const KnownVehicle vehicle;
  const ReferenceParameters defaults;
  const auto pursuit = model_row(trackers(), "pure_pursuit").make(defaults.tracker.model.own, vehicle);
  const auto planner = model_row(local_planners(), "hybrid_a_star").make(defaults.planner.model.own);
  const Vector2d to_W(3.0, -7.0);
  std::vector<Vector2d> line, cells;
  for (const Vector2d& p : given.route) line.push_back(p + to_W);
  const Path route(line, 8.0);
  for (int i = 0; i < given.posts; ++i) {
    const Vector2d post(draws.uniform(given.body.pose.p_m.x() + 6.0, 32, 0, static_cast<std::uint64_t>(i)),
                        draws.uniform(-3, 3, 1, static_cast<std::uint64_t>(i)));
    for (double y = -0.4; y <= 0.4; y += 0.2) cells.push_back(post + Vector2d(0.0, y));
  }
  for (double y = -9.0; y <= 9.0 && given.wall_m < 1e300; y += 0.2) cells.emplace_back(given.wall_m, y);
  const BlockedCells blocked({15.0, 0.0}, cells);
  std::vector<Place> last;
  for (const double on : {0.0, 1.0}) {
    MovingBody body = given.body;
    body.pose = body.pose.along(0.0, on);
    const PlanTask task{route, given.s_m + on, to_W, given.lane_m, body, blocked, *pursuit, vehicle};
    const LocalPlan plan = planner->plan(task);
    SearchAgain again(task, last);
    const auto way = again.way();
    std::vector<Vector2d> expected{body.pose.p_m};
    for (std::size_t i = 1; i < way.size(); ++i)
      expected.insert(expected.end(), way[i].points.begin(), way[i].points.end());
    const std::size_t driven = expected.size();
    const Place end = way.back().place;
    const double to_m = worse(end.s_m, task.s_m + 22.0) + 6.0;
    for (double s = end.s_m + 0.25; s < to_m; s += 0.25)
      expected.push_back(again.at(s, end.beside_m + way.back().aside * (1.0 - std::exp((end.s_m - s) / 1.5))));
    looks.right(plan.line.points_O.size() == expected.size() && driven > 1);
    for (std::size_t i = 0; i < std::min(expected.size(), plan.line.points_O.size()); ++i)
      looks.near((plan.line.points_O[i] - expected[i]).norm(), 0.0, 1e-9);
    looks.near(plan.offset_m, end.beside_m, 1e-9);
    looks.right(plan.horizon_m == 22.0);
    const DrivenArc arc = drive_in_thought(plan.line, body, worse(22.0, way.back().driven),
                                           {.least_m = 0.3, .comfort_m = 0.8}, *pursuit, blocked, vehicle);
    looks.right(plan.arc.free_m == arc.free_m && plan.arc.curvature_1_m.size() == arc.curvature_1_m.size());
    last.clear();
    for (const auto& n : way) last.push_back(n.place);
  }
  return looks.figure();
}

/// From a body to a point, beside what a walk along its outline finds, in steps of 1 mm: half a step, and less with the
/// distance. Within the outline it is nothing.
StressFigure distances_of_points() {
  Looks looks;
  const RandomStream draws(6, "stress.distances");
  const KnownVehicle vehicle;
  const double length = vehicle.front_m - vehicle.rear_m, width = 2.0 * vehicle.half_width_m;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const PlanPose body{{draws.uniform(-5, 5, 0, k), draws.uniform(-5, 5, 1, k)}, draws.uniform(-4, 4, 2, k)};
    const Vector2d u = body.forward(), left(-u.y(), u.x());
    const Vector2d p = body.p_m + draws.uniform(-6, 8, 3, k) * u + draws.uniform(-4, 4, 4, k) * left;
    const double ahead = u.dot(p - body.p_m), aside = left.dot(p - body.p_m);
    double nearest = 1e300;
    const auto look = [&](double x, double y) {
      const double d = std::hypot(ahead - x, aside - y);
      if (d < nearest) nearest = d;
    };
    for (double s = 0.0; s <= length; s += 1e-3)
      for (const double side : {-0.5, 0.5}) look(vehicle.rear_m + s, side * width);
    for (double s = 0.0; s <= width; s += 1e-3)
      for (const double end : {vehicle.rear_m, vehicle.front_m}) look(end, s - 0.5 * width);
    const bool within = ahead > vehicle.rear_m && ahead < vehicle.front_m && std::abs(aside) < 0.5 * width;
    looks.near(vehicle.distance_m(body, p), within ? 0.0 : nearest, within ? 1e-15 : 1e-3);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> search_cases() {
  StressRows rows;
  rows.of(autonomy_part());
  const std::vector<Vector2d> straight = {{0, 0}, {60, 0}}, bend = {{0, 0}, {22, 0}, {40, 14}};
  rows.add("searches/past_posts", [=] {
    return searched_again({straight, {{{6.0, 0.3}, 0.05}, 2.5, 0.02}, 6.0, 0.2, 6}, 1);
  });
  rows.add("searches/round_a_bend", [=] {
    return searched_again({bend, {{{9.0, -0.6}, -0.1}, 3.0, -0.05}, 9.0, -0.3, 4}, 2);
  });
  rows.add("searches/before_a_wall", [=] {
    return searched_again({straight, {{{6.0, 0.4}, 0.02}, 6.0, 0.0}, 6.0, 0.1, 2, 17.0}, 3);
  });
  rows.add("searches/too_near_to_halt_before_a_wall", [=] {
    return searched_again({straight, {{{6.0, 0.4}, 0.02}, 6.0, 0.0}, 6.0, 0.1, 2, 13.0}, 3);
  });
  rows.add("searches/far_beside_the_lane", [=] {
    return searched_again({straight, {{{6.0, 5.2}, 0.1}, 2.0, 0.0}, 6.0, -0.4, 3}, 4);
  });
  rows.add("searches/to_the_end_of_the_route", [] {
    return searched_again({{{0, 0}, {20, 0}}, {{{6.0, -0.2}, 0.0}, 2.0, 0.0}, 6.0, 0.0, 3}, 5);
  });
  rows.add("searches/points_beside_a_body", distances_of_points);
  return rows.take();
}

}  // namespace canyon::mission
