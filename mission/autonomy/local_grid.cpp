#include "canyon/mission/autonomy/local_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace canyon::mission {

namespace {

std::int64_t modulo(std::int64_t a, std::int64_t n) {
  const std::int64_t r = a % n;
  return r < 0 ? r + n : r;
}

/// One pass of the exact squared Euclidean distance transform (Felzenszwalb and Huttenlocher 2012) over f of length n.
void distance_pass(const float* f, float* out, int n, std::vector<int>& v, std::vector<float>& z) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  int k = -1;
  for (int q = 0; q < n; ++q) {
    if (f[q] == kInf) continue;
    const auto fq = static_cast<float>(q);
    float s = -kInf;
    while (k >= 0) {
      const auto fv = static_cast<float>(v[static_cast<std::size_t>(k)]);
      s = ((f[q] + fq * fq) - (f[v[static_cast<std::size_t>(k)]] + fv * fv)) / (2 * (fq - fv));
      if (s > z[static_cast<std::size_t>(k)]) break;
      --k;
    }
    if (k < 0) s = -kInf;
    ++k;
    v[static_cast<std::size_t>(k)] = q;
    z[static_cast<std::size_t>(k)] = s;
  }
  if (k < 0) {
    std::fill(out, out + n, kInf);
    return;
  }
  int j = 0;
  for (int q = 0; q < n; ++q) {
    while (j < k && z[static_cast<std::size_t>(j + 1)] < static_cast<float>(q)) ++j;
    const auto d = static_cast<float>(q - v[static_cast<std::size_t>(j)]);
    out[q] = d * d + f[v[static_cast<std::size_t>(j)]];
  }
}

}  // namespace

void visit(FieldVisitor& f, LocalGridConfig& c) {
  f.number("cell_m", c.cell_m, {0.1, 2}, "edge of a cell");
  f.number("half_size_m", c.half_size_m, {5, 60},
           "how far it reaches to every side; what lies farther off counts as free");
  f.number("memory_s", c.memory_s, {0.2, 600}, "a surface not seen again for this long is forgotten");
  f.number("obstacle_step_m", c.obstacle_step_m, {0.05, 5},
           "height difference within a cell that makes it an obstacle");
  f.number("max_obstacle_height_m", c.max_obstacle_height_m, {0.1, 20},
           "above the vehicle's own ground plane; higher things are driven under");
  f.number("min_depth_m", c.min_depth_m, {-20, 0}, "below that plane; lower points are not of this street");
  f.integer("min_hits", c.min_hits, {1, 1000}, "points in a cell before it is judged");
}

LocalGrid::LocalGrid(const LocalGridConfig& config)
    : config_(config), n_(2 * static_cast<int>(std::ceil(config.half_size_m / config.cell_m))) {
  const auto count = static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_);
  cells_.resize(count);
  owner_x_.assign(count, std::numeric_limits<std::int64_t>::min());
  owner_y_.assign(count, std::numeric_limits<std::int64_t>::min());
  distance_.assign(count, static_cast<float>(kFar));
}

std::size_t LocalGrid::index(int ix, int iy) const {
  return static_cast<std::size_t>(iy) * static_cast<std::size_t>(n_) + static_cast<std::size_t>(ix);
}

void LocalGrid::add(const std::vector<Eigen::Vector3f>& points_L, const Pose& X_WL, const Pose& X_WB, double t_s) {
  era_ = static_cast<std::int32_t>(std::floor(t_s / (0.5 * config_.memory_s)));
  center_x_ = static_cast<std::int64_t>(std::floor(X_WB.p.x() / config_.cell_m));
  center_y_ = static_cast<std::int64_t>(std::floor(X_WB.p.y() / config_.cell_m));
  // Only heights relative to the estimate matter to single precision here: W reaches a kilometre.
  const Eigen::Matrix3f R = X_WL.R.toRotationMatrix().cast<float>();
  const Eigen::Vector3f from_B = (X_WL.p - X_WB.p).cast<float>();
  const Eigen::Vector3f up_B = (X_WB.R * Eigen::Vector3d::UnitZ()).cast<float>();
  const auto low = static_cast<float>(config_.min_depth_m), high = static_cast<float>(config_.max_obstacle_height_m);
  for (const Eigen::Vector3f& point : points_L) {
    const Eigen::Vector3f d = R * point + from_B;  // from B, W axes
    const float above = d.dot(up_B);
    if (above < low || above > high) continue;
    const auto gx = static_cast<std::int64_t>(std::floor((X_WB.p.x() + static_cast<double>(d.x())) / config_.cell_m));
    const auto gy = static_cast<std::int64_t>(std::floor((X_WB.p.y() + static_cast<double>(d.y())) / config_.cell_m));
    if (std::abs(gx - center_x_) >= n_ / 2 || std::abs(gy - center_y_) >= n_ / 2) continue;
    const std::size_t i = index(static_cast<int>(modulo(gx, n_)), static_cast<int>(modulo(gy, n_)));
    Cell& cell = cells_[i];
    if (owner_x_[i] != gx || owner_y_[i] != gy) {
      cell = Cell{};
      owner_x_[i] = gx;
      owner_y_[i] = gy;
    }
    Slot& slot = cell.slot[era_ & 1];
    const float z = static_cast<float>(X_WB.p.z()) + d.z();
    if (slot.era != era_) {
      slot = Slot{z, z, 0, era_};
    } else {
      slot.min_z = std::min(slot.min_z, z);
      slot.max_z = std::max(slot.max_z, z);
    }
    ++slot.hits;
  }
}

void LocalGrid::update_distances() {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const auto n = static_cast<std::size_t>(n_);
  std::vector<float> field(n * n, kInf), rows(n * n), line(n), out(n);
  obstacles_ = 0;
  const std::int64_t x0 = center_x_ - n_ / 2, y0 = center_y_ - n_ / 2;
  for (std::size_t iy = 0; iy < n; ++iy) {
    for (std::size_t ix = 0; ix < n; ++ix) {
      const std::int64_t gx = x0 + static_cast<std::int64_t>(ix), gy = y0 + static_cast<std::int64_t>(iy);
      const std::size_t i = index(static_cast<int>(modulo(gx, n_)), static_cast<int>(modulo(gy, n_)));
      if (owner_x_[i] != gx || owner_y_[i] != gy) continue;
      float min_z = kInf, max_z = -kInf;
      std::int64_t hits = 0;
      for (const Slot& slot : cells_[i].slot) {
        if (slot.era < 0 || slot.era < era_ - 1) continue;
        min_z = std::min(min_z, slot.min_z);
        max_z = std::max(max_z, slot.max_z);
        hits += slot.hits;
      }
      if (hits >= config_.min_hits && max_z - min_z > static_cast<float>(config_.obstacle_step_m)) {
        field[iy * n + ix] = 0.0F;
        ++obstacles_;
      }
    }
  }
  std::vector<int> v(n);
  std::vector<float> z(n);
  for (std::size_t iy = 0; iy < n; ++iy) distance_pass(&field[iy * n], &rows[iy * n], n_, v, z);
  for (std::size_t ix = 0; ix < n; ++ix) {
    for (std::size_t iy = 0; iy < n; ++iy) line[iy] = rows[iy * n + ix];
    distance_pass(line.data(), out.data(), n_, v, z);
    for (std::size_t iy = 0; iy < n; ++iy) {
      const std::int64_t gx = x0 + static_cast<std::int64_t>(ix), gy = y0 + static_cast<std::int64_t>(iy);
      const double d = config_.cell_m * std::sqrt(static_cast<double>(out[iy]));
      distance_[index(static_cast<int>(modulo(gx, n_)), static_cast<int>(modulo(gy, n_)))] =
          static_cast<float>(std::min(d, kFar));
    }
  }
}

double LocalGrid::distance_m(const Eigen::Vector2d& p_W) const {
  const auto gx = static_cast<std::int64_t>(std::floor(p_W.x() / config_.cell_m));
  const auto gy = static_cast<std::int64_t>(std::floor(p_W.y() / config_.cell_m));
  if (std::abs(gx - center_x_) >= n_ / 2 || std::abs(gy - center_y_) >= n_ / 2) return kFar;
  return static_cast<double>(distance_[index(static_cast<int>(modulo(gx, n_)), static_cast<int>(modulo(gy, n_)))]);
}

}  // namespace canyon::mission
