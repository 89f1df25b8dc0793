// Receivers as a whole, in an open place: what a range is made of, and what comes of it.
#include <cmath>
#include <set>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/config/config.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/level_ground.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Worst;

const GpsTime kFirstFix = GpsTime::from_week_sow(1590, 396000.0);

/// Level ground far below, so that a scene has something in it.
std::unique_ptr<scene::Scene> open_place() {
  return std::make_unique<scene::Scene>(level_ground("open", 50.0, -1.0));
}

std::unique_ptr<GnssSensor> sensor_of(const std::string& keys, const scene::Scene& place, std::uint64_t seed = 1) {
  GnssConfig config;
  const auto node = ConfigNode::parse(keys, "stress");
  CANYON_CHECK(node && read_config(&*node, "gnss", config).ok(), keys);
  auto made = make_gnss_sensor(config, seed, kFirstFix, kFirstFix + 7200.0, place);
  CANYON_CHECK(made.ok(), made.ok() ? "" : made.error().what);
  return std::move(*made);
}

/// All that errs off, of one system or of all.
constexpr const char* kErrorFree =
    "ionosphere = \"none\"\ntroposphere = \"none\"\nephemeris_error = \"none\"\nthermal_noise_scale = 0\n";

/// Of each range the errors marked in its truth record are what the corrected pseudorange is longer than range and
/// receiver clock: 8 eps of 4e7 m and the label's nanosecond at 1 km/s. Residuals of the fix are a GDOP of them; its
/// velocity's Doppler is the range rate but for noise.
StressFigure budget(const std::string& keys, bool error_free) {
  const auto place = open_place();
  const auto sensor = sensor_of(keys, *place);
  const scene::SceneAt at(*place);
  const Vector3d p(3.0, -4.0, 1.5), v(11.0, -7.0, 0.4);
  Worst worst;
  const double ulp_m = 8.0 * kEpsilon * 4e7;
  for (std::int64_t k = 0; k < 40; ++k) {
    const GpsTime t = kFirstFix + 0.5 * static_cast<double>(k);
    const GnssOutput out = sensor->measure(k, t, p + 0.5 * static_cast<double>(k) * v, v, at);
    std::size_t i = 0;
    for (const GnssObservationTruth& truth : out.truth.satellites) {
      if (!truth.tracked) continue;
      const GnssObservation& o = out.epoch.observations.at(i++);
      if (o.sv != truth.sv) return {kInfinity, 1.0};
      const double errors = truth.multipath_m + truth.ionosphere_m + truth.troposphere_m + truth.ephemeris_m +
                            truth.noise_m + truth.base_m + truth.phase_centre_m;
      // The receiver takes the satellite's place at the time that its own pseudorange says.
      const double range_m = (o.p_E - out.truth.p_A_E).norm();
      const double late_m = 1e3 * 1e-9;
      worst.look(o.corrected_m() - truth.range_m - out.truth.receiver_clock_m - errors, ulp_m + late_m + 1e-3);
      // Delays of up to 30 m place the satellite 1e-7 s, 0.4 mm, off along its way.
      worst.look(range_m - truth.range_m, 1e-3);
      const double wavelength_m = kSpeedOfLight / carrier_hz(o.sv.system, o.band);
      if (error_free) {
        worst.look(errors, 1e-9);
        // Clocks of the built-in satellites are perfect; a Doppler rounds by eps of 5 kHz, the clock's rate by c.
        worst.look(-o.doppler_hz * wavelength_m - truth.range_rate_m_s - out.truth.receiver_clock_rate_m_s,
                   64.0 * kEpsilon * 1e4);
        worst.look((o.carrier_phase_cycles - truth.ambiguity_cycles) * wavelength_m - truth.range_m -
                       out.truth.receiver_clock_m,
                   2.0 * ulp_m);
      }
      worst.look(truth.line_of_sight && truth.elevation_rad > 9.9 * kDegree ? 0.0 : kInfinity, 1.0);
    }
    if (out.fix.status == FixStatus::kNone || i < 6) return {kInfinity, 1.0};
    const Vector3d off_E = out.fix.p_A_E - out.truth.p_A_E;
    if (error_free) {
      worst.look(off_E.norm(), out.fix.dop.gdop * (ulp_m + 1e-3));
      if (out.fix.v_A_E.allFinite()) worst.look((out.fix.v_A_E - out.truth.v_A_E).norm(), out.fix.dop.gdop * 1e-3);
      worst.look(out.fix.clock_m - out.truth.receiver_clock_m, out.fix.dop.gdop * (ulp_m + 1e-3));
    } else {
      // 5 sigma of what it claims and of what lasts, which is of the same order.
      worst.look(off_E.norm(), 10.0 * std::sqrt(out.fix.covariance_E.trace()));
    }
  }
  return worst.figure();
}

/// A street between two rows of houses along y, level.
std::unique_ptr<scene::Scene> narrow_street() {
  scene::SceneParts parts = level_ground("street", 200.0, 0.0);
  scene::MeshBuilder mesh(parts);
  for (int k = -3; k <= 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      mesh.begin_object("house", scene::ObjectKind::kBuilding);
      mesh.box({side * 20.0, 22.0 * k, 5.0 + (k + 3) % 4}, Eigen::Matrix3d::Identity(), {8.0, 10.0, 5.0 + (k + 3) % 4},
               mesh.material(k % 2 == 0 ? "concrete" : "metal"));
    }
  return std::make_unique<scene::Scene>(std::move(parts));
}

/// In a street, in each mode: what is left of all errors once the receiver has corrected what it corrects is what its
/// corrected ranges are longer by than range and clock, multipath, noise and base station among it; the same of the
/// carrier; and of the fix: no place nearby fits its ranges better, each with the sigma it is trusted with, and its
/// covariance is theirs. Ranges as in the open; the fix to 1 mm, where its search ends.
StressFigure street_budget(const std::string& keys, bool own_covariance) {
  const auto place = narrow_street();
  const auto sensor = sensor_of("paths = \"specular2\"\ndiffraction = \"knife_edge\"\n" + keys, *place, 3);
  const scene::SceneAt at(*place);
  const Vector3d v(0.3, 6.0, 0.0);
  Worst worst;
  const double ulp_m = 8.0 * kEpsilon * 4e7;
  int bent = 0, second = 0, fixes = 0;
  double sigma_low_m = kInfinity, sigma_high_m = 0.0;
  for (std::int64_t k = 0; k < 30; ++k) {
    const GpsTime t = kFirstFix + 0.5 * static_cast<double>(k);
    const GnssOutput out = sensor->measure(k, t, Vector3d(-4.0, -40.0, 1.5) + 0.5 * static_cast<double>(k) * v, v, at);
    std::size_t i = 0;
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d pull = Eigen::Vector4d::Zero();
    for (const GnssObservationTruth& truth : out.truth.satellites) {
      if (!truth.tracked) continue;
      const GnssObservation& o = out.epoch.observations.at(i++);
      if (o.sv != truth.sv) return {kInfinity, 1.0};
      const double errors = truth.multipath_m + truth.ionosphere_m + truth.troposphere_m + truth.ephemeris_m +
                            truth.noise_m + truth.base_m + truth.phase_centre_m;
      // Delays and echoes of up to 300 m place the satellite 1e-6 s, 4 mm, off along its way, of which the range has
      // its share.
      worst.look(o.corrected_m() - truth.range_m - out.truth.receiver_clock_m - errors, ulp_m + 1e-6 + 5e-3);
      bent += std::abs(truth.multipath_m) > 0.01 ? 1 : 0;
      second += std::isfinite(o.second.pseudorange_m) ? 1 : 0;
      sigma_low_m = std::min(sigma_low_m, o.sigma_m), sigma_high_m = worse(sigma_high_m, o.sigma_m);
      if (!o.used || out.fix.status == FixStatus::kNone) continue;
      const Vector3d way = o.p_E - out.fix.p_A_E;
      const double left_m = o.corrected_m() - way.norm() - out.fix.clock_m, weight = 1.0 / (o.sigma_m * o.sigma_m);
      Eigen::Vector4d row;
      row << -way.normalized(), 1.0;
      normal += weight * row * row.transpose();
      pull += weight * left_m * row;
    }
    if (out.fix.status == FixStatus::kNone) continue;
    ++fixes;
    const Eigen::Matrix4d inverse = normal.inverse();
    worst.look((inverse * pull).norm(), 1e-3);
    if (own_covariance)
      worst.look((out.fix.covariance_E - inverse.topLeftCorner<3, 3>()).norm() / inverse.topLeftCorner<3, 3>().norm(),
                 1e-5);
  }
  const bool two = keys.find("dual") != std::string::npos;
  worst.look(bent > 10 && fixes > 10 && two == (second > 0) && sigma_high_m > 1.2 * sigma_low_m ? 0.0 : kInfinity, 1.0);
  return worst.figure();
}

/// Errors of a fix over 2000 epochs: mean none, mean square that of the keys, per axis of W, epochs independent; 5
/// sigma (false alarm 6e-7 each). And the covariance is that stated.
struct Statistics {
  Vector3d mean = Vector3d::Zero(), square = Vector3d::Zero();
  double lag = 0.0;
};
StressFigure noise(const std::string& keys, const Vector3d& sigma_m, const Vector3d& claimed_m, bool gaussian) {
  const auto place = open_place();
  const auto sensor = sensor_of(keys, *place, 5);
  const scene::SceneAt at(*place);
  constexpr int kCount = 2000;
  Statistics s;
  Vector3d before = Vector3d::Zero();
  Worst worst;
  const Eigen::Matrix3d R_WE = place->frame().R_EW().transpose();
  for (std::int64_t k = 0; k < kCount; ++k) {
    const GnssOutput out =
        sensor->measure(k, kFirstFix + 0.5 * static_cast<double>(k), {1.0, 2.0, 3.0}, {4.0, 5.0, 0.0}, at);
    if (out.fix.status == FixStatus::kNone) return {kInfinity, 1.0};
    const Vector3d e = R_WE * (out.fix.p_A_E - place->frame().to_E({1.0, 2.0, 3.0}));
    s.mean += e / kCount;
    s.square += e.cwiseAbs2() / kCount;
    s.lag += e.dot(before) / kCount;
    before = e;
    const Eigen::Matrix3d P = R_WE * out.fix.covariance_E * R_WE.transpose();
    if (k % 500 == 0)
      worst.look((P - Eigen::Matrix3d(claimed_m.cwiseAbs2().asDiagonal())).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
                 64.0 * kEpsilon * claimed_m.squaredNorm());
  }
  // Of a Gaussian the square's own spread is sqrt(2) of it; a length that varies less has less.
  const double root = std::sqrt(static_cast<double>(kCount));
  for (int i = 0; i < 3; ++i) {
    worst.look(s.mean[i], 5.0 * sigma_m[i] / root);
    worst.look(s.square[i] / (sigma_m[i] * sigma_m[i]) - 1.0, 5.0 * std::sqrt(gaussian ? 2.0 : 1.0) / root);
  }
  worst.look(s.lag, 5.0 * sigma_m.squaredNorm() / root);
  return worst.figure();
}

/// Satellites that are counted: sigma falls evenly from four to twelve of them, and fewer than four are no fix. A wall
/// that leans over hides more and more of the sky, so that all counts come.
StressFigure counted() {
  Worst worst;
  const auto place = open_place();
  const auto sensor = sensor_of(
      "model = \"satellite_count\"\nsystems = \"GR\"\ncount_noise_max_m = 12\ncount_noise_min_m = 3\n"
      "mask_deg = 5",
      *place);
  std::set<int> counts;
  for (int width = 0; width < 24; ++width) {
    scene::SceneParts parts = place->parts();
    scene::MeshBuilder mesh(parts);
    mesh.begin_object("wall", scene::ObjectKind::kWall);
    const double half = 0.25 * width * width;
    mesh.quad({-half, -half, 20}, {-half, half, 20}, {half, half, 20}, {half, -half, 20}, mesh.material("metal"));
    const scene::Scene covered(std::move(parts));
    const GnssOutput out =
        sensor->measure(width, kFirstFix + 60.0 * width, {0, 0, 1}, {0, 0, 0}, scene::SceneAt(covered));
    int seen = 0;
    for (const GnssObservationTruth& truth : out.truth.satellites) {
      // The roof ends where its rim is seen under atan(19 / distance along it).
      const Vector3d d(std::sin(truth.azimuth_rad) * std::cos(truth.elevation_rad),
                       std::cos(truth.azimuth_rad) * std::cos(truth.elevation_rad), std::sin(truth.elevation_rad));
      const double scale = 19.0 / d.z(), rim = worse(std::abs(d.x()), std::abs(d.y())) * scale;
      const bool sees = rim > half;
      if (std::abs(rim - half) > 1e-3 * half + 1e-3) worst.look(truth.line_of_sight == sees ? 0.0 : kInfinity, 1.0);
      seen += truth.line_of_sight ? 1 : 0;
    }
    counts.insert(std::min(seen, 12));
    if (seen < 4) {
      worst.look(out.fix.status == FixStatus::kNone && !out.fix.reason.empty() ? 0.0 : kInfinity, 1.0);
      continue;
    }
    worst.look(out.fix.satellites == seen ? 0.0 : kInfinity, 1.0);
    const double sigma_m = (12.0 - 9.0 * (std::min(seen, 12) - 4) / 8.0) / 3.0;
    worst.look(out.fix.covariance_E(0, 0) / (sigma_m * sigma_m) - 1.0, 16.0 * kEpsilon);
    worst.look((out.fix.p_A_E - out.truth.p_A_E).norm(), 8.0 * sigma_m);
  }
  worst.look(counts.size() >= 5 && *counts.begin() < 4 ? 0.0 : kInfinity, 1.0);
  return worst.figure();
}

/// Asked again from the beginning, in another order, or by another sensor of the same seed: the same bits. Another
/// seed: other ones.
StressFigure repeated(const std::string& keys) {
  const auto place = open_place();
  const scene::SceneAt at(*place);
  const auto run = [&](GnssSensor& sensor, std::int64_t from) {
    std::vector<Vector3d> out;
    for (std::int64_t k = from; k < from + 6; ++k)
      out.push_back(sensor.measure(k, kFirstFix + 0.5 * static_cast<double>(k), {1, 2, 3}, {4, 0, 0}, at).fix.p_A_E);
    return out;
  };
  const auto one = sensor_of(keys, *place), two = sensor_of(keys, *place), other = sensor_of(keys, *place, 2);
  const auto first = run(*one, 0), later = run(*one, 100), again = run(*one, 0);
  int wrong = (first == again ? 0 : 1) + (later == run(*two, 100) ? 0 : 1) + (first == run(*two, 0) ? 0 : 1);
  wrong += first != run(*other, 0) ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Keys that contradict one another are refused, and the ends of those that do not are taken.
StressFigure contradicting_keys() {
  const auto place = open_place();
  int wrong = 0;
  const auto made = [&](const std::string& keys) {
    GnssConfig config;
    const auto node = ConfigNode::parse(keys, "stress");
    CANYON_CHECK(node && read_config(&*node, "gnss", config).ok(), keys);
    return make_gnss_sensor(config, 1, kFirstFix, kFirstFix + 10.0, *place).ok();
  };
  wrong += made("model = \"satellite_count\"\ncount_noise_max_m = 2\ncount_noise_min_m = 3") ? 1 : 0;
  wrong += made("model = \"satellite_count\"\ncount_noise_max_m = 3\ncount_noise_min_m = 3") ? 0 : 1;
  wrong += made("model = \"truth_plus_isotropic\"\nisotropic_max_m = 0.1\nisotropic_min_m = 0.2") ? 1 : 0;
  wrong += made("model = \"truth_plus_isotropic\"\nisotropic_max_m = 0\nisotropic_min_m = 0") ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> sensor_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "the budget of a pseudorange, and the fix of it",
           "a clock, a delay or a turn of the Earth with the other sign, once in the range and not in its correction",
           "corrected pseudorange = range + clock + the truth record's errors; a fix without any to GDOP roundings",
           "of the bound"});
  rows.add("sensors/error_free",
           [] { return budget(std::string(kErrorFree) + "mode = \"single_uncorrected\"\n", true); });
  rows.add("sensors/error_free_of_three_systems",
           [] { return budget(std::string(kErrorFree) + "mode = \"single_uncorrected\"\nsystems = \"GEC\"\n", true); });
  rows.add("sensors/dgps_as_it_is", [] { return budget("", false); });
  rows.add("sensors/beside_a_simulated_base", [] { return budget("mode = \"dgps_base\"\n", false); });
  rows.add("sensors/single_of_all_systems", [] { return budget("mode = \"single\"\nsystems = \"GREC\"\n", false); });
  rows.add("sensors/dual_frequency", [] { return budget("mode = \"dual\"\nsystems = \"GE\"\n", false); });
  rows.of({StressGroup::kGeometry, "the budget of a pseudorange in a street, and how a fix weighs its ranges",
           "an echo of the other band or sign in the record of truth, a range's sigma for another's",
           "ranges as above; the weighed residuals of a fix pull nowhere, and its covariance is theirs",
           "of the bound"});
  rows.add("sensors/street_of_one_frequency",
           [] { return street_budget("mode = \"single_uncorrected\"\ntroposphere = \"none\"\n", true); });
  rows.add("sensors/street_of_two_frequencies",
           [] { return street_budget("mode = \"dual\"\nsystems = \"G\"\nmultipath_rule = \"correlator\"\n", true); });
  rows.add("sensors/street_beside_a_base", [] { return street_budget("mode = \"dgps\"\n", true); });
  rows.add("sensors/street_beside_a_simulated_base", [] { return street_budget("mode = \"dgps_base\"\n", true); });
  rows.of({StressGroup::kData, "noise of the simple receivers",
           "a direction that prefers the poles, an axis of another frame, epochs that hang together",
           "mean, mean square and lag per axis of W: 5 sigma of 2000 epochs", "of the bound"});
  rows.add("sensors/white_noise", [] {
    return noise("model = \"truth_plus_white\"\nwhite_sigma_m = 1.5\nwhite_sigma_up_m = 4", {1.5, 1.5, 4.0},
                 {1.5, 1.5, 4.0}, true);
  });
  rows.add("sensors/isotropic_noise", [] {
    // U(a, b) has the mean square (a^2 + a b + b^2) / 3, a third of it along each axis.
    const double axis_m = std::sqrt((1.0 + 3.0 + 9.0) / 3.0 / 3.0);
    return noise("model = \"truth_plus_isotropic\"\nisotropic_min_m = 1\nisotropic_max_m = 3\nisotropic_sigma_m = 0.7",
                 Vector3d::Constant(axis_m), Vector3d::Constant(0.7), false);
  });
  rows.of({StressGroup::kGeometry, "satellites counted under a roof that grows",
           "a direction of another frame, a count off by one at either end",
           "those beside the roof's rim, and sigma falling evenly between four and twelve", "of the bound"});
  rows.add("sensors/satellites_counted", counted);
  rows.of({StressGroup::kLong, "epochs of a receiver asked again", "a state that outlives its epochs",
           "the same bits, and others of another seed", "differences"});
  rows.add("sensors/pseudoranges_again", [] { return repeated(""); }).add("sensors/filtered_again", [] {
    return repeated("estimator = \"kalman\"\n");
  });
  rows.add("sensors/beside_a_base_again", [] { return repeated("mode = \"dgps_base\"\nsmoothing_s = 20\n"); });
  rows.of({StressGroup::kData, "keys of a receiver that contradict one another", "a guard the wrong way round",
           "refused, and equal ends taken", "wrong"});
  rows.add("sensors/contradictions", contradicting_keys);
  return rows.take();
}

}  // namespace canyon::gnss
