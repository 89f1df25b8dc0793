#include "canyon/study/registration_error/response/error_response.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "canyon/core/config/text.h"
#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/lidar/scanner.h"
#include "canyon/study/registration_error/response/half_healed.h"
#include "canyon/study/registration_error/scan_error.h"
#include "canyon/study/statistics/cluster_bootstrap.h"

namespace canyon::study {
namespace {

/// A kind along an axis, and where its sizes stand in the list of errors.
struct ErrorSweep {
  const ModelRow<EstimateErrorKind>* kind;
  std::size_t axis, first;
  std::vector<double> sizes;
};
/// All that is replayed: errors.front() is none.
struct ResponsePlan {
  std::vector<EstimateError> errors{{}};
  std::vector<ErrorSweep> sweeps;
};

ResponsePlan response_plan(const ErrorResponseOptions& options) {
  ResponsePlan out;
  for (const auto& row : estimate_errors()) {
    const auto& chosen = options.errors;
    if (!chosen.empty() && std::find(chosen.begin(), chosen.end(), row.name) == chosen.end()) continue;
    std::vector<double> sizes = options.sizes.empty() ? row.make.usual_sizes() : options.sizes;
    std::sort(sizes.begin(), sizes.end());
    for (std::size_t axis = 0; axis < (row.make.by_axis ? 3U : 1U); ++axis) {
      out.sweeps.push_back({&row, axis, out.errors.size(), sizes});
      for (const double size : sizes) out.errors.push_back({&row, axis, size});
    }
  }
  return out;
}

/// By method, error, place, seed.
class ResponseSums {
 public:
  ResponseSums(std::size_t methods, std::size_t errors, std::size_t seeds)
      : errors_(errors), seeds_(seeds), by_place_(methods * errors) {}

  void add(std::size_t method, std::size_t error, std::size_t seed, double from_m, const PlacedSums& sums) {
    auto& seeds = by_place_[method * errors_ + error][from_m];
    seeds.resize(seeds_);
    seeds[seed] += sums;
  }
  using ByPlace = std::map<double, std::vector<PlacedSums>>;
  const ByPlace& of(std::size_t method, std::size_t error) const { return by_place_[method * errors_ + error]; }

 private:
  std::size_t errors_, seeds_;
  std::vector<ByPlace> by_place_;
};

/// One seed, ready to be replayed.
struct RecordedSeed {
  std::uint64_t seed;
  RecordedKeyframes recorded;
  std::vector<std::vector<Eigen::Vector3f>> points;
  std::vector<MethodClouds> methods;
  std::vector<Stretch> places;
};

Result<RecordedSeed> record_seed(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                 const Tape& tape, const ErrorResponseOptions& options) {
  RecordedSeed out{
      .seed = static_cast<std::uint64_t>(config.run.seed), .recorded = {}, .points = {}, .methods = {}, .places = {}};
  CANYON_TRY(out.recorded, record_keyframes(config, mission, tape));
  for (const RecordedKeyframe& keyframe : out.recorded.keyframes)
    out.points.push_back(sampled_points(keyframe.scan, config.run.map_range_m));
  for (const std::string& method : options.methods) {
    CANYON_TRY(MethodClouds clouds, prepare_clouds(out.recorded, config.registration, method));
    out.methods.push_back(std::move(clouds));
  }
  out.places =
      stretches(out.recorded, options.stretch_m, static_cast<std::size_t>(config.registration.submap_keyframes));
  return out;
}

void replay_seed(const RecordedSeed& seed, std::size_t index, const ResponsePlan& plan, const Pose& X_BL,
                 const scene::Scene& scene, Progress& progress, ResponseSums& sums) {
  const std::size_t places = seed.places.size(), errors = plan.errors.size();
  std::vector<PlacedSums> slots(seed.methods.size() * errors * places);
  parallel_for(slots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      slots[i] = replay_mapper(seed.recorded, seed.points, seed.methods[i / places / errors], X_BL,
                               seed.places[i % places], plan.errors[i / places % errors], seed.seed, scene);
      progress.advance(1.0 / static_cast<double>(slots.size()));
    }
  });
  for (std::size_t i = 0; i < slots.size(); ++i)
    sums.add(i / places / errors, i / places % errors, index, seed.places[i % places].from_m, slots[i]);
}

/// What is healed of keyframes, and of the map.
struct HealedShares {
  double keyframe, map;
};
HealedShares healed_shares(const PlacedSums& sums) {
  return {1.0 - std::sqrt(sums.keyframe_registered_m2 / sums.keyframe_prior_m2),
          1.0 - std::sqrt(sums.map_registered_m2 / sums.map_prior_m2)};
}

/// By size, then by cluster.
using ClusteredSums = std::vector<std::vector<PlacedSums>>;

PlacedSums weighed(const std::vector<PlacedSums>& clusters, std::span<const double> times) {
  PlacedSums out;
  for (std::size_t c = 0; c < clusters.size(); ++c)
    for (double k = 0.0; k < times[c]; k += 1.0) out += clusters[c];
  return out;
}

/// Shares of the keyframes by size, of the map by size, and up to where each is half.
std::vector<double> response_statistics(const std::vector<double>& sizes, const ClusteredSums& sums,
                                        std::span<const double> times) {
  std::vector<double> keyframe, map;
  for (const auto& clusters : sums) {
    const HealedShares shares = healed_shares(weighed(clusters, times));
    keyframe.push_back(shares.keyframe);
    map.push_back(shares.map);
  }
  std::vector<double> out = keyframe;
  out.insert(out.end(), map.begin(), map.end());
  out.push_back(half_healed_size(sizes, keyframe));
  out.push_back(half_healed_size(sizes, map));
  return out;
}

void fill_curve(const ErrorSweep& sweep, const ClusteredSums& sums, std::uint64_t seed, ResponseCurve& curve) {
  const std::size_t clusters = sums.front().size(), n = sweep.sizes.size();
  const auto statistics = [&](std::span<const double> times) { return response_statistics(sweep.sizes, sums, times); };
  const std::vector<double> once(clusters, 1.0), values = statistics(once);
  const std::vector<Interval> intervals = cluster_bootstrap(clusters, seed, statistics);
  for (std::size_t i = 0; i < n; ++i) {
    const PlacedSums all = weighed(sums[i], once);
    const auto rms = [&](double sum_m2) { return std::sqrt(sum_m2 / all.count); };
    const double unaligned = all.unaligned / all.count;
    curve.keyframe.push_back({sweep.sizes[i],
                              rms(all.keyframe_prior_m2),
                              rms(all.keyframe_registered_m2),
                              {values[i], intervals[i]},
                              unaligned});
    curve.map.push_back({sweep.sizes[i],
                         rms(all.map_prior_m2),
                         rms(all.map_registered_m2),
                         {values[n + i], intervals[n + i]},
                         unaligned});
  }
  curve.keyframe_half = {values[2 * n], intervals[2 * n]};
  curve.map_half = {values[2 * n + 1], intervals[2 * n + 1]};
}

PlacedSums together(const std::vector<PlacedSums>& seeds) {
  PlacedSums out;
  for (const PlacedSums& seed : seeds) out += seed;
  return out;
}

/// Everywhere first, then place by place.
std::vector<ResponseCurve> curves_of(const ResponseSums& sums, std::size_t method, const std::string& name,
                                     const ErrorSweep& sweep, std::uint64_t seed) {
  const std::string axis = sweep.kind->make.by_axis ? axis_name(sweep.axis) : "";
  ResponseCurve all{.method = name,
                    .kind = sweep.kind->name,
                    .axis = axis,
                    .from_m = {},
                    .keyframe = {},
                    .map = {},
                    .keyframe_half = {},
                    .map_half = {}};
  ClusteredSums by_place;
  for (std::size_t i = 0; i < sweep.sizes.size(); ++i) {
    by_place.emplace_back();
    for (const auto& [from_m, seeds] : sums.of(method, sweep.first + i)) by_place.back().push_back(together(seeds));
  }
  fill_curve(sweep, by_place, seed, all);
  std::vector<ResponseCurve> out{all};
  for (const auto& [from_m, first] : sums.of(method, sweep.first)) {
    ResponseCurve place{.method = name,
                        .kind = sweep.kind->name,
                        .axis = axis,
                        .from_m = from_m,
                        .keyframe = {},
                        .map = {},
                        .keyframe_half = {},
                        .map_half = {}};
    ClusteredSums by_seed;
    for (std::size_t i = 0; i < sweep.sizes.size(); ++i) by_seed.push_back(sums.of(method, sweep.first + i).at(from_m));
    fill_curve(sweep, by_seed, seed, place);
    out.push_back(std::move(place));
  }
  return out;
}

UndisturbedError undisturbed_of(const ResponseSums& sums, std::size_t method, const std::string& name) {
  PlacedSums all;
  for (const auto& [from_m, seeds] : sums.of(method, 0)) all += together(seeds);
  const auto rms = [&](double sum_m2) { return std::sqrt(sum_m2 / all.count); };
  return {name, rms(all.keyframe_registered_m2), rms(all.map_registered_m2), rms(all.map_prior_m2)};
}

/// That this build has the methods.
Status check_built_in(lidar::RegistrationConfig config, const std::vector<std::string>& methods) {
  for (const std::string& method : methods) {
    config.method.name = method;
    if (const auto made = lidar::make_registration(config); !made) return made.error();
  }
  return Ok{};
}

}  // namespace

Status check_response(const ErrorResponseOptions& options) {
  for (const std::string& method : options.methods)
    CANYON_TRY_STATUS(choose(lidar::registration_methods(), method, "--methods"));
  for (const std::string& error : options.errors) CANYON_TRY_STATUS(choose(estimate_errors(), error, "--errors"));
  return Ok{};
}

Result<ErrorResponse> measure_error_response(const mission::MissionConfig& config,
                                             const mission::PreparedMission& mission, const Tape& tape,
                                             const ErrorResponseOptions& options) {
  CANYON_TRY_STATUS(check_response(options));
  CANYON_TRY_STATUS(check_built_in(config.registration, options.methods));
  CpuAccount cpu;
  const ChargeCpu charge(&cpu);
  const ResponsePlan plan = response_plan(options);
  const auto seeds = static_cast<std::size_t>(options.seeds);
  ResponseSums sums(options.methods.size(), plan.errors.size(), seeds);
  Progress progress("mapping " + std::to_string(plan.errors.size()) + " errors of " + std::to_string(seeds) + " runs",
                    static_cast<double>(seeds), options.show_progress);
  const Pose X_BL = lidar::sensor_in_body(config.lidar);
  double recording_s = 0.0;  // charged to the runs' own accounts
  for (std::size_t s = 0; s < seeds; ++s) {
    mission::MissionConfig own = config;
    own.run.seed += static_cast<std::int64_t>(s);
    CANYON_TRY(const RecordedSeed seed, record_seed(own, mission, tape, options));
    if (seed.places.empty())
      return Error{.file = "--stretch",
                   .what = number_text(options.stretch_m) + " m: the route has no place of " +
                           std::to_string(kFewestInStretch) + " keyframes behind its first " +
                           std::to_string(config.registration.submap_keyframes),
                   .expected = "a longer route, or another length"};
    recording_s += seed.recorded.cpu_s;
    replay_seed(seed, s, plan, X_BL, *mission.scene, progress, sums);
  }
  ErrorResponse out{.mission = config.run.name,
                    .fidelity = options.fidelity,
                    .tape = tape.source,
                    .seed = config.run.seed,
                    .seeds = options.seeds,
                    .stretch_m = options.stretch_m,
                    .places_from_m = {},
                    .undisturbed = {},
                    .curves = {}};
  for (const auto& [from_m, unused] : sums.of(0, 0)) out.places_from_m.push_back(from_m);
  for (std::size_t m = 0; m < options.methods.size(); ++m) {
    out.undisturbed.push_back(undisturbed_of(sums, m, options.methods[m]));
    for (const ErrorSweep& sweep : plan.sweeps)
      for (ResponseCurve& curve :
           curves_of(sums, m, options.methods[m], sweep, static_cast<std::uint64_t>(config.run.seed)))
        out.curves.push_back(std::move(curve));
  }
  out.cpu_s = recording_s + cpu.seconds();
  return out;
}

}  // namespace canyon::study
