#include "scene/tiled_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/check.h"
#include "scene/triangle.h"

namespace canyon::scene {
namespace {

constexpr std::size_t kPacket = RayPacket::kRays;
constexpr double kNone = std::numeric_limits<double>::infinity();
/// A tile is entered a little before the last was left, so that rounding opens no gap.
constexpr double kOverlap_m = 1e-3;

double whole_tiles(double x_m) {
  return TiledTracer::kTile_m * std::round(x_m / TiledTracer::kTile_m);
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

}  // namespace

TiledTracer::TiledTracer(const SceneParts& parts, const Extent& extent) : parts_(parts) {
  const Mesh& mesh = parts.mesh;
  const bool wide = (extent.max - extent.min).head<2>().maxCoeff() > kWide_m ||
                    extent.max.head<2>().cwiseMax(-extent.min.head<2>()).maxCoeff() > kWide_m;
  if (!wide) {
    Tile& only = *tiles_.emplace_back(std::make_unique<Tile>());
    only.triangles.resize(mesh.triangles.size());
    std::iota(only.triangles.begin(), only.triangles.end(), 0u);
    tracer(only);
    return;
  }
  west_m_ = whole_tiles(extent.min.x()) - 0.5 * kTile_m;
  south_m_ = whole_tiles(extent.min.y()) - 0.5 * kTile_m;
  columns_ = static_cast<int>((whole_tiles(extent.max.x()) - west_m_) / kTile_m) + 1;
  rows_ = static_cast<int>((whole_tiles(extent.max.y()) - south_m_) / kTile_m) + 1;
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < columns_; ++c) {
      Tile& made = *tiles_.emplace_back(std::make_unique<Tile>());
      made.center_W = {west_m_ + (c + 0.5) * kTile_m, south_m_ + (r + 0.5) * kTile_m, 0.0};
    }
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = Triangle::of(mesh, i);
    const Eigen::Vector3d low = t.a.cwiseMin(t.b).cwiseMin(t.c), high = t.a.cwiseMax(t.b).cwiseMax(t.c);
    for (int r = row(low.y()); r <= row(high.y()); ++r)
      for (int c = column(low.x()); c <= column(high.x()); ++c) {
        Tile& of =
            *tiles_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c)];
        of.triangles.push_back(i);
        of.bottom_m = std::min(of.bottom_m, low.z());
        of.top_m = std::max(of.top_m, high.z());
      }
  }
}

int TiledTracer::column(double x_m) const {
  return nearest_index((x_m - west_m_) / kTile_m, columns_);
}

int TiledTracer::row(double y_m) const {
  return nearest_index((y_m - south_m_) / kTile_m, rows_);
}

Eigen::Vector3d TiledTracer::center(const Eigen::Vector3d& p_W) const {
  return tile(column(p_W.x()), row(p_W.y())).center_W;
}

std::size_t TiledTracer::tiles_made() const {
  return static_cast<std::size_t>(
      std::count_if(tiles_.begin(), tiles_.end(), [](const auto& t) { return t->tracer != nullptr; }));
}

const Tracer& TiledTracer::tracer(const Tile& tile) const {
  std::call_once(tile.once, [&] {
    const std::vector<std::uint32_t> triangles = std::move(tile.triangles);
    tile.tracer = std::make_unique<const Tracer>(parts_, triangles, tile.center_W);
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
    const Tile& here = tile(c, r);
    const bool more_x = d.x() > 0.0 ? c + 1 < columns_ : d.x() < 0.0 && c > 0;
    const bool more_y = d.y() > 0.0 ? r + 1 < rows_ : d.y() < 0.0 && r > 0;
    const auto out_m = [&](bool more, double p, double along, double middle) {
      return more ? way_out(p, along, middle - 0.5 * kTile_m, middle + 0.5 * kTile_m) : kNone;
    };
    const double out_x_m = out_m(more_x, origin_W.x(), d.x(), here.center_W.x());
    const double out_y_m = out_m(more_y, origin_W.y(), d.y(), here.center_W.y());
    const double end_m = std::min({to_m, out_x_m, out_y_m});
    // Heights between which the ray stays here; a metre more for its rounding.
    const double z0 = origin_W.z() + at_m * d.z();
    const double z1 = d.z() == 0.0 ? z0 : origin_W.z() + end_m * d.z();
    if (std::min(z0, z1) <= here.top_m + 1.0 && std::max(z0, z1) >= here.bottom_m - 1.0) {
      const double start_m = at_m > from_m ? at_m - kOverlap_m : 0.0;
      const RaySpan span{std::max(from_m, start_m), end_m, start_m};
      if (visit(tracer(here), span)) return;
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
  if (tiled() && ray.origin.allFinite() && ray.direction.allFinite()) return trace(ray, 0.0);
  return tracer(*tiles_[0]).trace(ray, {0.0, ray.max_m});
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
  constexpr double kHalf_m = 0.5 * kTile_m;
  const Eigen::Vector3d about = center(origin_W);
  // As far as rays stay in the tile that the packets are about, all are traced at once.
  thread_local std::vector<RayPacket> here;
  thread_local std::vector<std::array<double, kPacket>> out_m;
  here.assign(rays.begin(), rays.end());
  out_m.resize(rays.size());
  for (std::size_t p = 0; p < rays.size(); ++p) {
    RayPacket& r = here[p];
    for (std::size_t i = 0; i < kPacket; ++i) {
      const bool ours = origin_W == about && std::max(std::abs(r.origin_x[i]), std::abs(r.origin_y[i])) <= kHalf_m;
      out_m[p][i] = ours ? std::min(way_out(r.origin_x[i], r.direction_x[i], -kHalf_m, kHalf_m),
                                    way_out(r.origin_y[i], r.direction_y[i], -kHalf_m, kHalf_m))
                         : 0.0;
      r.max_m[i] = ours ? std::min(r.max_m[i], static_cast<float>(out_m[p][i])) : -1.0f;
    }
  }
  tracer(tile(column(about.x()), row(about.y()))).trace(here, hits);
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const RayPacket& r = rays[p];
    for (std::size_t i = 0; i < kPacket; ++i) {
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
  if (!tiled() || !origin_W.allFinite() || !direction.allFinite())
    return tracer(*tiles_[0]).occluded(origin_W, direction, {min_m, max_m}, mask);
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
      const NearestSurface found = tracer(tile(c, r)).nearest(p_W, reach_m);
      if (found.triangle == Hit::kMiss) continue;
      if (found.distance_m < best.distance_m || found.triangle < best.triangle) best = found;
      reach_m = best.distance_m;
    }
  }
  return best;
}

std::uint32_t TiledTracer::terrain_triangle(double x, double y) const {
  if (!std::isfinite(x) || !std::isfinite(y)) return Hit::kMiss;
  return tracer(tile(column(x), row(y))).terrain_triangle(x, y);
}

}  // namespace canyon::scene
