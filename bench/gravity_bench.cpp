// Normal gravity beside GeographicLib's, both to the last digits (tests/core/earth).
#include <benchmark/benchmark.h>
#include <GeographicLib/NormalGravity.hpp>

#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

Eigen::Vector3d geographiclib(const Eigen::Vector3d& p_E) {
  Eigen::Vector3d g_E;
  GeographicLib::NormalGravity::WGS84().U(p_E.x(), p_E.y(), p_E.z(), g_E.x(), g_E.y(), g_E.z());
  return g_E;
}

void gravity(benchmark::State& state, Eigen::Vector3d (*of)(const Eigen::Vector3d&)) {
  Eigen::Vector3d p_E = ecef_from_geodetic({32.35 * kDegree, -90.88 * kDegree, 60.0});
  for (auto _ : state) {
    p_E.x() += 0.05;  // as a vehicle does from sample to sample
    benchmark::DoNotOptimize(of(p_E));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(gravity, canyon, gravity_E);
BENCHMARK_CAPTURE(gravity, geographiclib, geographiclib);

}  // namespace
}  // namespace canyon
