#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "canyon/core/process/parallel_keep.h"
#include "canyon/mission/autonomy/perception/perception.h"
#include "canyon/mission/autonomy/perception/polar_ground.h"

namespace canyon::mission {
namespace {

struct GroundGridParameters {
  double cell_m = 0.2;
  double half_size_m = 30.0;
  double obstacle_step_m = 0.3;
  double clear_height_m = 2.2;
  double max_slope = 0.12;
  std::int64_t min_hits = 2;
  std::int64_t persistence_scans = 2;
  double memory_s = 2.0;
  double hidden_m = 1.0;
};
void visit(FieldVisitor& f, GroundGridParameters& c) {
  f.number("cell_m", c.cell_m, {0.1, 1.0}, "ground_grid: edge of a cell");
  f.number("half_size_m", c.half_size_m, {10, 60},
           "ground_grid: how far it reaches to every side; what lies farther off counts as free");
  f.number("obstacle_step_m", c.obstacle_step_m, {0.05, 2},
           "ground_grid: a return so far above the ground is of an obstacle");
  f.number("clear_height_m", c.clear_height_m, {0.5, 10}, "ground_grid: what is higher is driven under");
  f.number("max_slope", c.max_slope, {0.01, 1}, "ground_grid: rise over way of a street, against the vehicle's plane");
  f.integer("min_hits", c.min_hits, {1, 1000}, "ground_grid: returns of one scan in a cell before they count");
  f.integer("persistence_scans", c.persistence_scans, {1, 20},
            "ground_grid: so many scans must show a thing in a cell before it blocks");
  f.number("memory_s", c.memory_s, {0.2, 600},
           "ground_grid: what could be seen and was not for this long is forgotten; what the lowest beam may pass over "
           "stays");
  f.number("hidden_m", c.hidden_m, {0, 5},
           "ground_grid: by how much a thing seen only over the lowest beam may reach nearer unseen, as a car's boot "
           "before its cabin");
}

constexpr std::size_t kGridChunk = 4096;  // returns
constexpr int kEnough = 100;              // returns of a scan; fewer count as none
constexpr double kFarthest_m = 1e7;       // an estimate beyond it has no cell: their numbers are of 32 bits
constexpr double kRoom_m = 3.0;           // of the ground below and above the vehicle's plane within the grid
constexpr int kMostEvidence = 20;         // scans
constexpr int kBareScans = 4;             // of bare ground, one after the other, until a cell is free
constexpr double kFoot_m = 0.25;          // a beam so near to the ground shows a thing's foot
// The lowest beam surely meets only what stands so much above where it passes by the vehicle's own plane. ASSUMPTION:
// 0.2 m, by which a street tilted by 4 degrees against that plane differs from it 3 m off; it does not grow with the
// distance, since farther off the ground itself is seen.
constexpr double kMet_m = 0.2;

/// A rolling grid in the local frame. Heights are never kept: each scan is judged by itself, against its own ground.
class GroundGrid final : public Perception {
 public:
  GroundGrid(const GroundGridParameters& p, const KnownVehicle& vehicle)
      : p_(p),
        vehicle_(vehicle),
        n_(2 * static_cast<int>(std::ceil(p.half_size_m / p.cell_m)) + 2),
        ground_({.max_slope = p.max_slope}, std::sqrt(2.0) * p.half_size_m),
        cells_(static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_)) {
    seen_m_.fill(0.0F);
  }

  KeptReturns keeps() const override {
    return {.low_m = -kRoom_m,
            .high_m = p_.clear_height_m + kRoom_m,
            .half_size_m = p_.half_size_m + 2.0 * p_.cell_m,
            .enough = kEnough};
  }

  bool see(const LidarScan& scan, const Pose& X_OL, const Pose& X_OB, double t_s) override {
    if (static_cast<int>(scan.points.size()) < kEnough) return false;
    if (!(X_OB.p.head<2>().cwiseAbs().maxCoeff() < kFarthest_m)) return false;
    ++scan_;
    t_s_ = t_s;
    gather(scan, X_OL, X_OB);
    ground_.fit(returns_);
    sort_into_cells(X_OB.p.head<2>());
    judge();
    forget(X_OB);
    list(X_OB);
    return true;
  }

  const BlockedCells& blocked() const override { return blocked_; }
  double seen_m(const Eigen::Vector2d& d) const override {
    const int s = PolarGround::sector(static_cast<float>(d.x()), static_cast<float>(d.y()));
    return static_cast<double>(seen_m_[static_cast<std::size_t>(s)]);
  }

 private:
  struct Cell {
    std::int32_t x = std::numeric_limits<std::int32_t>::min(), y = 0;  ///< whose storage it is
    std::uint32_t scan = 0;                                            ///< that the counts are of
    std::uint16_t hits = 0, ground = 0;
    std::int8_t evidence = 0, bare = 0;  ///< bare: scans since that showed its ground alone
    bool listed = false, ground_seen = false, foot_seen = false;
    float top_m = 0.0F;  ///< highest return above the ground
    double last_s = 0.0;
    Eigen::Vector2f to_sensor{0, 0};  ///< unit, when first seen
  };

  /// What a return says of a cell.
  struct Told {
    std::int32_t x, y;
    std::uint32_t slot;
    float above_m;  ///< the ground; kGround: it is the ground's
  };
  static constexpr float kGround = -1.0F;
  static constexpr std::size_t kAhead = 16;  // cells lie all over memory: they are asked for before their turn

  std::int32_t cell_of(double v_m) const { return static_cast<std::int32_t>(std::floor(v_m / p_.cell_m)); }
  std::size_t slot(std::int32_t x, std::int32_t y) const {
    const auto wrapped = [n = n_](std::int32_t v) { return static_cast<std::size_t>(((v % n) + n) % n); };
    return wrapped(y) * static_cast<std::size_t>(n_) + wrapped(x);
  }
  Eigen::Vector2d middle(const Cell& cell) const { return p_.cell_m * Eigen::Vector2d(cell.x + 0.5, cell.y + 0.5); }

  /// slot() of cells within n of one, without dividing.
  class Nearby {
   public:
    Nearby(std::int32_t x, std::int32_t y, int n) : n_(n), x_(x - n), y_(y - n), x_mod_(mod(x_)), y_mod_(mod(y_)) {}
    std::uint32_t slot(std::int32_t x, std::int32_t y) const {
      return static_cast<std::uint32_t>(wrapped(y - y_ + y_mod_) * n_ + wrapped(x - x_ + x_mod_));
    }

   private:
    std::int32_t mod(std::int32_t v) const { return ((v % n_) + n_) % n_; }
    std::int32_t wrapped(std::int32_t v) const {  // 0 <= v < 3 n
      v -= v >= n_ ? n_ : 0;
      return v - (v >= n_ ? n_ : 0);
    }
    std::int32_t n_, x_, y_, x_mod_, y_mod_;
  };

  /// Returns about B within the room that it keeps, and how low the lowest beam looks.
  void gather(const LidarScan& scan, const Pose& X_OL, const Pose& X_OB) {
    const Eigen::Matrix3f R = X_OL.R.toRotationMatrix().cast<float>();
    const Eigen::Vector3f from_B = (X_OL.p - X_OB.p).cast<float>();
    const Eigen::Vector3f up = (X_OB.R * Eigen::Vector3d::UnitZ()).cast<float>();
    sensor_ = X_OL.p.head<2>();
    sensor_above_m_ = static_cast<double>(from_B.dot(up));
    const auto low = static_cast<float>(-kRoom_m), high = static_cast<float>(p_.clear_height_m + kRoom_m),
               half = static_cast<float>(p_.half_size_m), sensor_above = static_cast<float>(sensor_above_m_);
    std::vector<double> steepest((scan.points.size() + kGridChunk - 1) / kGridChunk, steepest_);
    parallel_keep(scan.points.size(), kGridChunk, returns_, [&](std::size_t begin, std::size_t end, PlaneReturn* kept) {
      double& most = steepest[begin / kGridChunk];
      for (std::size_t k = begin; k < end; ++k) {
        const LidarPoint& point = scan.points[k];
        const Eigen::Vector3f d = R * Eigen::Vector3f(point.x, point.y, point.z) + from_B;
        const float above = d.dot(up);
        if (above < low || above > high || std::abs(d.x()) > half || std::abs(d.y()) > half) continue;
        *kept++ = {d.x(), d.y(), above};
        const float drop = sensor_above - above, dx = d.x() - from_B.x(), dy = d.y() - from_B.y();
        // Hardly a return is steeper than all before it: the root is for those that may be, to the last bit.
        const double across2 = static_cast<double>(dx) * dx + static_cast<double>(dy) * dy;
        if (!(drop > 0.0F) || static_cast<double>(drop) * drop < (1.0 - 1e-5) * most * most * across2) continue;
        const float across = std::hypot(dx, dy);
        if (across > 1.0F) most = std::max(most, static_cast<double>(drop / across));
      }
      return kept;
    });
    for (const double most : steepest) steepest_ = std::max(steepest_, most);
  }

  void sort_into_cells(const Eigen::Vector2d& body_O) {
    seen_m_.fill(0.0F);
    for (const auto& [sector, distance] : ground_.polar()) {
      float& seen = seen_m_[static_cast<std::size_t>(sector)];
      seen = std::max(seen, distance);
    }
    const auto step = static_cast<float>(p_.obstacle_step_m), clear = static_cast<float>(p_.clear_height_m);
    const Nearby nearby(cell_of(body_O.x()), cell_of(body_O.y()), n_);
    parallel_keep(returns_.size(), kGridChunk, told_, [&](std::size_t begin, std::size_t end, Told* kept) {
      for (std::size_t k = begin; k < end; ++k) {
        const PlaneReturn& r = returns_[k];
        const auto [sector, distance] = ground_.polar()[k];
        const PolarGround::Height ground = ground_.at(sector, distance);
        const float above = r.above_m - ground.above_m;
        if (above > clear) continue;
        const bool high = above > step + ground.unsure_m;
        if (!high && above > 0.5F * step) continue;  // neither
        const std::int32_t x = cell_of(body_O.x() + static_cast<double>(r.x_m)),
                           y = cell_of(body_O.y() + static_cast<double>(r.y_m));
        *kept++ = {x, y, nearby.slot(x, y), high ? above : kGround};
      }
      return kept;
    });
    touched_.clear();
    for (std::size_t k = 0; k < told_.size(); ++k) {
      if (k + kAhead < told_.size()) __builtin_prefetch(&cells_[told_[k + kAhead].slot], 1);
      Cell& cell = cell_at(told_[k]);
      if (told_[k].above_m == kGround) {
        ++cell.ground;
        continue;
      }
      ++cell.hits;
      cell.top_m = std::max(cell.top_m, told_[k].above_m);
    }
  }

  Cell& cell_at(const Told& told) {
    Cell& cell = cells_[told.slot];
    if (cell.x != told.x || cell.y != told.y) {
      const bool listed = cell.listed;
      cell = Cell{};
      cell.x = told.x;
      cell.y = told.y;
      cell.listed = listed;
    }
    if (cell.scan != scan_) {
      cell.scan = scan_;
      cell.hits = cell.ground = 0;
      touched_.push_back(told.slot);
    }
    return cell;
  }

  void judge() {
    for (const std::size_t i : touched_) {
      Cell& cell = cells_[i];
      if (cell.hits >= p_.min_hits) {
        see_thing(cell);
        if (!cell.listed) listed_.push_back(i);
        cell.listed = true;
      } else if (cell.hits == 0 && cell.ground > 0) {
        cell.ground_seen = true;
        // Of a cell on a thing's edge some scans show the ground, others the thing.
        if (cell.evidence > 0 && ++cell.bare >= kBareScans) cell.evidence = 0;
      }
    }
  }

  void see_thing(Cell& cell) {
    if (cell.evidence == 0) cell.to_sensor = (sensor_ - middle(cell)).normalized().cast<float>();
    cell.evidence = static_cast<std::int8_t>(std::min<int>(kMostEvidence, cell.evidence + 1));
    cell.last_s = t_s_;
    cell.bare = 0;
    cell.foot_seen = cell.foot_seen || lowest_beam_m(cell) < kFoot_m;
  }

  /// How high over the ground the lowest beam passes a cell.
  double lowest_beam_m(const Cell& cell) const { return sensor_above_m_ - steepest_ * (middle(cell) - sensor_).norm(); }

  void forget(const Pose& X_OB) {
    const PlanPose body = {X_OB.p.head<2>(), yaw_pitch_roll(X_OB.R).yaw_rad};
    std::size_t kept = 0;
    for (const std::size_t i : listed_) {
      Cell& cell = cells_[i];
      const Eigen::Vector2d d = middle(cell) - body.p_m;
      const bool far = d.cwiseAbs().maxCoeff() > p_.half_size_m;
      const bool would_be_met = lowest_beam_m(cell) + kMet_m < static_cast<double>(cell.top_m);
      const bool faded = would_be_met && t_s_ - cell.last_s > p_.memory_s;
      if (cell.evidence > 0 && !far && !faded && !is_under(body, middle(cell))) {
        listed_[kept++] = i;
        continue;
      }
      cell.evidence = 0;
      cell.top_m = 0.0F;
      cell.foot_seen = cell.listed = false;
    }
    listed_.resize(kept);
  }

  /// Where the vehicle stands there is nothing else.
  bool is_under(const PlanPose& body, const Eigen::Vector2d& p) const {
    const Eigen::Vector2d u = body.forward(), d = p - body.p_m;
    const double ahead = u.dot(d), aside = u.x() * d.y() - u.y() * d.x();
    return ahead > vehicle_.rear_m && ahead < vehicle_.front_m && std::abs(aside) < vehicle_.half_width_m;
  }

  void list(const Pose& X_OB) {
    places_.clear();
    for (const std::size_t i : listed_) {
      const Cell& cell = cells_[i];
      if (cell.evidence < std::min<std::int64_t>(p_.persistence_scans, kMostEvidence)) continue;
      places_.push_back(middle(cell));
      if (!cell.foot_seen) add_hidden(cell, {X_OB.p.head<2>(), yaw_pitch_roll(X_OB.R).yaw_rad});
    }
    blocked_ = BlockedCells(X_OB.p.head<2>(), places_);
  }

  /// What may stand below the beams between a thing and the sensor, up to where the ground was seen.
  void add_hidden(const Cell& cell, const PlanPose& body) {
    for (double way_m = p_.cell_m; way_m <= p_.hidden_m; way_m += p_.cell_m) {
      const Eigen::Vector2d p = middle(cell) + way_m * cell.to_sensor.cast<double>();
      const std::int32_t x = cell_of(p.x()), y = cell_of(p.y());
      const Cell& there = cells_[slot(x, y)];
      if (there.x == x && there.y == y && there.ground_seen) return;
      if (is_under(body, p)) return;
      places_.push_back(p);
    }
  }

  GroundGridParameters p_;
  KnownVehicle vehicle_;
  int n_;
  PolarGround ground_;
  std::vector<Cell> cells_;  ///< wraps around
  std::uint32_t scan_ = 0;
  double t_s_ = 0.0;
  Eigen::Vector2d sensor_{0, 0};
  double sensor_above_m_ = 0.0;
  double steepest_ = 0.0;  ///< drop over way of the lowest beam met so far
  std::vector<PlaneReturn> returns_;
  std::vector<Told> told_;
  std::array<float, PolarGround::kSectors> seen_m_{};
  std::vector<std::size_t> touched_, listed_;
  std::vector<Eigen::Vector2d> places_;
  BlockedCells blocked_;
};

}  // namespace

std::unique_ptr<Perception> make_ground_grid(const ModelParameters& own, const KnownVehicle& vehicle) {
  return std::make_unique<GroundGrid>(own.get<GroundGridParameters>(), vehicle);
}

void ground_grid_parameters(ModelParameters& section) {
  section.add<GroundGridParameters>();
}

}  // namespace canyon::mission
