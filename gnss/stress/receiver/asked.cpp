// What a receiver says of itself before it runs: antennas, keys as they come, needs; and how its locks come and go.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/paths/diffraction/knife_edge.h"
#include "canyon/gnss/paths/need/path_question.h"
#include "canyon/gnss/paths/sight/point_sight.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/receiver/receiver_antenna.h"
#include "canyon/gnss/receiver/signal_lock.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/gnss/single_point/config.h"
#include "canyon/gnss/stress/level_ground.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

/// As igs05.atx prints them for G01, by zenith angle from 0 to 90 in steps of 5 degrees: north, east and up of the mean
/// phase centre, mm, then the variation without azimuth.
struct PrintedAntenna {
  const char* name;
  double north, east, up;
  std::array<double, 19> by_zenith;
};
constexpr PrintedAntenna kPrinted[] = {
    {"survey",
     1.35,
     0.30,
     66.76,
     {0.00, -0.01, -0.05, -0.12, -0.22, -0.33, -0.45, -0.58, -0.71, -0.82, -0.93, -1.00, -1.00, -0.88, -0.58, -0.11,
      0.49, 1.11, 1.59}},
    {"choke_ring",
     0.60,
     -0.46,
     91.24,
     {0.00, -0.24, -0.92, -1.97, -3.28, -4.69, -6.05, -7.19, -7.97, -8.30, -8.14, -7.46, -6.27, -4.54, -2.20, 0.87,
      4.79, 9.56, 14.88}},
    {"patch", 0.0, 0.0, 8.9, {}},
    {"isotropic", 0.0, 0.0, 0.0, {}},
};
/// As data sheets have them, right hand and left by zenith angle from 0 to 180 in steps of 15 degrees, dB.
struct PrintedGain {
  const char* name;
  std::array<double, 13> right, left;
};
constexpr PrintedGain kGains[] = {
    {"patch",
     {0.0, -0.1, -0.5, -1.3, -2.6, -4.3, -7, -10, -13, -16, -19, -21, -22},
     {-18.8, -18, -16, -14, -12.5, -11.5, -11.5, -12.5, -14, -15.5, -17, -19, -20}},
    {"survey",
     {0.0, -0.2, -1.0, -2.4, -4.6, -8.0, -12.5, -18.5, -24, -28, -30, -31, -32},
     {-25, -24, -23, -22, -21, -20, -20.5, -24, -26, -27, -28, -29, -30}},
    {"choke_ring",
     {0.0, -0.3, -1.0, -2.3, -4.3, -7.2, -11.5, -20, -27, -31, -33, -34, -35},
     {-30, -29, -27, -25, -23, -22, -24, -27, -29, -30, -31, -32, -32}},
    {"isotropic", {}, {-100, -100, -100, -100, -100, -100, -100, -100, -100, -100, -100, -100, -100}},
};

StressFigure antennas_as_printed() {
  Looks looks;
  const RandomStream draws(1, "stress.asked");
  for (const PrintedAntenna& printed : kPrinted) {
    const auto antenna = model_row(antenna_models(), printed.name).make({});
    for (std::uint64_t k = 0; k < 200; ++k) {
      Vector3d u = draws.direction(0, k);
      if (k < 19) u = Vector3d(std::sin(5.0 * k * kDegree), 0.0, std::cos(5.0 * k * kDegree));
      const double zenith = std::min(std::acos(std::clamp(u.z(), -1.0, 1.0)) / kDegree, 90.0) / 5.0;
      const auto i = static_cast<std::size_t>(std::min(std::floor(zenith), 17.0));
      const double part = zenith - static_cast<double>(i);
      const double variation = (1.0 - part) * printed.by_zenith[i] + part * printed.by_zenith[i + 1];
      // The mean phase centre lies towards the satellite: the range is the shorter by that.
      const double offset = printed.east * u.x() + printed.north * u.y() + printed.up * u.z();
      looks.near(antenna->phase_centre_m(u), 1e-3 * (variation - offset), 1e-11);
    }
  }
  for (const PrintedGain& printed : kGains) {
    const auto antenna = model_row(antenna_models(), printed.name).make({});
    for (double zenith = 0.0; zenith <= 180.0; zenith += 2.5) {
      const auto i = static_cast<std::size_t>(std::min(std::floor(zenith / 15.0), 11.0));
      const double part = zenith / 15.0 - static_cast<double>(i), e = (90.0 - zenith) * kDegree;
      looks.near(antenna->rhcp_db(e), (1.0 - part) * printed.right[i] + part * printed.right[i + 1], 1e-10);
      looks.near(antenna->lhcp_db(e), (1.0 - part) * printed.left[i] + part * printed.left[i + 1], 1e-10);
    }
  }
  const auto sine = make_sine_antenna({.horizon_loss_db = 6.5, .lhcp_rejection_db = 9.0});
  for (double e = -1.57; e < 1.57; e += 0.1) {
    looks.near(sine->rhcp_db(e), 6.5 * (std::sin(e) - 1.0), 1e-13);
    looks.near(sine->lhcp_db(e), 6.5 * (std::sin(e) - 1.0) - 9.0, 1e-13);
    looks.right(sine->phase_centre_m(Vector3d::UnitZ()) == 0.0);
  }
  return looks.figure();
}

/// Keys that nobody sets, as the manual states them (docs/gnss.md).
StressFigure keys_as_they_come() {
  int wrong = 0;
  const auto is = [&](double found, double stated) { wrong += found == stated ? 0 : 1; };
  const GnssConfig c;
  is(c.rate_hz, 2.0), is(c.mask_deg, 10.0), is(c.lever_arm_m.x(), -0.3), is(c.lever_arm_m.y(), 0.0),
      is(c.lever_arm_m.z(), 1.2);
  is(c.link.cn0_zenith_dbhz, 45.0), is(c.link.foliage_db_per_m, 0.25), is(c.link.foliage_max_db, 28.0);
  is(c.link.antenna_phase_centre, 0.0), is(c.tracking.correlator_spacing_chips, 0.5), is(c.tracking.code_loop_hz, 0.13);
  is(c.tracking.front_end_mhz, 0.0), is(c.tracking.carrier_loop_hz, 15.0), is(c.tracking.integration_ms, 20.0);
  is(c.tracking.thermal_noise_scale, 1.0), is(c.tracking.multipath_scale, 1.0);
  is(c.locks.tracking_threshold_dbhz, 25.0), is(c.locks.reacquisition_margin_db, 3.0), is(c.locks.reacquisition_s, 1.0);
  is(c.cn0_report.averaging_s, 0.0), is(c.cn0_report.resolution_db, 0.0), is(c.reception.cutoff_ns, 150.0);
  is(std::round(1e6 * c.reception.cutoff_m()), 44968869.0);
  is(c.position.raim_false_alarm, 1e-3), is(c.position.solver_sigma_m, 0.5), is(c.position.max_gdop, 100.0);
  is(c.position.estimator_acceleration_m_s2, 2.0), is(c.position.smoothing_s, 0.0),
      is(c.position.accuracy_limit_m, 0.0);
  is(c.propagation.surface_roughness_m, 0.0), is(c.propagation.ground_reflection, 0.0);
  const SineAntennaParameters sine;
  is(sine.horizon_loss_db, 7.0), is(sine.lhcp_rejection_db, 10.0);
  const LinkBudget link;
  is(link.cn0_zenith_dbhz, 45.0), is(link.foliage_db_per_m, 0.25), is(link.foliage_max_db, 28.0);
  is(link.antenna->rhcp_db(0.0), -7.0), is(link.antenna->lhcp_db(0.5 * kPi), -10.0);
  const CorrelatorDesign d;
  is(d.spacing_chips, 0.5), is(d.front_end_hz, 0.0), is(d.code_loop_hz, 0.5), is(d.carrier_loop_hz, 15.0),
      is(d.integration_s, 0.02);
  const SignalLockParameters l;
  is(l.interval_s, 1.0), is(l.threshold_dbhz, 25.0), is(l.reacquisition_margin_db, 3.0), is(l.reacquisition_s, 1.0);
  is(l.carrier_loop_hz, 15.0), is(l.integration_s, 0.02), is(l.slips, 1.0);
  const DgpsParameters b;
  is(b.baseline_km, 5.0), is(b.ionosphere_gradient_mm_per_km, 2.0), is(b.troposphere_gradient_mm_per_km, 1.0),
      is(b.base_error_scale, 1.0);
  const MultipathParameters m;
  is(m.cutoff_m, 45.0), is(m.threshold_dbhz, 25.0);
  const PathParameters p;
  is(p.cutoff_m, 45.0), is(p.weakest_db, -20.0), is(p.weakest_nlos_db, -20.0), is(p.combine_all_m, 30.0),
      is(p.leaning_reach_m, 1000.0);
  is(p.launched_rays, 20000.0), is(p.scattered_share, 0.0), is(p.roughness_m, 0.0);
  const PositionSolverParameters s;
  is(s.max_gdop, 100.0), is(s.false_alarm, 1e-3), is(s.max_exclusions, 8.0), is(RangeMeasurement{}.sigma_m, 1.0);
  const RangeErrorParameters e;
  const EnvironmentParameters n;
  is(e.correlation_s, 10.0), is(n.light_a_m2, 10.0), is(n.light_b_m2_hz, 22500.0), is(n.heavy_a_m2, 500.0),
      is(n.heavy_b_m2_hz, 1e6);
  is(RangeSignal{}.code_factor, 1.0), is(RangeWeightingParameters{}.sigma_m, 0.5), is(RangeQuality{}.code_factor, 1.0);
  const SinglePointConfig f;
  is(f.mask_deg, 10.0), is(f.max_gdop, 30.0), is(f.shared_ionosphere, 0.5), is(f.smoothing_s, 300.0),
      is(f.acceleration_m_s2, 1.0);
  is(f.base_age_s, 30.0), is(f.sigma_m, 0.5), is(f.doppler_sigma_m_s, 0.05), is(f.false_alarm, 1e-3),
      is(f.max_exclusions, 8.0);
  is(kDeepestLitNu, 3.0), is(kOverScreen_db, 6.0), is(IonexMaps{}.shell_height_m, 450e3),
      is(IonexMaps{}.base_radius_m, 6371e3);
  is(epoch_index(c, 0.0), 0.0), is(epoch_index(c, 10.24), 20.0), is(epoch_index(c, 10.26), 21.0),
      is(epoch_index(c, 3600.0), 7200.0);
  return {1.0 * wrong, 0.0};
}

/// Locks by their rules, one state for each satellite, over 400 epochs of strengths that come and go, sources that
/// change and satellites that set: exact, cycles drawn by their streams.
StressFigure locks_by_their_rules() {
  int wrong = 0, slips = 0;
  const RandomStream draws(2, "stress.asked");
  SignalLockParameters p;
  p.seed = 6, p.interval_s = 0.5, p.threshold_dbhz = 21.0, p.reacquisition_margin_db = 2.0, p.reacquisition_s = 1.6;
  const RandomStream ambiguity(6, "gnss.carrier.ambiguity"), slip(6, "gnss.carrier.slip");
  SignalLocks locks(p);
  struct Own {
    bool locked = false;
    int since = -1, last = -10;
    std::uint64_t source = 0;
    double cycles = 0.0;
  };
  std::map<std::uint8_t, Own> own;
  int begun = 0;
  for (int k = 0; k < 400; ++k) {
    if (k == 250) locks.restart(), own.clear(), begun = k;
    locks.begin_epoch(k);
    const bool first = k == begun;
    for (std::uint8_t prn = 1; prn <= 6; ++prn) {
      const auto at = static_cast<std::uint64_t>(8 * k + prn);
      if (draws.uniform(0, at) < 0.02) continue;  // not in view
      const SatelliteId sv{GnssSystem::kGps, prn};
      const double cn0 = draws.uniform(1, at) < 0.02
                             ? kNaN
                             : 20.0 + 0.7 * prn + 3.0 * std::sin(0.05 * k * prn) + draws.uniform(-0.5, 0.5, 2, at);
      const std::uint64_t source = draws.uniform(3, at) < 0.05 ? 7 : 1;
      const auto found = locks.update(sv, cn0, source);
      Own& o = own[prn];
      if (o.last != k - 1) o = Own{};
      o.last = k;
      bool tracked = false, slipped = false, fresh = false;
      if (!(cn0 >= 21.0)) {
        o.locked = false, o.since = -1;
      } else if (!o.locked) {
        if (first || cn0 >= 23.0) {
          if (o.since < 0) o.since = k;
          // 1.6 s are four epochs of half a second.
          fresh = first || k - o.since >= 4;
        } else {
          o.since = -1;
        }
        tracked = fresh;
      } else {
        tracked = true;
        fresh = source != o.source;
        const double share = 1.0 - std::exp(-0.5 / mean_time_to_slip_s(cn0, 15.0, 0.02)),
                     u = slip.uniform(sv.entity(), static_cast<std::uint64_t>(k));
        if (!fresh && u < share) o.cycles += u < 0.5 * share ? 1.0 : -1.0, slipped = true, ++slips;
      }
      if (fresh)
        o.locked = slipped = true,
        o.cycles = std::floor(ambiguity.uniform(-1e6, 1e6, sv.entity(), static_cast<std::uint64_t>(k)));
      if (tracked) o.source = source;
      wrong +=
          found.tracked == tracked && found.slipped == slipped && found.ambiguity_cycles == (tracked ? o.cycles : 0.0)
              ? 0
              : 1;
    }
  }
  wrong += slips > 5 ? 0 : 1;
  // A Costas loop's mean time by quadrature of Bessel's function, I0(x) = mean of exp(x cos): to its own 1e-6.
  for (const double cn0 : {18.0, 21.0, 23.0, 25.0, 27.0}) {
    const double hz = std::pow(10.0, 0.1 * cn0), sigma2 = 15.0 / hz * (1.0 + 1.0 / (2.0 * 0.02 * hz)),
                 rho = 0.25 / sigma2;
    double bessel = 0.0;  // times exp(-rho)
    for (int k = 0; k < 4000; ++k) bessel += std::exp(rho * (std::cos(2.0 * kPi * k / 4000.0) - 1.0)) / 4000.0;
    const double log_s = std::log(kPi * kPi * rho / 30.0) + 2.0 * (rho + std::log(bessel));
    wrong += std::abs(std::log(mean_time_to_slip_s(cn0, 15.0, 0.02)) - log_s) < 4e-6 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

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

/// Sight from a place as its eight corners have it, each by its share of the cell of 2 m, and a point that is asked for
/// again, by another and after others; half a wall hides half.
StressFigure sight_from_places() {
  Looks looks;
  const RandomStream draws(5, "stress.asked");
  scene::SceneParts parts = level_ground("sight", 60.0, -40.0);
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("wall", scene::ObjectKind::kWall);
  mesh.quad({9, -7, -30}, {9, 5, -30}, {9, 5, 6}, {9, -7, 6}, mesh.material("metal"));
  mesh.quad({-7, 20, -30}, {-7, 9, -30}, {-7, 9, 16}, {-7, 20, 16}, mesh.material("metal"));
  const scene::Scene place(std::move(parts));
  const scene::SceneAt at(place);
  PointSight sight(place);
  std::vector<Vector3d> points;
  for (std::uint64_t k = 0; k < 40; ++k)
    points.push_back({draws.uniform(-30, 30, 0, k), draws.uniform(-30, 30, 1, k), draws.uniform(0, 20, 2, k)});
  int between = 0;
  GnssCounters counters;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const Vector3d p(draws.uniform(-6, 6, 3, k), draws.uniform(-6, 6, 4, k), draws.uniform(0, 4, 5, k));
    const PointSight::From from = sight.from(p);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      double share = 0.0;
      for (int corner = 0; corner < 8; ++corner) {
        Vector3d node;
        double weight = 1.0;
        for (int a = 0; a < 3; ++a) {
          const double low = 2.0 * std::floor(p[a] / 2.0), part = (p[a] - low) / 2.0;
          node[a] = (corner >> a & 1) != 0 ? low + 2.0 : low;
          weight *= (corner >> a & 1) != 0 ? part : 1.0 - part;
        }
        const Vector3d way = points[i] - node;
        if (!at.blocked_towards(node, way.normalized(), way.norm())) share += weight;
      }
      between += share > 0.01 && share < 0.99 ? 1 : 0;
      looks.near(from.share(i, points[i], counters), share, 1e-13);
    }
  }
  looks.right(between > 20 && counters.occlusion_rays > 100);
  const auto rays = counters.occlusion_rays;
  sight.from({0.5, 0.5, 0.5}).share(3, points[3], counters);
  const auto once = counters.occlusion_rays;
  sight.from({0.6, 0.4, 0.7}).share(3, points[3], counters);
  looks.right(counters.occlusion_rays == once && once >= rays);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> asked_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "antennas as their makers and the IGS print them",
           "a figure in the next column, east for north", "by zenith angle, straight between: roundings",
           "of the bound"});
  rows.add("asked/antennas_as_printed", antennas_as_printed)
      .loose("an arc cosine beside the zenith loses half of its digits, an arc sine does not");
  rows.of({StressGroup::kData, "keys that nobody sets", "a figure of the wrong power of ten",
           "as the manual states them: exact", "differences"});
  rows.add("asked/keys_as_they_come", keys_as_they_come);
  rows.of({StressGroup::kData, "locks over many epochs",
           "a margin that is taken off, a wait of an epoch too many, a slip the other way",
           "the rules for each satellite by itself: exact; slips by Bessel's function to its 1e-6", "differences"});
  rows.add("asked/locks_by_their_rules", locks_by_their_rules);
  rows.of({StressGroup::kGeometry, "what is said before anything is received",
           "an antenna that a tilted body lifts, a verdict for another", "balls, angles and bounds written out",
           "of the bound"});
  rows.add("asked/verdicts", verdicts).add("asked/route_needs", route_needs).add("asked/range_needs", range_needs);
  rows.of({StressGroup::kGeometry, "sight from between the nodes of a lattice",
           "a share of the next cell, a corner twice", "eight rays, each with its share: roundings", "of the bound"});
  rows.add("asked/sight_from_places", sight_from_places);
  return rows.take();
}

}  // namespace canyon::gnss
