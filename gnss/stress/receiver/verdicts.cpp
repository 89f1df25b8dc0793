// What a receiver says of a route before anything is received: what it needs, and what may be left out.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/need/path_question.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/gnss/stress/level_ground.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// Every set of verdicts: what may be left out is just what is not needed; of walls as many as the most that is, where
/// the model speaks of them.
StressFigure verdicts() {
  int wrong = 0;
  const char* const effects[] = {kOcclusion, kFoliage, kDiffraction, kReflections[0], kReflections[1], kReflections[2]};
  for (int set = 0; set < 729; ++set) {
    std::vector<Need> needs;
    int rest = set, of[6];
    for (int i = 0; i < 6; ++i, rest /= 3) {
      of[i] = rest % 3;  // not stated, needed, not needed
      if (of[i] > 0)
        needs.push_back({.effect = effects[i], .verdict = of[i] == 1 ? Verdict::kUndecidable : Verdict::kNotNeeded});
    }
    const PathOmissions out = omissions_of(needs);
    wrong += out.occlusion == (of[0] == 2) && out.foliage == (of[1] == 2) && out.diffraction == (of[2] == 2) ? 0 : 1;
    int most = PathOmissions{}.most_reflections;
    for (int k = 3; k >= 1; --k) {
      if (of[2 + k] == 1) break;
      if (of[2 + k] == 2) most = k - 1;
    }
    wrong += out.most_reflections == most ? 0 : 1;
  }
  const char* const delays[] = {kIonosphere, kIonosphereDifference, kTroposphere, kTroposphereDifference, kEphemeris};
  for (int set = 0; set < 32; ++set) {
    std::vector<Need> needs;
    for (int i = 0; i < 5; ++i)
      needs.push_back({.effect = delays[i], .verdict = (set >> i & 1) != 0 ? Verdict::kNotNeeded : Verdict::kNeeded});
    const DelayOmissions out = delays_of(needs);
    wrong += out.ionosphere == ((set & 1) != 0) && out.ionosphere_difference == ((set & 2) != 0) &&
                     out.troposphere == ((set & 4) != 0) && out.troposphere_difference == ((set & 8) != 0) &&
                     out.ephemeris == ((set & 16) != 0)
                 ? 0
                 : 1;
  }
  GnssConfig config;
  for (const double zenith : {40.0, 45.0, 52.0}) {
    config.link.cn0_zenith_dbhz = zenith, config.locks.tracking_threshold_dbhz = 23.0;
    const PathParameters limits = path_limits(config);
    wrong += limits.weakest_nlos_db == 23.0 - zenith && limits.weakest_db == std::min(-20.0, 23.0 - zenith) ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// Numbers in a sentence.
std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> out;
  for (std::size_t i = 0; i < text.size();) {
    if ((text[i] >= '0' && text[i] <= '9') ||
        (text[i] == '-' && i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9')) {
      std::size_t used = 0;
      out.push_back(std::stod(text.substr(i), &used));
      i += used;
    } else {
      ++i;
    }
  }
  return out;
}

/// What a sensor says of a piece of a route, by balls and angles written out: the horizon against the lowest satellite,
/// with the antenna as low as a tilted body may have it; crowns and edges by a ball about each; in its sentences the
/// same numbers.
StressFigure route_needs() {
  Looks looks;
  const RandomStream draws(3, "stress.asked");
  int open = 0, hidden = 0, leafy = 0, edged = 0;
  for (std::uint64_t k = 0; k < 24; ++k) {
    scene::SceneParts parts = level_ground("asked", 300.0, 0.0);
    scene::MeshBuilder mesh(parts);
    mesh.begin_object("house", scene::ObjectKind::kBuilding);
    const double away = draws.uniform(40.0, 250.0, 0, k), height = draws.uniform(2.0, 40.0, 1, k);
    mesh.box({away, 0.0, 0.5 * height}, Eigen::Matrix3d::Identity(), {5.0, 6.0, 0.5 * height},
             mesh.material("concrete"));
    parts.foliage.push_back(
        {{draws.uniform(-60, 60, 2, k), draws.uniform(-60, 60, 3, k), draws.uniform(3.0, 30.0, 4, k)},
         {1.0, 2.0, 1.5}});
    const scene::Scene place(std::move(parts));
    GnssConfig config;
    config.mask_deg = draws.uniform(5.0, 25.0, 5, k);
    config.lever_arm_m = {draws.uniform(-1.0, 1.0, 6, k), draws.uniform(-0.5, 0.5, 7, k),
                          draws.uniform(0.5, 2.0, 8, k)};
    config.propagation.diffraction = ModelChoice<diffraction_models>(k % 2 == 0 ? "knife_edge" : "wedge");
    RouteSegment segment;
    segment.points_W = {{-3.0, 1.0, 0.0}, {4.0, 5.0, 0.0}};
    segment.half_width_m = 1.5, segment.low_m = 0.0, segment.high_m = 0.6;
    const GpsTime start = GpsTime::from_week_sow(1600, 9000.0 + 1000.0 * static_cast<double>(k));
    const auto around = GnssSurroundings::make(config, place, {}, start, start + 120.0, {segment});
    if (!around.ok()) return {stress::kInfinity, 1.0};
    looks.right(around->low_m == 0.0 && around->start == start);
    // A ball about the whole route, and twice the width and lever over it.
    const Vector3d low(-3.0, 1.0, 0.0), high(4.0, 5.0, 0.6);
    const Ball all{0.5 * (low + high), 0.5 * (high - low).norm() + 2.0 * (config.lever_arm_m.norm() + 1.5)};
    const auto sky = make_nominal(config.satellites.systems);
    const SkySpan span = sky_span(*sky, place.frame(), start, start + 120.0, all, config.mask_deg * kDegree);
    looks.near(around->sky.lowest_rad, span.lowest_rad, 1e-12),
        looks.near(around->sky.spread_rad, span.spread_rad, 1e-12);
    looks.right(around->sky.directions.size() == span.directions.size());
    const auto needs = gnss_needs(config, *around, segment);
    looks.right(needs.size() >= 4);
    const double reach_m = config.lever_arm_m.norm();
    const double tilted_m =
        config.lever_arm_m.z() * std::cos(0.45) - config.lever_arm_m.head<2>().norm() * std::sin(0.45);
    const double horizon = ObstacleHeights(place).horizon_rad(segment, tilted_m, reach_m);
    // The antenna wherever it may be: half the room's diagonal, widened level, and the lever.
    const double wide = 0.5 * std::hypot(7.0, 4.0) + 1.5;
    const Ball antenna{0.5 * (low + high), std::hypot(wide, 0.3) + reach_m};
    for (const Need& need : needs) {
      const auto told = numbers_in(need.reason);
      if (need.effect == kOcclusion) {
        looks.right((need.verdict == Verdict::kNotNeeded) == (horizon < span.lowest_rad));
        (need.verdict == Verdict::kNotNeeded ? open : hidden) += 1;
        if (told.size() == 2) {
          looks.near(told[0], horizon * 180.0 / kPi, 0.051), looks.near(told[1], span.lowest_rad * 180.0 / kPi, 0.051);
        }
      } else if (need.effect == kFoliage) {
        const bool seen = span.through(antenna, {place.foliage()[0].center_W, 2.0}).has_value();
        looks.right((need.verdict == Verdict::kNotNeeded) == !seen);
        leafy += seen ? 1 : 0;
      } else if (need.effect == kDiffraction) {
        bool bends = false;
        const PathParameters limits = path_limits(config);
        const double weakest =
            k % 2 == 0 ? limits.weakest_nlos_db : std::min(limits.weakest_db, limits.weakest_nlos_db) - 6.0;
        const double detour = largest_detour_m(largest_knife_edge_nu(weakest), 0.26);
        for (const scene::Edge& edge : place.edges().edges()) {
          const Vector3d middle = 0.5 * (edge.a_W + edge.b_W);
          const double half = 0.5 * (edge.a_W - edge.b_W).norm(), off = (middle - antenna.center_W).norm();
          const double beside = k % 2 == 0 ? std::sqrt(2.0 * detour * (off + half + antenna.radius_m))
                                           : 1.1 * (off + antenna.radius_m) *
                                                 std::sqrt(2.0 * detour / worse(off - half - antenna.radius_m, 0.1));
          bends = bends || span.through(antenna, {middle, half + beside}).has_value();
        }
        looks.right((need.verdict == Verdict::kNotNeeded) == !bends);
        edged += bends ? 1 : 0;
      } else if (need.effect == kReflections[0] && need.verdict != Verdict::kNotNeeded) {
        looks.right(need.reason.find("house") != std::string::npos && told.size() >= 2);
        // Of a wall of concrete between all and a hundredth of a field.
        if (told.size() >= 2) looks.right(told.back() <= 0.0 && told.back() >= -40.0);
      }
    }
  }
  looks.right(open > 2 && hidden > 2 && leafy > 2 && edged > 2);
  return looks.figure();
}

/// What a differential receiver lets through of each delay, whatever else is configured: its bound by the models'
/// largest; not to be decided where ranges are weighted by it or a filter tests them; silent of what there is not.
StressFigure range_needs() {
  Looks looks;
  const scene::Scene place(level_ground("asked", 100.0, 0.0));
  const GpsTime start = GpsTime::from_week_sow(1600, 9000.0);
  RouteSegment segment;
  segment.points_W = {{0.0, 0.0, 0.0}};
  for (const std::string weighting : {"elevation", "budget"})
    for (const bool kalman : {false, true})
      for (const std::string ionosphere : {"none", "single_layer", "klobuchar"}) {
        GnssConfig config;
        config.mask_deg = 12.0;
        config.ionosphere = ModelChoice<ionosphere_models>(ionosphere);
        config.position.weighting = ModelChoice<range_weightings>(weighting);
        config.position.estimator = kalman ? Estimator::kKalman : Estimator::kLeastSquares;
        const auto around = GnssSurroundings::make(config, place, {}, start, start + 60.0, {segment});
        if (!around.ok()) return {stress::kInfinity, 1.0};
        const auto needs = gnss_range_needs(config, *around);
        const SkyView lowest{start, geodetic_from_ecef(place.frame().to_E({0.0, 0.0, 0.0})), 12.0 * kDegree, 0.0};
        const double wet = niell_wet(lowest.elevation_rad, lowest.receiver.lat_rad);
        std::map<std::string, double> expected;
        const auto late = [](double delay_m) { return delay_m * 1100.0 / kSpeedOfLight + 1e-7; };
        if (ionosphere == "single_layer") expected[kIonosphere] = late(make_single_layer(12.0)->delay_m(lowest));
        if (ionosphere != "none")
          expected[kIonosphereDifference] =
              6.5 * 2e-3 * 5.0 * 1.02 * single_layer_obliquity(lowest.elevation_rad) + 1e-7;
        expected[kTroposphere] = late(1.01 * make_saastamoinen_niell(SiteWeather{}.measured)->delay_m(lowest));
        expected[kTroposphereDifference] = 6.5 * 1e-3 * 5.0 * wet + 1e-7;
        expected[kEphemeris] = late(6.5) + 6.5 * 5e3 / 1.8e7;
        looks.right(needs.size() == expected.size());
        for (const Need& need : needs) {
          const auto at = expected.find(need.effect);
          looks.right(at != expected.end() && need.bound_unit == "m");
          if (at == expected.end()) continue;
          looks.near(need.bound, at->second, 64.0 * kEpsilon * at->second);
          const bool of_ionosphere = need.effect == kIonosphere || need.effect == kIonosphereDifference;
          const bool decided = !kalman && !(of_ionosphere && weighting == "budget");
          looks.right((need.verdict == Verdict::kNotNeeded) == decided && !need.reason.empty());
        }
      }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> verdict_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "what is said before anything is received",
           "an antenna that a tilted body lifts, a verdict for another", "balls, angles and bounds written out",
           "of the bound"});
  rows.add("asked/verdicts", verdicts).add("asked/route_needs", route_needs).add("asked/range_needs", range_needs);
  return rows.take();
}

}  // namespace canyon::gnss
