#include "canyon/scene/tracing/tiled_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/scene/surfaces/triangle.h"

namespace canyon::scene {
namespace {

constexpr std::size_t kTiledPacket = RayPacket::kRays;
constexpr double kNone = std::numeric_limits<double>::infinity();
/// A tile is entered a little before the last was left, so that rounding opens no gap.
constexpr double kOverlap_m = 1e-3;

double whole_tiles(double x_m, double edge_m) {
  return edge_m * std::round(x_m / edge_m);
}

/// Of cells counted from 0, the one that x lies in or nearest to; 0 where x is not a number.
int nearest_index(double x, int count) {
  return x > 0.0 ? static_cast<int>(std::min(x, count - 1.0)) : 0;
}

/// How far a ray goes from p until it leaves an interval: 0 if it begins outside.
double way_out(double p, double direction, double low, double high) {
  if (direction > 0.0) return std::max((high - p) / direction, 0.0);
  if (direction < 0.0) return std::max((low - p) / direction, 0.0);
  return kNone;
}

/// Where a tile has nothing; packets with a ray that is not finite are refused there as anywhere.
void miss_all(std::span<const RayPacket> rays, std::span<HitPacket> hits) {
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const RayPacket& r = rays[p];
    for (std::size_t i = 0; i < kTiledPacket; ++i) {
      const Eigen::Vector3f o(r.origin_x[i], r.origin_y[i], r.origin_z[i]),
          d(r.direction_x[i], r.direction_y[i], r.direction_z[i]);
      CANYON_CHECK(o.allFinite() && d.allFinite(), "origin ", o.transpose(), " direction ", d.transpose());
      hits[p].range_m[i] = std::numeric_limits<float>::infinity();
      hits[p].cos_incidence[i] = 0.0f;
      hits[p].triangle[i] = Hit::kMiss;
    }
  }
}

}  // namespace

TiledTracer::TiledTracer(const SceneParts& parts, const Extent& extent) : parts_(parts) {
  const Mesh& mesh = parts.mesh;
  const bool wide = (extent.max - extent.min).head<2>().maxCoeff() > kWide_m ||
                    extent.max.head<2>().cwiseMax(-extent.min.head<2>()).maxCoeff() > kWide_m;
  if (!wide) {
    Tile& only = *tiles_.emplace_back(std::make_unique<Tile>());
    only.triangles.resize(mesh.triangles.size());
    std::iota(only.triangles.begin(), only.triangles.end(), 0u);
    std::swap(only.bottom_m, only.top_m);  // at any height
    tracer(only);
    return;
  }
  tiled_ = true;
  lay_out(extent);
  tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % 65536 == 0) throw_if_cancelled();
    const Triangle t = Triangle::of(mesh, i);
    const Eigen::Vector3d low = t.a.cwiseMin(t.b).cwiseMin(t.c), high = t.a.cwiseMax(t.b).cwiseMax(t.c);
    for (int r = row(low.y()); r <= row(high.y()); ++r)
      for (int c = column(low.x()); c <= column(high.x()); ++c) {
        auto& of = tiles_[index(c, r)];
        if (!of) {
          of = std::make_unique<Tile>();
          of->center_W = {middle_x_m(c), middle_y_m(r), 0.0};
        }
        of->triangles.push_back(i);
        of->bottom_m = std::min(of->bottom_m, low.z());
        of->top_m = std::max(of->top_m, high.z());
      }
  }
}

void TiledTracer::lay_out(const Extent& extent) {
  // A triangle of the usual size lies in one tile or, on a border, in two; a million more are of no account.
  const double most_shares = 4.0 * static_cast<double>(parts_.mesh.triangles.size()) + 1e6;
  for (edge_m_ = kTile_m;; edge_m_ *= 2.0) {
    west_m_ = whole_tiles(extent.min.x(), edge_m_) - 0.5 * edge_m_;
    south_m_ = whole_tiles(extent.min.y(), edge_m_) - 0.5 * edge_m_;
    const double columns = std::floor((whole_tiles(extent.max.x(), edge_m_) - west_m_) / edge_m_) + 1.0;
    const double rows = std::floor((whole_tiles(extent.max.y(), edge_m_) - south_m_) / edge_m_) + 1.0;
    if (columns * rows > kMostTiles) continue;
    columns_ = static_cast<int>(columns);
    rows_ = static_cast<int>(rows);
    double shares = 0.0;
    for (std::uint32_t i = 0; i < parts_.mesh.triangles.size() && shares <= most_shares; ++i) {
      const Triangle t = Triangle::of(parts_.mesh, i);
      const auto [x0, x1] = std::minmax({t.a.x(), t.b.x(), t.c.x()});
      const auto [y0, y1] = std::minmax({t.a.y(), t.b.y(), t.c.y()});
      shares += (column(x1) - column(x0) + 1.0) * (row(y1) - row(y0) + 1.0);
    }
    if (shares <= most_shares) return;
  }
}

int TiledTracer::column(double x_m) const {
  return nearest_index((x_m - west_m_) / edge_m_, columns_);
}

int TiledTracer::row(double y_m) const {
  return nearest_index((y_m - south_m_) / edge_m_, rows_);
}

Eigen::Vector3d TiledTracer::center(const Eigen::Vector3d& p_W) const {
  if (!tiled()) return Eigen::Vector3d::Zero();
  return {middle_x_m(column(p_W.x())), middle_y_m(row(p_W.y())), 0.0};
}

std::size_t TiledTracer::tiles_made() const {
  return static_cast<std::size_t>(
      std::count_if(tiles_.begin(), tiles_.end(), [](const auto& t) { return t && t->tracer != nullptr; }));
}

const Tracer& TiledTracer::tracer(const Tile& tile) const {
  std::call_once(tile.once, [&] {
    tile.tracer = std::make_unique<const Tracer>(parts_, tile.triangles, tile.center_W);
    tile.triangles = {};
  });
  return *tile.tracer;
}

template <class Visit>
void TiledTracer::follow(const Eigen::Vector3d& origin_W, const Eigen::Vector3f& direction, double from_m, double to_m,
                         const Visit& visit) const {
  const Eigen::Vector3d d = direction.cast<double>();
  // To the border tiles belongs all that lies outside of them, where there is nothing.
  const Eigen::Vector3d first = origin_W + from_m * d;
  int c = column(first.x()), r = row(first.y());
  double at_m = from_m;
  for (;;) {
    const Tile* here = tile(c, r);
    const bool more_x = d.x() > 0.0 ? c + 1 < columns_ : d.x() < 0.0 && c > 0;
    const bool more_y = d.y() > 0.0 ? r + 1 < rows_ : d.y() < 0.0 && r > 0;
    const auto out_m = [&](bool more, double p, double along, double middle) {
      return more ? way_out(p, along, middle - 0.5 * edge_m_, middle + 0.5 * edge_m_) : kNone;
    };
    const double out_x_m = out_m(more_x, origin_W.x(), d.x(), middle_x_m(c));
    const double out_y_m = out_m(more_y, origin_W.y(), d.y(), middle_y_m(r));
    const double end_m = std::min({to_m, out_x_m, out_y_m});
    // Heights between which the ray stays here; a metre more for its rounding.
    const double z0 = origin_W.z() + at_m * d.z();
    const double z1 = d.z() == 0.0 ? z0 : origin_W.z() + end_m * d.z();
    if (here != nullptr && std::min(z0, z1) <= here->top_m + 1.0 && std::max(z0, z1) >= here->bottom_m - 1.0) {
      const double start_m = at_m > from_m ? at_m - kOverlap_m : 0.0;
      const RaySpan span{std::max(from_m, start_m), end_m, start_m};
      if (visit(tracer(*here), span)) return;
    }
    if (end_m >= to_m || !std::isfinite(end_m)) return;
    at_m = std::max(at_m, end_m);
    if (out_x_m <= out_y_m)
      c += d.x() > 0.0 ? 1 : -1;
    else
      r += d.y() > 0.0 ? 1 : -1;
  }
}

Hit TiledTracer::trace(const Ray& ray, double from_m) const {
  Hit hit;
  follow(ray.origin, ray.direction, from_m, ray.max_m, [&](const Tracer& tracer, const RaySpan& span) {
    hit = tracer.trace(ray, span);
    return hit.hit();
  });
  return hit;
}

Hit TiledTracer::trace(const Ray& ray) const {
  if (!tiled()) return tracer(*tiles_[0]).trace(ray, {0.0, ray.max_m});
  CANYON_CHECK((ray.origin.array().abs() <= kFarthest_m).all() && (ray.direction.array().abs() <= kFarthest_m).all() &&
                   !std::isnan(ray.max_m),
               "origin ", ray.origin.transpose(), " direction ", ray.direction.transpose());
  return trace(ray, 0.0);
}

void TiledTracer::trace(std::span<const Ray> rays, std::span<Hit> hits) const {
  if (!tiled()) return tracer(*tiles_[0]).trace(rays, hits);
  CANYON_CHECK(rays.size() == hits.size(), "rays = ", rays.size(), ", hits = ", hits.size());
  std::transform(rays.begin(), rays.end(), hits.begin(), [this](const Ray& r) { return trace(r); });
}

void TiledTracer::trace(std::span<const RayPacket> rays, std::span<HitPacket> hits,
                        const Eigen::Vector3d& origin_W) const {
  if (!tiled() && origin_W.isZero(0.0)) return tracer(*tiles_[0]).trace(rays, hits);
  CANYON_CHECK(rays.size() == hits.size(), "packets of rays = ", rays.size(), ", of hits = ", hits.size());
  CANYON_CHECK(origin_W.allFinite(), "origin ", origin_W.transpose());
  const double half_m = 0.5 * edge_m_;
  const Eigen::Vector3d about = center(origin_W);
  // As far as rays stay in the tile that the packets are about, all are traced at once.
  thread_local std::vector<RayPacket> here;
  thread_local std::vector<std::array<double, kTiledPacket>> out_m;
  here.assign(rays.begin(), rays.end());
  out_m.resize(rays.size());
  for (std::size_t p = 0; p < rays.size(); ++p) {
    RayPacket& r = here[p];
    for (std::size_t i = 0; i < kTiledPacket; ++i) {
      const bool ours = origin_W == about && std::max(std::abs(r.origin_x[i]), std::abs(r.origin_y[i])) <= half_m;
      out_m[p][i] = ours ? std::min(way_out(r.origin_x[i], r.direction_x[i], -half_m, half_m),
                                    way_out(r.origin_y[i], r.direction_y[i], -half_m, half_m))
                         : 0.0;
      r.max_m[i] = ours ? std::min(r.max_m[i], static_cast<float>(out_m[p][i])) : -1.0f;
    }
  }
  if (const Tile* around = tile(column(about.x()), row(about.y())))
    tracer(*around).trace(here, hits);
  else
    miss_all(here, hits);
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const RayPacket& r = rays[p];
    for (std::size_t i = 0; i < kTiledPacket; ++i) {
      if (hits[p].triangle[i] != Hit::kMiss || !(r.max_m[i] > out_m[p][i])) continue;
      const Ray ray{origin_W + Eigen::Vector3f(r.origin_x[i], r.origin_y[i], r.origin_z[i]).cast<double>(),
                    {r.direction_x[i], r.direction_y[i], r.direction_z[i]},
                    r.max_m[i]};
      const Hit hit = trace(ray, std::max(out_m[p][i] - kOverlap_m, 0.0));
      if (!hit.hit()) continue;
      hits[p].triangle[i] = hit.triangle, hits[p].range_m[i] = hit.range_m;
      hits[p].cos_incidence[i] = std::min(std::abs(hit.normal.dot(ray.direction)), 1.0f);
    }
  }
}

bool TiledTracer::occluded(const Eigen::Vector3d& origin_W, const Eigen::Vector3f& direction, float min_m, float max_m,
                           std::uint32_t mask) const {
  if (!tiled()) return tracer(*tiles_[0]).occluded(origin_W, direction, {min_m, max_m}, mask);
  CANYON_CHECK((origin_W.array().abs() <= kFarthest_m).all() && (direction.array().abs() <= kFarthest_m).all(),
               "origin ", origin_W.transpose(), " direction ", direction.transpose());
  bool met = false;
  follow(origin_W, direction, min_m, max_m, [&](const Tracer& tracer, const RaySpan& span) {
    met = tracer.occluded(origin_W, direction, span, mask);
    return met;
  });
  return met;
}

NearestSurface TiledTracer::nearest(const Eigen::Vector3d& p_W, double max_m) const {
  CANYON_CHECK(p_W.allFinite() && max_m >= 0.0, "p = ", p_W.transpose(), ", max_m = ", max_m);
  NearestSurface best;
  double reach_m = max_m;
  for (int r = row(p_W.y() - max_m); r <= row(p_W.y() + max_m); ++r) {
    for (int c = column(p_W.x() - max_m); c <= column(p_W.x() + max_m); ++c) {
      const Tile* here = tile(c, r);
      if (here == nullptr) continue;
      const NearestSurface found = tracer(*here).nearest(p_W, reach_m);
      if (found.triangle == Hit::kMiss) continue;
      if (found.distance_m < best.distance_m || found.triangle < best.triangle) best = found;
      reach_m = best.distance_m;
    }
  }
  return best;
}

std::uint32_t TiledTracer::terrain_triangle(double x, double y) const {
  if (!(std::abs(x) <= kFarthest_m) || !(std::abs(y) <= kFarthest_m)) return Hit::kMiss;
  const Tile* here = tile(column(x), row(y));
  return here == nullptr ? Hit::kMiss : tracer(*here).terrain_triangle(x, y);
}

}  // namespace canyon::scene
