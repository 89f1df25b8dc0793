// The LIDAR's speed beside the bare ray tracer: Embree's own packet loop on the same rays, over the same triangles, in
// the same run. Each benchmark alternates the two, one revolution each, and reports the median of the ratios
// (share_of_bare) beside both rates, and the ratio of the quickest revolution of each (share_at_best), which tells most
// on a machine that others use too.
#include <embree3/rtcore.h>

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/beam_table.h"
#include "canyon/lidar/beam/firing_pattern.h"
#include "canyon/lidar/beam/footprint/footprint_rays.h"
#include "canyon/lidar/scanner.h"
#include "canyon/lidar/sweep_motion.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/city/traffic.h"
#include "canyon/scene/scene_at.h"

namespace {

using canyon::scene::HitPacket;
using canyon::scene::RayPacket;
constexpr std::size_t kLanes = RayPacket::kRays;

const canyon::scene::Scene& city() {
  static const canyon::scene::Scene scene(canyon::scene::make_city({}));
  return scene;
}

/// Embree alone: one geometry, ROBUST, no masks.
class BareEmbree {
 public:
  explicit BareEmbree(const canyon::scene::Mesh& mesh) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.vertices.size()));
    std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * 3 * sizeof(float));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.triangles.size()));
    std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(unsigned));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  /// The least that a packet loop must do: lay the rays out, trace, keep the ranges.
  void trace(const std::vector<RayPacket>& rays, std::vector<float>& ranges) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) int valid[kLanes];
    alignas(64) RTCRayHit16 query;
    for (std::size_t p = 0; p < rays.size(); ++p) {
      for (std::size_t i = 0; i < kLanes; ++i) valid[i] = rays[p].max_m[i] >= 0.0f ? -1 : 0;
      std::memcpy(query.ray.org_x, rays[p].origin_x, sizeof query.ray.org_x);
      std::memcpy(query.ray.org_y, rays[p].origin_y, sizeof query.ray.org_y);
      std::memcpy(query.ray.org_z, rays[p].origin_z, sizeof query.ray.org_z);
      std::memcpy(query.ray.dir_x, rays[p].direction_x, sizeof query.ray.dir_x);
      std::memcpy(query.ray.dir_y, rays[p].direction_y, sizeof query.ray.dir_y);
      std::memcpy(query.ray.dir_z, rays[p].direction_z, sizeof query.ray.dir_z);
      std::memcpy(query.ray.tfar, rays[p].max_m, sizeof query.ray.tfar);
      std::memset(query.ray.tnear, 0, sizeof query.ray.tnear);
      std::memset(query.ray.time, 0, sizeof query.ray.time);
      std::memset(query.ray.mask, 0xff, sizeof query.ray.mask);
      std::memset(query.ray.flags, 0, sizeof query.ray.flags);
      std::memset(query.hit.geomID, 0xff, sizeof query.hit.geomID);
      std::memset(query.hit.instID[0], 0xff, sizeof query.hit.instID[0]);
      rtcIntersect16(valid, scene_, &context, &query);
      std::memcpy(ranges.data() + p * kLanes, query.ray.tfar, sizeof query.ray.tfar);
    }
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

const BareEmbree& bare() {
  static const BareEmbree embree(city().mesh());
  return embree;
}

/// So wide that it is traced in tiles.
const canyon::scene::Scene& wide_city() {
  static const canyon::scene::Scene scene(canyon::scene::make_city({.extent_m = 2200.0}));
  return scene;
}
const BareEmbree& bare_wide() {
  static const BareEmbree embree(wide_city().mesh());
  return embree;
}

Eigen::Vector3d sensor_place(const canyon::scene::Scene& scene = city()) {
  const Eigen::Vector2d crossing = scene.streets().nodes_W[scene.streets().nodes_W.size() / 2];
  return {crossing.x(), crossing.y(), scene.ground(crossing.x(), crossing.y())->height_m + 1.8};
}

enum class Order { kRing, kColumn, kVolley };
constexpr std::size_t kVolleySteps = 32;

/// The rays of one revolution from a standing sensor.
std::vector<RayPacket> revolution(const canyon::lidar::BeamTable& table, std::size_t steps, Order order) {
  const Eigen::Vector3f origin = sensor_place().cast<float>();
  std::vector<RayPacket> packets;
  std::size_t lane = kLanes;
  const auto add = [&](std::size_t ring, std::size_t step) {
    if (lane == kLanes) packets.emplace_back(), lane = 0;
    const double azimuth = 2.0 * canyon::kPi * static_cast<double>(step) / static_cast<double>(steps) +
                           table.beams[ring].azimuth_offset_rad;
    const double elevation = table.beams[ring].elevation_rad;
    RayPacket& packet = packets.back();
    packet.origin_x[lane] = origin.x(), packet.origin_y[lane] = origin.y(), packet.origin_z[lane] = origin.z();
    packet.direction_x[lane] = static_cast<float>(-std::cos(elevation) * std::cos(azimuth));
    packet.direction_y[lane] = static_cast<float>(std::cos(elevation) * std::sin(azimuth));
    packet.direction_z[lane] = static_cast<float>(std::sin(elevation));
    packet.max_m[lane] = 100.0f;
    ++lane;
  };
  const std::size_t rings = table.beams.size();
  if (order == Order::kRing) {
    for (std::size_t j = 0; j < rings; ++j)
      for (std::size_t c = 0; c < steps; ++c) add(j, c);
  } else if (order == Order::kVolley) {
    for (std::size_t first = 0; first < steps; first += kVolleySteps)
      for (std::size_t j = 0; j < rings; ++j)
        for (std::size_t c = first; c < std::min(steps, first + kVolleySteps); ++c) add(j, c);
  } else {
    for (std::size_t c = 0; c < steps; ++c)
      for (std::size_t j = 0; j < rings; ++j) add(j, c);
  }
  for (; lane < kLanes; ++lane) {  // the last packet is filled up with its last ray
    RayPacket& packet = packets.back();
    for (float* v : {packet.origin_x, packet.origin_y, packet.origin_z, packet.direction_x, packet.direction_y,
                     packet.direction_z, packet.max_m})
      v[lane] = v[lane - 1];
  }
  return packets;
}

/// Seconds of processor time of the whole process: what others on the machine do hardly shows in it.
double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Runs both in turn and reports the median ratio of their rates; `rays` of ours and of theirs may differ.
template <class Ours, class Theirs>
void side_by_side(benchmark::State& state, double our_rays, Ours ours, double their_rays, Theirs theirs) {
  std::vector<double> ratios, our_s, their_s;
  ours(), theirs();
  for (auto _ : state) {
    double start_s = cpu_s();
    theirs();
    their_s.push_back(cpu_s() - start_s);
    start_s = cpu_s();
    ours();
    our_s.push_back(cpu_s() - start_s);
    state.SetIterationTime(our_s.back());
    ratios.push_back((our_rays / our_s.back()) / (their_rays / their_s.back()));
  }
  const auto least = [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); };
  state.counters["share_of_bare"] = median(ratios);
  state.counters["share_at_best"] = (our_rays / least(our_s)) / (their_rays / least(their_s));
  state.counters["Mrays_s"] = our_rays / median(our_s) * 1e-6;
  state.counters["bare_Mrays_s"] = their_rays / median(their_s) * 1e-6;
}

const canyon::lidar::BeamTable& table_of(const char* name) {
  static std::vector<std::unique_ptr<canyon::lidar::BeamTable>> tables;
  for (const auto& table : tables)
    if (table->name == name) return *table;
  tables.push_back(std::make_unique<canyon::lidar::BeamTable>(*canyon::lidar::load_beam_table(name)));
  return *tables.back();
}

void packets_traced(benchmark::State& state, Order order) {
  const canyon::scene::SceneAt scene(city());
  const auto rays = revolution(table_of("vlp16"), 1800, order);
  const auto best = revolution(table_of("vlp16"), 1800, Order::kRing);
  std::vector<HitPacket> hits(rays.size());
  std::vector<float> ranges(best.size() * kLanes);
  const double count = static_cast<double>(rays.size() * kLanes);
  side_by_side(
      state, count, [&] { scene.trace(rays, hits); }, count, [&] { bare().trace(best, ranges); });
}
BENCHMARK_CAPTURE(packets_traced, ring_order, Order::kRing)->UseManualTime();
BENCHMARK_CAPTURE(packets_traced, volley_order, Order::kVolley)->UseManualTime();
BENCHMARK_CAPTURE(packets_traced, column_order, Order::kColumn)->UseManualTime();

/// The bare ray tracer in other orders of the same rays, beside ring order.
void bare_order(benchmark::State& state, Order order) {
  const auto rays = revolution(table_of("vlp16"), 1800, order);
  const auto best = revolution(table_of("vlp16"), 1800, Order::kRing);
  std::vector<float> ranges(rays.size() * kLanes);
  const double count = static_cast<double>(rays.size() * kLanes);
  side_by_side(
      state, count, [&] { bare().trace(rays, ranges); }, count, [&] { bare().trace(best, ranges); });
}
BENCHMARK_CAPTURE(bare_order, volley, Order::kVolley)->UseManualTime();
BENCHMARK_CAPTURE(bare_order, column, Order::kColumn)->UseManualTime();

constexpr canyon::GpsTime kStart{1'000'000'000'000'000'000};

/// 8 m/s in a curve of 0.3 rad/s.
canyon::Trajectory driving(const canyon::scene::Scene& scene = city()) {
  const canyon::Pose middle{Eigen::Quaterniond::Identity(), sensor_place(scene)};
  canyon::Vector6d twist;
  twist << 0, 0, 0.3, 8, 0, 0;
  canyon::Trajectory motion;
  for (int k = -40; k <= 40; ++k) motion.append({kStart + 0.005 * k, middle * canyon::Pose::exp(twist * (0.005 * k))});
  return motion;
}

/// The very rays of the driving sensor's revolution, ring by ring.
std::vector<RayPacket> driving_rays(const canyon::lidar::LidarConfig& config, const canyon::Trajectory& motion) {
  const canyon::lidar::FiringPattern pattern(table_of(config.beams.c_str()), config.rate_hz,
                                             static_cast<std::size_t>(config.azimuth_steps));
  const auto sweep = pattern.sweep(0);
  const canyon::lidar::SweepMotion path(motion, kStart, -1.0 / config.rate_hz, 0.0, canyon::Pose{}, canyon::Pose{});
  std::vector<RayPacket> packets;
  for (std::size_t laser = 0; laser < pattern.lasers(); ++laser) {
    std::size_t hint = 0;
    for (std::size_t cycle = 0; cycle < sweep.cycles; cycle += kLanes) {
      canyon::lidar::AimPacket aim;
      canyon::lidar::PlacementPacket placements;
      pattern.aim(sweep, laser, cycle, aim);
      path.placements(
          sweep.start_s + pattern.step_s() * static_cast<double>(cycle) + pattern.table().beams[laser].firing_s,
          pattern.step_s(), hint, placements);
      canyon::lidar::place_shots(aim, placements, 0.0f, static_cast<float>(config.report.max_range_m),
                                 packets.emplace_back());
      for (std::size_t lane = sweep.cycles - cycle; lane < kLanes; ++lane) packets.back().max_m[lane] = -1.0f;
    }
  }
  return packets;
}

void whole_scan(benchmark::State& state, const canyon::lidar::LidarConfig& config) {
  canyon::set_threads(1);
  const canyon::scene::SceneAt scene(city());
  const auto& table = table_of(config.beams.c_str());
  const canyon::Trajectory motion = driving();
  const auto best = driving_rays(config, motion);
  std::vector<float> ranges(best.size() * kLanes);
  const auto scanner = *canyon::lidar::make_scanner(config, 1);
  const double count = static_cast<double>(config.azimuth_steps) * static_cast<double>(table.beams.size());
  std::int64_t index = 0;
  canyon::lidar::LidarOutput out;
  side_by_side(
      state, count, [&] { scanner->scan(index++, kStart, motion, scene, out); }, count,
      [&] { bare().trace(best, ranges); });
}

canyon::lidar::LidarConfig at_origin() {
  canyon::lidar::LidarConfig config;
  config.mount_m.setZero();
  return config;
}

/// Ranges of a driving sensor, every ray from its own place: nothing else.
void single_ray_ranges(benchmark::State& state, const char* beams, int steps, bool wide = false) {
  canyon::set_threads(1);
  const canyon::scene::SceneAt scene(wide ? wide_city() : city());
  const BareEmbree& theirs = wide ? bare_wide() : bare();
  const auto& table = table_of(beams);
  canyon::lidar::LidarConfig config = at_origin();
  config.beams = beams;
  config.azimuth_steps = steps;
  const canyon::Trajectory motion = driving(scene.scene());
  const auto best = driving_rays(config, motion);
  std::vector<float> ranges(best.size() * kLanes);
  const auto scanner = *canyon::lidar::make_scanner(config, 1);
  std::int64_t index = 0;
  std::vector<float> out;
  const double count = steps * static_cast<double>(table.beams.size());
  side_by_side(
      state, count, [&] { scanner->true_ranges(index++, kStart, motion, scene, out); }, count,
      [&] { theirs.trace(best, ranges); });
}
BENCHMARK_CAPTURE(single_ray_ranges, vlp16, "vlp16", 1800)->UseManualTime();
BENCHMARK_CAPTURE(single_ray_ranges, os1_128, "os1_128", 1024)->UseManualTime();
BENCHMARK_CAPTURE(single_ray_ranges, vlp16_in_tiles, "vlp16", 1800, true)->UseManualTime();

void single_ray_scan(benchmark::State& state) {
  whole_scan(state, at_origin());
}
BENCHMARK(single_ray_scan)->UseManualTime();

/// All sub-rays of the 16-ray beam, bare, beam by beam: the same packets that the footprint model traces.
void footprint_scan(benchmark::State& state) {
  canyon::set_threads(1);
  const canyon::scene::SceneAt scene(city());
  canyon::lidar::LidarConfig config = at_origin();
  config.model.name = "footprint";
  const canyon::Trajectory motion = driving();
  const auto middle = driving_rays(config, motion);
  const auto offsets = canyon::lidar::footprint_offsets(0.75e-3, 0.375e-3);
  const float up[3] = {0, 0, 1};
  std::vector<RayPacket> best(middle.size() * kLanes);
  for (std::size_t i = 0; i < best.size(); ++i)
    canyon::lidar::spread_beam(middle[i / kLanes], i % kLanes, up, offsets, best[i]);
  std::vector<float> ranges(best.size() * kLanes);
  const auto scanner = *canyon::lidar::make_scanner(config, 1);
  const double count = 1800.0 * 16.0 * kLanes;
  std::int64_t index = 0;
  canyon::lidar::LidarOutput out;
  side_by_side(
      state, count, [&] { scanner->scan(index++, kStart, motion, scene, out); }, count,
      [&] { bare().trace(best, ranges); });
}
BENCHMARK(footprint_scan)->UseManualTime();

/// What each model costs: a scan with it beside the plain scan (single ray, ideal detector), in turn.
void cost_of(benchmark::State& state, void (*change)(canyon::lidar::LidarConfig&), int cars) {
  canyon::set_threads(1);
  canyon::scene::SceneAt still(city()), busy(city());
  std::vector<canyon::scene::MovingConfig> traffic;
  const Eigen::Vector3d place = sensor_place();
  for (int k = 0; k < cars; ++k) {
    const double x = place.x() + 4.0 * (k % 5) - 8.0, y = place.y() + 8.0 * (1 + k / 5);
    traffic.push_back({.name = "car " + std::to_string(k), .path_m = {x, y, x, y + 8.0}});
  }
  const auto moving = *canyon::scene::Traffic::make(traffic, city());
  if (cars > 0) busy.set_instances(moving.at(0.0));
  canyon::lidar::Scanner::InstancesAt instances;
  if (cars > 0) instances = [&](double after_s) { return moving.at(0.5 + after_s); };
  canyon::lidar::LidarConfig config = at_origin();
  const auto plain = *canyon::lidar::make_scanner(config, 1);
  change(config);
  const auto scanner = *canyon::lidar::make_scanner(config, 1);
  const canyon::Trajectory motion = driving();
  const double count = 1800.0 * 16.0;
  canyon::lidar::LidarOutput out;
  std::int64_t index = 0;
  side_by_side(
      state, count, [&] { scanner->scan(index++, kStart, motion, busy, instances, out); }, count,
      [&] { plain->scan(index, kStart, motion, still, out); });
  state.counters["times_plain"] = 1.0 / state.counters["share_of_bare"].value;
  state.counters.erase("share_of_bare");
  state.counters.erase("share_at_best");
  state.counters.erase("bare_Mrays_s");
}
using Config = canyon::lidar::LidarConfig;
BENCHMARK_CAPTURE(
    cost_of, footprint, [](Config& c) { c.model.name = "footprint"; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, radiometric, [](Config& c) { c.detector.name = "radiometric"; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, varied, [](Config& c) { c.texture.brightness = canyon::lidar::Brightness::kVaried; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, windows, [](Config& c) { c.texture.windows = canyon::lidar::Windows::kLattice; }, 0)
    ->UseManualTime();
/// The beam of the fidelity `high`.
BENCHMARK_CAPTURE(
    cost_of, high,
    [](Config& c) {
      c.detector.name = "radiometric";
      c.signal.reflection = canyon::lidar::MattReflection::kRough;
      c.texture = {canyon::lidar::Brightness::kVaried, canyon::lidar::Windows::kLattice};
    },
    0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, dual_returns, [](Config& c) { c.report.returns = canyon::lidar::ReturnMode::kDual; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, rain, [](Config& c) { c.weather.rain_mm_h = 10; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, fog, [](Config& c) { c.weather.fog_visibility_m = 100; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, crosstalk, [](Config& c) { c.crosstalk.probability = 1e-3; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, angle_noise, [](Config& c) { c.angle_noise_deg = 0.05; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, ego_mask,
    [](Config& c) {
      c.ego.min_m = {-1, -1, -2}, c.ego.max_m = {3, 1, -0.5};
    },
    0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, glass, [](Config& c) { c.see_through = {.panes = true}; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, leaves, [](Config& c) { c.see_through = {.leaves = true}; }, 0)
    ->UseManualTime();
BENCHMARK_CAPTURE(
    cost_of, twenty_cars, [](Config&) {}, 20)
    ->UseManualTime();

/// A drive of ten scans with two threads and with one, by the clock: the second thread is woken once.
void two_threads(benchmark::State& state) {
  const canyon::scene::SceneAt scene(city());
  canyon::lidar::LidarConfig config = at_origin();
  config.beams = "os1_128";
  config.azimuth_steps = 1024;
  const auto scanner = *canyon::lidar::make_scanner(config, 1);
  const canyon::Trajectory motion = driving();
  canyon::lidar::LidarOutput out;
  const auto seconds = [&](int threads) {
    canyon::set_threads(threads);
    timespec a{}, b{};
    clock_gettime(CLOCK_MONOTONIC, &a);
    for (int k = 0; k < 10; ++k) scanner->scan(k, kStart, motion, scene, out);
    clock_gettime(CLOCK_MONOTONIC, &b);
    return static_cast<double>(b.tv_sec - a.tv_sec) + 1e-9 * static_cast<double>(b.tv_nsec - a.tv_nsec);
  };
  double one_s = 1e9, two_s = 1e9;  // the quickest of each: the others on the machine only slow down
  for (auto _ : state) {
    one_s = std::min(one_s, seconds(1));
    two_s = std::min(two_s, seconds(2));
    state.SetIterationTime(two_s);
  }
  state.counters["speed_up"] = one_s / two_s;
}
BENCHMARK(two_threads)->UseManualTime();

}  // namespace
