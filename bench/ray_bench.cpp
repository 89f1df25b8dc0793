// Rays through the built-in city from a street, over the directions of a 16-beam LIDAR: one by one and in bundles.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "canyon/core/units.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/scene_at.h"

namespace {

using canyon::scene::Hit;
using canyon::scene::Ray;

const canyon::scene::Scene& city() {
  static const canyon::scene::Scene scene(canyon::scene::make_city({}));
  return scene;
}

/// One revolution of 1800 firings of 16 beams between -15 and 15 degrees, 1.8 m above a crossing of streets.
std::vector<Ray> revolution() {
  const Eigen::Vector2d crossing = city().streets().nodes_W[city().streets().nodes_W.size() / 2];
  const double ground_m = city().ground(crossing.x(), crossing.y())->height_m;
  const Eigen::Vector3d origin(crossing.x(), crossing.y(), ground_m + 1.8);
  std::vector<Ray> rays;
  for (int step = 0; step < 1800; ++step)
    for (int beam = 0; beam < 16; ++beam) {
      const double azimuth_rad = step * 2.0 * canyon::kPi / 1800.0;
      const double elevation_rad = (-15.0 + 2.0 * beam) * canyon::kDegree;
      const Eigen::Vector3d direction(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                      std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
      rays.push_back({.origin = origin, .direction = direction.cast<float>(), .max_m = 100.0F});
    }
  return rays;
}

void single_rays(benchmark::State& state) {
  const canyon::scene::SceneAt scene(city());
  const std::vector<Ray> rays = revolution();
  for (auto _ : state)
    for (const Ray& ray : rays) benchmark::DoNotOptimize(scene.trace(ray));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays.size()));
}
BENCHMARK(single_rays)->Name("rays/one_by_one")->Unit(benchmark::kMillisecond);

void bundled_rays(benchmark::State& state) {
  const canyon::scene::SceneAt scene(city());
  const std::vector<Ray> rays = revolution();
  std::vector<Hit> hits(rays.size());
  for (auto _ : state) {
    scene.trace(rays, hits);
    benchmark::DoNotOptimize(hits.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays.size()));
}
BENCHMARK(bundled_rays)->Name("rays/bundled")->Unit(benchmark::kMillisecond);

}  // namespace
