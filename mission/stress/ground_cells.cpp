// What an autonomy takes for blocked, cell by cell, and which way the older one chooses, each by an account of its own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/autonomy/local_grid.h"
#include "canyon/mission/autonomy/perception/perception.h"
#include "canyon/mission/autonomy/perception/polar_ground.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/autonomy/reference_2012.h"
#include "canyon/mission/autonomy/route_driver.h"
#include "canyon/mission/stress/autonomy_parts.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using stress::Looks;

/// The documented keys of ground_grid.
constexpr double kCell_m = 0.2, kHalf_m = 30.0, kObstacle_m = 0.3, kClear_m = 2.2, kMemory_s = 2.0, kHidden_m = 1.0;
/// What is so much higher than the lowest beam passes is met.
constexpr double kSurelyMet_m = 0.2;

/// An account of cells that forgets nothing but what it must, in a map without borders.
class AccountOfCells {
 public:
  explicit AccountOfCells(const KnownVehicle& vehicle)
      : vehicle_(vehicle), ground_({.max_slope = 0.12}, 30.0 * std::sqrt(2.0)) {}

  void see(const LidarScan& scan, const Pose& X_OL, const Pose& X_OB, double t_s) {
    std::vector<PlaneReturn> returns;
    const Eigen::Matrix3f R = X_OL.R.toRotationMatrix().cast<float>();
    const Vector3f lever = (X_OL.p - X_OB.p).cast<float>(), up = (X_OB.R * Vector3d::UnitZ()).cast<float>();
    const Vector2d sensor = X_OL.p.head<2>(), body = X_OB.p.head<2>();
    const double height = static_cast<double>(lever.dot(up)),
                 yaw = std::atan2((X_OB.R * Vector3d::UnitX()).y(), (X_OB.R * Vector3d::UnitX()).x());
    for (const LidarPoint& p : scan.points) {
      const Vector3f d = R * Vector3f(p.x, p.y, p.z) + lever;
      const float above = d.dot(up);
      // Three metres more than what it drives under, either way.
      if (above < -3.0f || above > 5.2f || std::abs(d.x()) > 30.0f || std::abs(d.y()) > 30.0f) continue;
      returns.push_back({d.x(), d.y(), above});
      const double across = std::hypot(double{d.x()} - double{lever.x()}, double{d.y()} - double{lever.y()});
      if (across > 1.0) steepest_ = worse(steepest_, (height - double{above}) / across);
    }
    ground_.fit(returns);
    std::map<Key, std::pair<int, int>> counts;  // of things, of the ground
    std::map<Key, double> tops;
    seen.assign(PolarGround::kSectors, 0.0);
    for (const PlaneReturn& r : returns) {
      const float way = std::sqrt(r.x_m * r.x_m + r.y_m * r.y_m);
      const int sector = PolarGround::sector(r.x_m, r.y_m);
      double& far = seen[static_cast<std::size_t>(sector)];
      far = worse(far, double{way});
      const auto ground = ground_.at(sector, way);
      const double above = double{r.above_m} - double{ground.above_m};
      if (above > kClear_m) continue;
      const bool thing = above > kObstacle_m + double{ground.unsure_m};
      if (!thing && above > 0.5 * kObstacle_m) continue;
      const Key key = key_of({body.x() + double{r.x_m}, body.y() + double{r.y_m}});
      auto& [things, bare] = counts[key];
      ++(thing ? things : bare);
      if (thing) tops[key] = worse(tops[key], above);
    }
    const auto lowest_beam = [&](const Key& key) { return height - steepest_ * (middle(key) - sensor).norm(); };
    for (const auto& [key, count] : counts) {
      Cell& cell = cells_[key];
      cell.top = worse(cell.top, tops[key]);
      if (count.first >= 2) {
        if (cell.scans == 0) cell.towards = (sensor - middle(key)).normalized();
        cell.scans = std::min(cell.scans + 1, 20), cell.bare = 0, cell.last_s = t_s, cell.listed = true;
        if (lowest_beam(key) < 0.25) cell.foot = true;
      } else if (count.first == 0 && count.second > 0) {
        cell.ground = true;
        if (cell.scans > 0 && ++cell.bare >= 4) cell.scans = 0;
      }
    }
    const auto under = [&](const Vector2d& p) {
      const Vector2d q = seen_from(p, body, yaw);
      return q.x() > vehicle_.rear_m && q.x() < vehicle_.front_m && std::abs(q.y()) < vehicle_.half_width_m;
    };
    blocked.clear();
    for (auto& [key, cell] : cells_) {
      if (!cell.listed) continue;
      const Vector2d off = (middle(key) - body).cwiseAbs();
      const bool faded = t_s - cell.last_s > kMemory_s && lowest_beam(key) + kSurelyMet_m < cell.top;
      if (cell.scans == 0 || off.x() > kHalf_m || off.y() > kHalf_m || faded || under(middle(key))) {
        cell.scans = 0, cell.top = 0.0, cell.foot = cell.listed = false;
        continue;
      }
    }
    for (const auto& [key, cell] : cells_) {
      if (!cell.listed || cell.scans < 2) continue;
      blocked.push_back(middle(key));
      for (int k = 1; !cell.foot && k * kCell_m <= kHidden_m + 1e-9; ++k) {
        const Vector2d p = middle(key) + k * kCell_m * cell.towards;
        const auto there = cells_.find(key_of(p));
        if ((there != cells_.end() && there->second.ground) || under(p)) break;
        blocked.push_back(p);
        ++hidden;
      }
    }
  }

  std::vector<Vector2d> blocked;
  std::vector<double> seen;  ///< by sector
  int hidden = 0;

 private:
  using Key = std::pair<long, long>;
  struct Cell {
    int scans = 0, bare = 0;
    bool ground = false, foot = false, listed = false;
    double top = 0.0, last_s = 0.0;
    Vector2d towards{0, 0};
  };
  static Key key_of(const Vector2d& p) {
    return {std::lround(std::floor(p.x() / kCell_m)), std::lround(std::floor(p.y() / kCell_m))};
  }
  static Vector2d middle(const Key& key) {
    return kCell_m * Vector2d(static_cast<double>(key.first) + 0.5, static_cast<double>(key.second) + 0.5);
  }

  KnownVehicle vehicle_;
  PolarGround ground_;
  std::map<Key, Cell> cells_;
  double steepest_ = 0.0;
};

/// Scans of a sloping street with things of every kind on it: whole ones, some seen only above, some of a single
/// return, under what one drives through, too low to count, taken away after a while, or hidden from some scan on; from
/// a vehicle that drives, waits and is then somewhere else. Blocked is what an account without borders has, scan by
/// scan. All returns lie off the borders of cells and limits, so that a rounding decides nothing.
StressFigure cells_by_account(double yaw_rad, double slope) {
  Looks looks;
  const KnownVehicle vehicle;
  const auto perception =
      model_row(perceptions(), "ground_grid").make(ReferenceParameters{}.perception.model.own, vehicle);
  AccountOfCells account(vehicle);
  const KeptReturns keeps = perception->keeps();
  looks.near(keeps.low_m, -3.0, 1e-12), looks.near(keeps.high_m, kClear_m + 3.0, 1e-12);
  looks.near(keeps.half_size_m, kHalf_m + 2.0 * kCell_m, 1e-12), looks.right(keeps.enough == 100);
  const RandomStream draws(31, "stress.cells");
  struct Thing {
    Vector2d at;
    double low_m, high_m;
    int returns, from, to;  // scans that show it
    bool bare_after;
  };
  std::vector<Thing> things;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const double way = k < 20 ? draws.uniform(2.6, 4.4, 0, k) : draws.uniform(4.0, 19.0, 1, k);
    const double turn = draws.uniform(-kPi, kPi, 2, k);
    const int kind = static_cast<int>(k % 6);
    Thing t{Vector2d(way * std::cos(turn), way * std::sin(turn)), 0.4, 1.6, 5, 0, 99, false};
    if (kind == 1) t.low_m = 0.9;
    if (kind == 2) t.returns = 1;
    if (kind == 3) t.low_m = 2.4, t.high_m = 4.5;
    if (kind == 4) t.to = 3 + static_cast<int>(k % 5), t.bare_after = k % 2 == 0;
    if (kind == 5) t.from = 2, t.low_m = 0.2, t.high_m = k % 4 == 1 ? 0.26 : 1.0;
    // Near by only what the lowest beam passes over.
    if (k < 20) t = {t.at, k % 3 == 0 ? 0.8 : 1.0, 1.6, 5, kind == 5 ? 2 : 0, kind == 4 ? 6 : 99, false};
    things.push_back(t);
  }
  std::size_t most = 0;
  double t_s = 5.0;
  for (int scan = 0; scan < 16; ++scan) {
    const double away = scan < 13 ? 0.25 * scan : 300.0 + 0.25 * scan;
    t_s += scan == 9 ? 2.6 : 0.1;
    const double heading = yaw_rad + 0.01 * scan;
    const Vector2d at = away * Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
    const Pose X_OB{rotation_from({.yaw_rad = heading, .pitch_rad = 0.015, .roll_rad = -0.01}), {at.x(), at.y(), 7.0}};
    const Pose X_OL = X_OB * Pose{rotation_from({.yaw_rad = 0.3, .pitch_rad = 0.02, .roll_rad = 0.0}), {0.4, 0.1, 1.9}};
    const Vector3d up = X_OB.R * Vector3d::UnitZ();
    LidarScan cloud{.t = GpsTime{0}, .period_s = 0.1, .points = {}};
    // A height over B's plane at a place of a cell, near its middle.
    const auto add = [&](const Vector2d& p, double above_m, std::uint64_t n) {
      const Vector2d cell = kCell_m * (p / kCell_m).array().floor().matrix() + Vector2d::Constant(0.5 * kCell_m) +
                            Vector2d(draws.uniform(-0.06, 0.06, 5, n), draws.uniform(-0.06, 0.06, 6, n));
      const Vector2d off = cell - at;
      const double z = (above_m - up.head<2>().dot(off)) / up.z();
      const Vector3d q = X_OL.inverse() * Vector3d(cell.x(), cell.y(), 7.0 + z);
      LidarPoint point;
      point.x = static_cast<float>(q.x()), point.y = static_cast<float>(q.y()), point.z = static_cast<float>(q.z());
      cloud.points.push_back(point);
    };
    std::set<std::pair<long, long>> taken;
    const auto base = [&](const Vector2d& p) { return slope * (p - at).x(); };
    std::uint64_t n = 100000 * static_cast<std::uint64_t>(scan);
    for (const Thing& t : things) {
      taken.emplace(std::lround(std::floor(t.at.x() / kCell_m)), std::lround(std::floor(t.at.y() / kCell_m)));
      if (scan >= t.from && scan <= t.to) {
        for (int k = 0; k < t.returns; ++k)
          add(t.at, base(t.at) + t.low_m + (t.high_m - t.low_m) * k / (t.returns > 1 ? t.returns - 1.0 : 1.0), ++n);
        // One that is seen whole has its foot there too.
        if (t.low_m < 0.5 && t.high_m > 1.5) add(t.at, base(t.at) + 0.03, ++n);
      } else if (t.bare_after || scan < t.from) {
        add(t.at, base(t.at), ++n), add(t.at, base(t.at) + 0.02, ++n);
      }
    }
    for (double x = -21.9; x < 22.0; x += 0.6)
      for (double y = -21.9; y < 22.0; y += 0.6) {
        const Vector2d p = at + Vector2d(x, y);
        const double way = std::hypot(x, y);
        if (way < 4.6 || way > 21.5) continue;
        if (taken.count({std::lround(std::floor(p.x() / kCell_m)), std::lround(std::floor(p.y() / kCell_m))}) > 0)
          continue;
        add(p, base(p), ++n);
      }
    // Beyond what it keeps.
    add(at + Vector2d(35.0, 3.0), 0.5, ++n), add(at + Vector2d(35.0, 3.0), 0.8, ++n);
    add(at + Vector2d(8.0, 8.0), 6.0, ++n), add(at + Vector2d(8.0, 8.0), -3.5, ++n);
    looks.right(perception->see(cloud, X_OL, X_OB, t_s));
    account.see(cloud, X_OL, X_OB, t_s);
    std::vector<Vector2d> found = perception->blocked().all(), expected = account.blocked;
    const auto before = [](const Vector2d& a, const Vector2d& b) {
      return std::abs(a.x() - b.x()) > 1e-6 ? a.x() < b.x() : a.y() < b.y();
    };
    std::sort(found.begin(), found.end(), before), std::sort(expected.begin(), expected.end(), before);
    looks.right(found.size() == expected.size());
    // A direction kept in single precision, over a metre.
    for (std::size_t k = 0; k < found.size() && k < expected.size(); ++k)
      looks.near((found[k] - expected[k]).norm(), 0.0, 4.0 * stress::kHalfUlp);
    most = worse(most, found.size());
    for (int k = 0; k < 48; ++k) {
      const Vector2d d(std::cos(0.13 * k), std::sin(0.13 * k));
      const int sector = PolarGround::sector(static_cast<float>(d.x()), static_cast<float>(d.y()));
      looks.near(perception->seen_m(d), account.seen[static_cast<std::size_t>(sector)], 8.0 * stress::kHalfUlp * 30.0);
    }
    // As good as none.
    cloud.points.resize(99);
    looks.right(!perception->see(cloud, X_OL, X_OB, t_s));
  }
  looks.right(most > 25 && account.hidden > 20);
  return looks.figure();
}

/// The older autonomy among things strewn over a street that bends: of all ways beside the middle line, half a metre
/// apart, the one of least cost, laid out and looked up here point by point; what is then steered for, and how fast.
/// The way is the same sums; a curvature of 1 / m at most to 16 eps, and a root of a few metres to 64.
StressFigure choice_of_2012(std::uint64_t seed) {
  Looks looks;
  const RandomStream draws(seed, "stress.older");
  AutonomyConfig config;
  config.model.name = "reference_2012";
  config.waypoints = {{"end", {60.0, 25.0}, ""}};
  PriorKnowledge prior;
  prior.route = Path({{0.0, 0.0}, {35.0, 0.0}, {60.0, 25.0}}, 8.0);
  prior.waypoint_s_m = {prior.route.length_m()};
  const GpsTime start = GpsTime::from_week_sow(1600, 50.0);
  const auto autonomy = make_autonomy(config, prior, start);
  const Reference2012Parameters own;
  looks.right(autonomy->keeps().has_value());
  if (const auto keeps = autonomy->keeps()) {
    looks.near(keeps->low_m, own.grid.min_depth_m, 1e-12), looks.right(keeps->enough == 100);
    looks.near(keeps->high_m, own.grid.max_obstacle_height_m, 1e-12);
    looks.near(keeps->half_size_m, own.grid.half_size_m + 2.0 * own.grid.cell_m, 1e-12);
  }
  RouteDriver driver(config, prior);
  LocalGrid grid(own.grid);
  struct Way {
    double s = 0.0, from = 0.0, to = 0.0, blend = 6.0;
  } chosen;
  const auto on = [&](const Way& w, double s) {
    const double u = std::min(worse((s - w.s) / w.blend, 0.0), 1.0);
    const Vector2d d = prior.route.direction(s);
    return Vector2d(prior.route.at(s) +
                    (w.from + (w.to - w.from) * (3.0 * u * u - 2.0 * u * u * u)) * Vector2d(-d.y(), d.x()));
  };
  double free_m = 0.0, free_from = 0.0;
  int aside = 0, halted = 0, slowed = 0;
  for (int step = 0; step < 40; ++step) {
    const double s = 1.1 * step;
    const Vector2d u = prior.route.direction(s), left(-u.y(), u.x());
    const double off = 0.6 * std::sin(0.4 * step),
                 speed = 1.0 + 4.0 * draws.uniform(0, static_cast<std::uint64_t>(step));
    NavEstimate e;
    e.t = start + 0.1 * step;
    const Vector2d p = prior.route.at(s) + off * left;
    e.X_WB = {rotation_from({.yaw_rad = std::atan2(u.y(), u.x()), .pitch_rad = 0.0, .roll_rad = 0.0}),
              {p.x(), p.y(), 1.0}};
    e.v_WB_W = {speed * u.x(), speed * u.y(), 0.0};
    // Some posts ahead, each a cell's column of returns, and level returns for the rest.
    std::vector<Vector3f> points;
    LidarScan scan{.t = e.t, .period_s = 0.1, .points = {}};
    const Pose X_WL{e.X_WB.R, e.X_WB.p + Vector3d(0, 0, 1.8)};
    const auto add = [&](const Vector2d& q, double z) {
      const Vector3d in_L = X_WL.inverse() * Vector3d(q.x(), q.y(), z);
      LidarPoint point;
      point.x = static_cast<float>(in_L.x()), point.y = static_cast<float>(in_L.y());
      point.z = static_cast<float>(in_L.z());
      scan.points.push_back(point), points.emplace_back(point.x, point.y, point.z);
    };
    for (int k = 0; k < 120; ++k) add(p + (2.0 + 0.15 * k) * u, 1.0);
    for (std::uint64_t k = 0; k < 3; ++k) {
      const auto n = 10 * static_cast<std::uint64_t>(step) + k;
      if (draws.uniform(1, n) < 0.6) continue;
      const double along = s + draws.uniform(4.0, 16.0, 2, n), across = draws.uniform(-4.0, 4.0, 3, n);
      const Vector2d d = prior.route.direction(along);
      for (int z = 0; z < 4; ++z) add(prior.route.at(along) + across * Vector2d(-d.y(), d.x()), 1.1 + 0.3 * z);
    }
    // A wall across everything, now and then, near or far.
    for (double y = -6.0; step % 13 == 12 && y < 6.0; y += 0.2)
      for (int z = 0; z < 4; ++z) add(p + (step % 2 == 0 ? 9.0 : 3.1) * u + y * left, 1.1 + 0.3 * z);
    const DriveCommand before = autonomy->drive(e);
    driver.update(e);
    looks.right(step > 0 || before.speed_m_s == 0.0);
    autonomy->see(scan, X_WL, e);
    grid.add(points, X_WL, e.X_WB, e.t - start), grid.update_distances();
    double least = stress::kInfinity;
    Way best = chosen;
    for (int k = -7; k <= 7; ++k) {
      const Way w{driver.s_m(), prior.route.offset(p, driver.s_m()), 0.5 * k, 1.6 * speed > 5.0 ? 1.6 * speed : 5.0};
      double open = 18.0, close = 0.0;
      for (int i = 0; i <= 36; ++i) {
        const double d = grid.distance_m(on(w, driver.s_m() + 0.5 * i));
        if (d < 1.0) {
          open = 0.5 * i;
          break;
        }
        close += d < 2.0 ? 0.5 * (2.0 - d) : 0.0;
      }
      const double cost = 4.0 * (18.0 - open) + close + 0.6 * std::abs(w.to) + 0.8 * std::abs(w.to - chosen.to);
      if (cost < least) least = cost, best = w, free_m = open, free_from = driver.s_m();
    }
    chosen = best;
    aside += chosen.to != 0.0 ? 1 : 0;
    const DriveCommand command = autonomy->drive(e);
    driver.update(e);
    looks.near(command.curvature_1_m, driver.pursue(e, on(chosen, driver.target_s_m(speed))), 16.0 * stress::kEpsilon);
    const double left_m = free_m - (driver.s_m() - free_from);
    double v = driver.allowed_speed_m_s();
    if (free_m < 18.0) v = left_m < 3.3 ? 0.0 : std::min(v, std::sqrt(2.0 * config.braking_m_s2 * (left_m - 3.0)));
    looks.near(command.speed_m_s, v, 64.0 * stress::kEpsilon);
    looks.right(autonomy->state() == (v > 0.0 ? AutonomyState::kDriving : AutonomyState::kBlocked));
    halted += v == 0.0 ? 1 : 0, slowed += v > 0.0 && free_m < 18.0 ? 1 : 0;
    // Half a second without a scan of a hundred returns is too long; what it did not take in changes nothing.
    if (step % 10 != 9) continue;
    NavEstimate later = e;
    later.t = e.t + 0.49;
    looks.right(autonomy->drive(later).speed_m_s == command.speed_m_s);
    driver.update(later);
    later.t = e.t + 0.51;
    LidarScan few = scan;
    few.t = later.t, few.points.resize(99);
    autonomy->see(few, X_WL, later);
    looks.right(autonomy->drive(later).speed_m_s == 0.0 && autonomy->state() == AutonomyState::kBlind);
    driver.update(later);
  }
  looks.right(aside > 3 && halted > 0 && slowed > 2);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> ground_cell_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "what blocks an autonomy's way, scan by scan",
           .why = "a count of scans, a memory or a limit of another size; a cell that keeps what stood in another",
           .expected = "an account of every cell, and of every way, without borders: roundings",
           .unit = "of the bound"});
  for (const double yaw : {0.0, 2.3})
    for (const double slope : {0.0, 0.04})
      rows.add("perception/cells_by_account_at_" + stress::text(yaw) + "_on_a_slope_of_" + stress::text(slope),
               [=] { return cells_by_account(yaw, slope); });
  for (const std::uint64_t seed : {1U, 2U, 3U})
    rows.add("autonomy/choice_of_2012_" + std::to_string(seed), [seed] { return choice_of_2012(seed); });
  return rows.take();
}

}  // namespace canyon::mission
