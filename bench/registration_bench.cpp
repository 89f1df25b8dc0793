// The own methods beside PCL's own generalized ICP, in the same run: two clouds from the files SOURCE and TARGET that
// the environment variables CANYON_BENCH_SOURCE and CANYON_BENCH_TARGET name (two scans of the same place), thinned to
// 0.25 m. CPU time of one thread; pcl_total_ratio and pcl_align_ratio are PCL's over ours in the same repetitions, and
// two_threads_ms is ours by the clock.
#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <benchmark/benchmark.h>

#include "canyon/core/process/parallel.h"
#include "canyon/lidar/files/clouds/read_cloud.h"
#include "canyon/lidar/registration/engine/leaf_tree.h"
#include "canyon/lidar/registration/neighbour_tree.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/lidar/registration/registration.h"

namespace {

using canyon::lidar::Registration;
using Points = std::vector<Eigen::Vector3f>;

double ms_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}
double cpu_ms() {
  return ms_of(CLOCK_PROCESS_CPUTIME_ID);
}
double clock_ms() {
  return ms_of(CLOCK_MONOTONIC);
}

Points cloud_of(const char* variable) {
  const char* path = std::getenv(variable);
  Points out;
  if (path == nullptr) return out;
  const auto cloud = canyon::lidar::read_cloud(path);
  if (!cloud.ok()) return out;
  for (const Eigen::Vector3d& p : cloud->points) out.push_back(p.cast<float>());
  return out;
}

std::unique_ptr<Registration> method(const char* name) {
  canyon::lidar::RegistrationConfig config;
  config.method.name = name;
  config.method.own.get<canyon::lidar::MatchingParameters>().leaf_m = 0.25;
  return *canyon::lidar::make_registration(config);
}

struct Times {
  std::vector<double> prepare, align;
  static double middle(std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  }
  double total() const { return middle(prepare) + middle(align); }
};

void once(const Registration& by, const Points& source, const Points& target, double (*now_ms)(), Times& times) {
  const double begin = now_ms();
  const auto s = by.prepare(source);
  const Registration::Placed placed{by.prepare(target), canyon::Pose{}};
  const double prepared = now_ms();
  benchmark::DoNotOptimize(by.align(*s, {&placed, 1}, canyon::Pose{}));
  times.prepare.push_back(prepared - begin);
  times.align.push_back(now_ms() - prepared);
}

void registration(benchmark::State& state, const char* name) {
  canyon::set_threads(1);
  const Points source = cloud_of("CANYON_BENCH_SOURCE"), target = cloud_of("CANYON_BENCH_TARGET");
  if (source.empty() || target.empty())
    return state.SkipWithError("CANYON_BENCH_SOURCE, CANYON_BENCH_TARGET: no clouds");
  const auto ours = method(name), pcl = method("pcl_gicp");
  Times our_times, pcl_times, on_two;
  for (auto _ : state) {
    once(*ours, source, target, cpu_ms, our_times);
    state.PauseTiming();
    once(*pcl, source, target, cpu_ms, pcl_times);
    canyon::set_threads(2);
    once(*ours, source, target, clock_ms, on_two);
    canyon::set_threads(1);
    state.ResumeTiming();
  }
  state.counters["prepare_ms"] = Times::middle(our_times.prepare);
  state.counters["align_ms"] = Times::middle(our_times.align);
  state.counters["pcl_total_ms"] = pcl_times.total();
  state.counters["pcl_align_ms"] = Times::middle(pcl_times.align);
  state.counters["pcl_total_ratio"] = pcl_times.total() / our_times.total();
  state.counters["pcl_align_ratio"] = Times::middle(pcl_times.align) / Times::middle(our_times.align);
  state.counters["two_threads_ms"] = on_two.total();
}
BENCHMARK_CAPTURE(registration, gicp, "gicp")->Iterations(15)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(registration, point_to_plane, "point_to_plane")->Iterations(15)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(registration, vgicp, "vgicp")->Iterations(15)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(registration, pcl_shell_gicp, "pcl_shell_gicp")->Iterations(15)->Unit(benchmark::kMillisecond);

/// One query within 1 m, beside the tree that the shell uses.
void nearest(benchmark::State& state) {
  const auto by = method("gicp");
  const auto source = by->prepare(cloud_of("CANYON_BENCH_SOURCE")),
             target = by->prepare(cloud_of("CANYON_BENCH_TARGET"));
  if (source->points.empty() || target->points.empty()) return state.SkipWithError("no clouds");
  const canyon::lidar::NeighbourTree other(target->points);
  std::vector<double> ours, theirs;
  for (auto _ : state) {
    const double begin = cpu_ms();
    for (const Eigen::Vector3f& p : source->points) benchmark::DoNotOptimize(target->tree->nearest(p, 1.0f));
    const double between = cpu_ms();
    canyon::lidar::NeighbourTree::Neighbour found;
    for (const Eigen::Vector3f& p : source->points) benchmark::DoNotOptimize(other.nearest(p, 1.0f, {&found, 1}));
    ours.push_back(between - begin);
    theirs.push_back(cpu_ms() - between);
  }
  const double per_query = 1e6 / static_cast<double>(source->points.size());
  state.counters["leaf_tree_ns"] = per_query * Times::middle(ours);
  state.counters["neighbour_tree_ns"] = per_query * Times::middle(theirs);
}
BENCHMARK(nearest)->Iterations(50);

}  // namespace
