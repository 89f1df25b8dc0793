// Propagation paths of one epoch, one thread, 40 satellites spread over the sky above 5 degrees, at street level along
// the streets: each model beside the bare occlusion rays that it traces (the same number, towards the satellites), and
// against the number of buildings at the same density. Beside the built-in city: Shibuya, of the recordings in the
// folder that CANYON_TEST_DATA names, else in ../shared/data beside the checkout.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <vector>

#include <benchmark/benchmark.h>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/diffraction/diffraction.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/paths/propagation.h"
#include "canyon/gnss/sensor/pseudorange_parts.h"
#include "canyon/gnss/sensor/receiver_catalogue.h"
#include "canyon/gnss/sensor/satellites_in_view.h"
#include "canyon/gnss/signal.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/import.h"
#include "canyon/scene/scene_at.h"

namespace {

using canyon::gnss::GnssCounters;
using canyon::gnss::PathModel;
using canyon::gnss::PlaneWaves;
using canyon::gnss::SignalPaths;

const canyon::scene::Scene& city(double extent_m) {
  static std::map<double, std::unique_ptr<canyon::scene::Scene>> cities;
  auto& scene = cities[extent_m];
  if (!scene) {
    canyon::scene::CityConfig config;
    config.extent_m = extent_m;
    if (extent_m > 1500.0) config.terrain_cell_m = 10.0;  // memory
    scene = std::make_unique<canyon::scene::Scene>(canyon::scene::make_city(config));
    (void)scene->facets();
    (void)scene->edges();
  }
  return *scene;
}

/// Null, having said so, where its files are not at hand.
const canyon::scene::Scene* shibuya(benchmark::State& state) {
  static const auto made = []() -> std::unique_ptr<canyon::scene::Scene> {
    namespace fs = std::filesystem;
    const char* configured = std::getenv("CANYON_TEST_DATA");
    const fs::path data =
        configured != nullptr ? fs::path(configured) : fs::path(CANYON_SOURCE_DIR).parent_path() / "shared" / "data";
    const fs::path folder = data / "scenes" / "shibuya";
    canyon::scene::ImportConfig config;
    config.file = folder / "shibuya_buildings_lod1_epsg6668.geojson";
    config.more_files = {folder / "shibuya_bridges_lod2_epsg6668.geojson"};
    config.undulation_m = 36.7;
    if (!fs::exists(config.file)) return nullptr;
    auto read = import_scene(config, {});
    if (!read.ok()) return nullptr;
    auto scene = std::make_unique<canyon::scene::Scene>(std::move(read->parts));
    (void)scene->facets();
    (void)scene->edges();
    return scene;
  }();
  if (made == nullptr) state.SkipWithError("the recordings' scenes/shibuya cannot be read (set CANYON_TEST_DATA)");
  return made.get();
}

/// Evenly over the sky (Fibonacci spiral).
std::vector<Eigen::Vector3d> satellites(int count = 40) {
  const double lowest = std::sin(5.0 * canyon::kDegree), turn_rad = canyon::kPi * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < count; ++i) {
    const double z = lowest + (1.0 - lowest) * (i + 0.5) / count, r = std::sqrt(1.0 - z * z);
    out.emplace_back(r * std::cos(turn_rad * i), r * std::sin(turn_rad * i), z);
  }
  return out;
}

/// Antenna 1.5 m above the middle of the way that the built-in mission drives: along the shortest way over the streets
/// from corner to corner, within 400 m of the middle of the city.
std::vector<Eigen::Vector3d> street_points(const canyon::scene::Scene& scene) {
  const auto route = scene.streets().route({-350.0, -350.0}, {350.0, 350.0});
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const double length_m = (route[i + 1] - route[i]).norm();
    for (double at_m = 0.0; at_m < length_m; at_m += 20.0) {
      const Eigen::Vector2d xy = route[i] + at_m / length_m * (route[i + 1] - route[i]);
      if (const auto ground = scene.ground(xy.x(), xy.y()))
        out.emplace_back(xy.x() + 2.0, xy.y() + 2.0, ground->height_m + 1.5);
    }
  }
  return out;
}

double extent_of(const benchmark::State& state) {
  return static_cast<double>(state.range(0));
}

void bare_rays(benchmark::State& state) {
  const canyon::scene::Scene& scene = city(extent_of(state));
  const canyon::scene::SceneAt at(scene);
  const auto sky = satellites();
  const auto points = street_points(scene);
  std::size_t k = 0;
  for (auto _ : state) {
    const Eigen::Vector3d& p = points[k++ % points.size()];
    for (const auto& s : sky) benchmark::DoNotOptimize(at.blocked_towards(p, s));
  }
  state.counters["rays"] = static_cast<double>(sky.size());
  state.counters["buildings"] = static_cast<double>(scene.buildings().size());
}

void model(benchmark::State& state, const char* paths, const char* diffraction, bool ground) {
  const canyon::scene::Scene& scene = city(extent_of(state));
  const canyon::scene::SceneAt at(scene);
  const auto sky = satellites();
  const auto points = street_points(scene);
  const canyon::gnss::PathParameters p;
  std::unique_ptr<PathModel> tracer = find_model(canyon::gnss::path_models(), paths)->make({}, p);
  if (ground || std::string(diffraction) != "none")
    tracer = make_propagation(std::move(tracer),
                              find_model(canyon::gnss::diffraction_models(), diffraction)->make({}, p), ground, p);
  std::vector<SignalPaths> out(sky.size());
  GnssCounters counters;
  std::size_t k = 0;
  for (auto _ : state) {
    tracer->trace(points[k++ % points.size()], sky, at, out, counters);
    benchmark::DoNotOptimize(out.data());
  }
  const auto epochs = static_cast<double>(state.iterations());
  state.counters["rays"] = static_cast<double>(counters.occlusion_rays) / epochs;
  state.counters["echoes"] = static_cast<double>(counters.reflected_paths + counters.diffracted_paths) / epochs;
  state.counters["buildings"] = static_cast<double>(scene.buildings().size());
}

/// Every 2.5 m along straight legs.
std::vector<Eigen::Vector3d> way_of(const std::vector<Eigen::Vector3d>& corners) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector3d leg = corners[i + 1] - corners[i];
    for (double f = 0.0; f < 1.0; f += 2.5 / leg.norm()) points.emplace_back(corners[i] + f * leg);
  }
  return points;
}

/// Antenna 1.5 m above the way of missions/delivery/shibuya.toml.
std::vector<Eigen::Vector3d> shibuya_way(const canyon::scene::Scene& scene) {
  std::vector<Eigen::Vector2d> nodes;
  const Eigen::Vector2d stops[] = {{-135.0, 129.0}, {-16.0, 52.0}, {13.0, 126.0}};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto leg = scene.streets().route(stops[i], stops[i + 1]);
    nodes.insert(nodes.end(), leg.begin(), leg.end());
  }
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector2d& xy : nodes) {
    const auto ground = scene.ground(xy.x(), xy.y());
    const Eigen::Vector3d corner(xy.x(), xy.y(), ground ? ground->height_m + 1.5 : 0.0);
    if (ground && (corners.empty() || (corner - corners.back()).norm() > 1.0)) corners.push_back(corner);
  }
  return way_of(corners);
}

/// As a receiver meets it on the way, every 2.5 m (5 m/s, 2 Hz): what a drive remembers from epoch to epoch counts.
void drive(benchmark::State& state, const canyon::scene::Scene& scene, const std::vector<Eigen::Vector3d>& points,
           const PathModel& tracer, const PlaneWaves& waves) {
  const canyon::scene::SceneAt at(scene);
  std::vector<SignalPaths> out(waves.size());
  GnssCounters counters;
  // What is made once for a scene.
  if (!points.empty()) tracer.trace(points[0], waves, at, out, counters);
  counters = {};
  std::size_t k = 0;
  double echoes = 0.0;
  for (auto _ : state) {
    const std::size_t now = k++;
    tracer.trace(points[now % points.size()], waves.at(waves.t() + 0.5 * static_cast<double>(now)), at, out, counters);
    for (const SignalPaths& one : out) echoes += static_cast<double>(one.echoes.size());
  }
  const auto epochs = static_cast<double>(state.iterations());
  state.counters["rays"] = static_cast<double>(counters.occlusion_rays) / epochs;
  state.counters["echoes"] = echoes / epochs;
  state.counters["signals"] = static_cast<double>(waves.size());
  state.counters["buildings"] = static_cast<double>(scene.buildings().size());
}

/// Second order, with what else is named.
canyon::gnss::PropagationConfig second_order(const char* diffraction, const char* scatter, const char* clutter,
                                             bool borders) {
  canyon::gnss::PropagationConfig config;
  config.paths.name = "specular2";
  config.diffraction.name = diffraction;
  config.scatter.name = scatter;
  config.clutter.name = clutter;
  config.reflection_borders = borders;
  return config;
}

/// Of a receiver of 28 dB-Hz, at L1.
void drive(benchmark::State& state, const canyon::scene::Scene& scene, const std::vector<Eigen::Vector3d>& points,
           const std::vector<Eigen::Vector3d>& sky, const char* diffraction, const char* scatter, const char* clutter,
           bool borders) {
  canyon::gnss::PathParameters p;
  p.weakest_nlos_db = -17.0;
  const auto tracer = *make_propagation(second_order(diffraction, scatter, clutter, borders), p);
  drive(state, scene, points, *tracer, sky);
}

void channel(benchmark::State& state, const char* diffraction, const char* scatter, const char* clutter,
             bool borders = false) {
  const canyon::scene::Scene& scene = city(extent_of(state));
  drive(state, scene, way_of(street_points(scene)), satellites(), diffraction, scatter, clutter, borders);
}

/// All that `high` and `modern` ask of the channel, of a receiver of the catalogue and as its sensor asks it: down to
/// what is tracked and as late as its correlator hears; all first signals and, of a receiver of two bands, all second
/// ones in one search. The built-in satellites above its mask, as they stand when the built-in mission starts.
void channel_of(benchmark::State& state, const char* receiver) {
  const canyon::scene::Scene& scene = city(extent_of(state));
  const auto points = way_of(street_points(scene));
  const auto sheet = canyon::gnss::load_receiver(receiver);
  canyon::gnss::GnssConfig config;
  if (!sheet || !read_config(&sheet->figures, "", config)) return state.SkipWithError("the receiver cannot be read");
  config.propagation = second_order("wedge", "directive", "street", true);
  config.reception.multipath_rule.name = "correlator";
  const auto start = canyon::GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
  const auto parts = *canyon::gnss::make_pseudorange_parts({config, 1, start, start + 3600.0, scene, 1});

  const Eigen::Vector3d p_E = scene.frame().to_E(points.front());
  canyon::gnss::SatellitesInView in_view(parts.constellation, scene.frame(), config.mask_deg * canyon::kDegree);
  const auto sights = in_view.at(start, start, p_E, canyon::gnss::Horizon(p_E));
  std::vector<Eigen::Vector3d> sky;
  std::vector<double> carriers_hz;
  const auto add = [&](const auto& band_of) {
    for (const canyon::gnss::Sight& s : sights) {
      sky.push_back(s.direction_W);
      carriers_hz.push_back(s.carrier_hz(band_of(s.sv.system)));
    }
  };
  add(canyon::gnss::first_band);
  if (parts.mode->dual_frequency())
    add([&](canyon::GnssSystem system) { return second_band(system, config.tracking.second_frequency); });
  drive(state, scene, points, *parts.paths, PlaneWaves(sky, carriers_hz).at(start));
}

/// 45 satellites: as many as five systems show at once in the open.
void channel_in_shibuya(benchmark::State& state, const char* diffraction, const char* scatter, const char* clutter,
                        bool borders = false) {
  if (const canyon::scene::Scene* scene = shibuya(state))
    drive(state, *scene, shibuya_way(*scene), satellites(45), diffraction, scatter, clutter, borders);
}

void bare_rays_in_shibuya(benchmark::State& state) {
  const canyon::scene::Scene* scene = shibuya(state);
  if (scene == nullptr) return;
  const canyon::scene::SceneAt at(*scene);
  const auto sky = satellites(45);
  const auto points = shibuya_way(*scene);
  std::size_t k = 0;
  for (auto _ : state) {
    const Eigen::Vector3d& p = points[k++ % points.size()];
    for (const auto& s : sky) benchmark::DoNotOptimize(at.blocked_towards(p, s));
  }
}

// 370 (the built-in city), 1052, 3740 and 13,402 buildings.
void larger_cities(benchmark::internal::Benchmark* b) {
  for (const int extent_m : {1000, 1600, 2800, 5200}) b->Arg(extent_m);
}

// 240, and those.
void cities(benchmark::internal::Benchmark* b) {
  b->Arg(800)->Apply(larger_cities)->Unit(benchmark::kMicrosecond);
}

// The ways are 606 to 644 epochs long: as much of each, for what a drive remembers grows along it.
void whole_ways(benchmark::internal::Benchmark* b) {
  b->Apply(larger_cities)->Iterations(600);
}

BENCHMARK(bare_rays)->Name("paths/bare_rays")->Apply(cities);
BENCHMARK_CAPTURE(model, visibility, "visibility", "none", false)->Name("paths/visibility")->Apply(cities);
BENCHMARK_CAPTURE(model, specular1, "specular1", "none", false)->Name("paths/specular1")->Apply(cities);
BENCHMARK_CAPTURE(model, specular2, "specular2", "none", false)->Name("paths/specular2")->Apply(cities);
BENCHMARK_CAPTURE(model, specular3, "specular3", "none", false)
    ->Name("paths/specular3")
    ->Arg(1000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(model, all, "specular1", "double_knife_edge", true)
    ->Name("paths/specular1+double_knife_edge+ground")
    ->Arg(1000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(channel, mirrors, "none", "none", "none")->Name("channel/mirrors")->Arg(1000);
BENCHMARK_CAPTURE(channel, wedge, "wedge", "none", "none")->Name("channel/wedge")->Arg(1000);
BENCHMARK_CAPTURE(channel, borders, "wedge", "none", "none", true)->Name("channel/wedge+borders")->Arg(1000);
BENCHMARK_CAPTURE(channel, scatter, "wedge", "directive", "none")->Name("channel/wedge+directive")->Arg(1000);
BENCHMARK_CAPTURE(channel, street, "wedge", "directive", "street")->Name("channel/wedge+directive+street")->Arg(1000);
BENCHMARK_CAPTURE(channel, street_borders, "wedge", "directive", "street", true)
    ->Name("channel/wedge+directive+street+borders")
    ->Apply(whole_ways);
BENCHMARK_CAPTURE(channel, scatter_borders, "wedge", "directive", "none", true)
    ->Name("channel/wedge+directive+borders")
    ->Apply(whole_ways);
BENCHMARK_CAPTURE(channel_of, high, "dgps_2010")->Name("channel/high")->Arg(1000)->Iterations(600);
BENCHMARK_CAPTURE(channel_of, modern, "f9p")->Name("channel/modern")->Arg(1000)->Iterations(600);
BENCHMARK_CAPTURE(channel, scatter_wide, "wedge", "directive", "none")->Name("channel/wedge+directive")->Arg(5200);
BENCHMARK(bare_rays_in_shibuya)->Name("shibuya/bare_rays")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(channel_in_shibuya, scatter, "wedge", "directive", "none")->Name("shibuya/wedge+directive");
BENCHMARK_CAPTURE(channel_in_shibuya, street, "wedge", "directive", "street")->Name("shibuya/wedge+directive+street");
BENCHMARK_CAPTURE(channel_in_shibuya, scatter_borders, "wedge", "directive", "none", true)
    ->Name("shibuya/wedge+directive+borders");
BENCHMARK_CAPTURE(channel_in_shibuya, street_borders, "wedge", "directive", "street", true)
    ->Name("shibuya/wedge+directive+street+borders");
BENCHMARK_CAPTURE(model, launching, "launching", "none", false)
    ->Name("paths/launching")
    ->Arg(1000)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
