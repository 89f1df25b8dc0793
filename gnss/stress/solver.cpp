// From ranges to a position: geometry, weights, faults and guesses at their extremes.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/QR>

#include "canyon/core/earth/earth.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/solver/velocity.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;
using stress::kInfinity;
/// What rounding leaves of a range of 2.6e7 m: some eight operations.
constexpr double kRangeRounding_m = 8.0 * kEpsilon * 2.6e7;
constexpr double kClock_m = 3e5;

const Geodetic kHere{0.5646, -1.586, 60.0};

/// A satellite on a sphere of 26,560 km in the direction (azimuth, elevation) from the receiver, as seen at reception.
Eigen::Vector3d satellite(const Geodetic& receiver, double azimuth_rad, double elevation_rad) {
  const Eigen::Vector3d r = ecef_from_geodetic(receiver);
  const Eigen::Vector3d line =
      rotation_E_from_enu(receiver) * Eigen::Vector3d(std::sin(azimuth_rad) * std::cos(elevation_rad),
                                                      std::cos(azimuth_rad) * std::cos(elevation_rad),
                                                      std::sin(elevation_rad));
  const double along = r.dot(line);
  return r + (-along + std::sqrt(along * along + 26.56e6 * 26.56e6 - r.squaredNorm())) * line;
}

/// The range to it, without error; the satellite is turned back to E of its transmission.
RangeMeasurement exact_range(const Geodetic& receiver, double azimuth_rad, double elevation_rad, double sigma_m = 1.0) {
  const Eigen::Vector3d p_E = satellite(receiver, azimuth_rad, elevation_rad), r_E = ecef_from_geodetic(receiver);
  RangeMeasurement out;
  const double range_m = (p_E - r_E).norm();
  out.p_E = turned_by_earth(p_E, -range_m / kSpeedOfLight);
  out.range_m = range_m + kClock_m;
  out.sigma_m = sigma_m;
  return out;
}

std::vector<RangeMeasurement> open_sky(const Geodetic& receiver, int n, double sigma_m = 1.0) {
  std::vector<RangeMeasurement> out{exact_range(receiver, 0.0, 1.35, sigma_m)};
  for (int k = 1; k < n; ++k) out.push_back(exact_range(receiver, 2.4 * k, 0.2 + 0.7 * (k % 4) / 3.0, sigma_m));
  return out;
}

double error_m(const PositionSolution& found, const Geodetic& truth) {
  if (!found.ok) return std::numeric_limits<double>::quiet_NaN();
  return worse((found.p_E - ecef_from_geodetic(truth)).norm(), std::abs(found.clock_m - kClock_m));
}

/// From a guess, at a place: GDOP of what is rounded. The iteration ends with a step below 1 um, whose own error is of
/// second order.
StressFigure solved(const Geodetic& receiver, int n, const Eigen::Vector3d& guess_E) {
  const auto ranges = open_sky(receiver, n);
  const auto found = make_least_squares({})->solve(ranges, guess_E);
  return {error_m(found, receiver), kRangeRounding_m * (found.ok ? found.dop.gdop : 1.0)};
}

StressFigure worst_of(const std::vector<StressFigure>& all) {
  StressFigure out{0.0, 1.0};
  for (const StressFigure& one : all) take_worst(out, one.figure / one.bound);
  return out;
}

/// Everywhere: poles, antimeridian, from -400 m to 20 km.
StressFigure everywhere(int n, bool from_centre) {
  std::vector<StressFigure> all;
  for (const double lat : {-90.0, -89.9999999, -35.0, 0.0, 35.0, 89.9999999, 90.0})
    for (const double lon : {-180.0, -179.9999999, 0.0, 179.9999999, 180.0})
      for (const double h : {-400.0, 0.0, 20e3}) {
        const Geodetic receiver{lat * kDegree, lon * kDegree, h};
        const Eigen::Vector3d guess = from_centre ? Eigen::Vector3d::Zero().eval() : ecef_from_geodetic(receiver);
        all.push_back(solved(receiver, n, guess));
      }
  return worst_of(all);
}

/// Four satellites about the zenith within a cone that gives this GDOP.
StressFigure narrow(double gdop) {
  const double alpha = std::sqrt(2.0 * std::sqrt(8.0 / 3.0) / gdop);
  std::vector<RangeMeasurement> ranges{exact_range(kHere, 0.0, 0.5 * kPi)};
  for (int k = 0; k < 3; ++k) ranges.push_back(exact_range(kHere, 2.0 * kPi * k / 3.0 + 0.1, 0.5 * kPi - alpha));
  const Eigen::Vector3d guess = ecef_from_geodetic(kHere) + Eigen::Vector3d(3.0, -2.0, 1.0);
  const auto found = make_least_squares({.max_gdop = 1e12})->solve(ranges, guess);
  return {error_m(found, kHere), kRangeRounding_m * gdop};
}

std::vector<RangeMeasurement> ring(int n, double elevation_rad) {
  std::vector<RangeMeasurement> out;
  for (int k = 0; k < n; ++k) out.push_back(exact_range(kHere, 2.0 * kPi * k / n + 0.2, elevation_rad));
  return out;
}

std::vector<RangeMeasurement> meridian(int n) {
  std::vector<RangeMeasurement> out;
  for (int k = 0; k < n; ++k) out.push_back(exact_range(kHere, k % 2 == 0 ? 0.0 : kPi, 0.3 + 0.18 * k));
  return out;
}

/// How many of these sets got a fix, by a solver that refuses a GDOP of more than 1e6.
StressFigure taken(const std::vector<std::vector<RangeMeasurement>>& sets) {
  StressFigure out;
  for (const auto& ranges : sets) {
    const auto found = make_least_squares({.max_gdop = 1e6})->solve(ranges, ecef_from_geodetic(kHere));
    out.figure += found.ok || found.reason.empty() ? 1.0 : 0.0;
  }
  return out;
}

/// `ratio` of the sigmas: four precise ranges without error, four coarse ones off by a tenth of their sigma. Those pull
/// by (1 / ratio)^2 of their error; the rest is the rounding of the precise four.
StressFigure weights(double ratio, bool precise_last) {
  const double fine = 1.0 / std::sqrt(ratio), coarse = std::sqrt(ratio);
  auto ranges = open_sky(kHere, 8, coarse);
  for (std::size_t i = 0; i < 8; ++i) {
    const bool precise = precise_last ? i >= 4 : i < 4;
    if (precise)
      ranges[i].sigma_m = fine;
    else
      ranges[i].range_m += (i % 2 == 0 ? 0.1 : -0.1) * coarse;
  }
  const auto four = precise_last ? std::span(ranges).subspan(4) : std::span(ranges).first(4);
  const double gdop = make_least_squares({.max_gdop = 1e6})->solve(four, ecef_from_geodetic(kHere)).dop.gdop;
  const auto found = make_least_squares({})->solve(ranges, ecef_from_geodetic(kHere));
  return {error_m(found, kHere), gdop * kRangeRounding_m + 4.0 * gdop * gdop * 0.1 * coarse / (ratio * ratio)};
}

/// One of ten ranges off: it alone is excluded, and the fix is that of the other nine. Off by more than the satellites'
/// distances the fit of all may find no place at all: then it says so, which is no fault.
StressFigure outlier(const char* exclusion, double by_m) {
  auto ranges = open_sky(kHere, 10);
  ranges[6].range_m += by_m;
  const auto found = make_least_squares({.fault_exclusion = exclusion})->solve(ranges, ecef_from_geodetic(kHere));
  StressFigure out{error_m(found, kHere), kRangeRounding_m * (found.ok ? found.dop.gdop : 1.0)};
  if (found.ok && (found.used[6] || found.satellites_used() != 9)) out.figure = kInfinity;
  if (!found.ok && std::abs(by_m) > 1e8 && !found.reason.empty()) out.figure = 0.0;
  return out;
}

/// Two halves of eight ranges that speak of two places: no fix may pass the test.
StressFigure two_halves(const char* exclusion) {
  auto ranges = open_sky(kHere, 8);
  Geodetic elsewhere = kHere;
  elsewhere.lat_rad += 1e-3;
  // The same satellites as seen 6 km farther north; their turning while the signal travels differs by nanometres.
  for (std::size_t i = 0; i < 4; ++i) {
    RangeMeasurement& r = ranges[2 * i];
    const Eigen::Vector3d p_E = turned_by_earth(r.p_E, (r.range_m - kClock_m) / kSpeedOfLight);
    r.range_m = (p_E - ecef_from_geodetic(elsewhere)).norm() + kClock_m;
  }
  const auto found =
      make_least_squares({.fault_exclusion = exclusion, .max_exclusions = 3})->solve(ranges, ecef_from_geodetic(kHere));
  return {found.ok ? 1.0 : 0.0, 0.0};
}

/// Field by field, what is not finite: of a range refused by its check, of the guess no fix, with a reason. A figure
/// counts what is otherwise.
StressFigure not_finite() {
  StressFigure out;
  for (const double bad : {kNaN, kInfinity, -kInfinity})
    for (int field = 0; field < 4; ++field) {
      auto ranges = open_sky(kHere, 6);
      RangeMeasurement& r = ranges[2];
      if (field == 0) r.range_m = bad;
      if (field == 1) r.p_E.y() = bad;
      if (field == 2) r.sigma_m = bad;
      if (field == 3) r.shared_m = bad;
      const auto solve = [&] { make_least_squares({})->solve(ranges, ecef_from_geodetic(kHere)); };
      out.figure += stress::not_refused(solve, "range_m = ");
    }
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    Eigen::Vector3d guess = ecef_from_geodetic(kHere);
    guess.z() = bad;
    const auto found = make_least_squares({})->solve(open_sky(kHere, 6), guess);
    out.figure += found.ok || found.reason.empty() ? 1.0 : 0.0;
  }
  return out;
}

/// Velocity from rates of the same linear law (light_time/ tests the law): what is left is the solution's own rounding,
/// 4 eps of a rate times GDOP.
StressFigure velocity(double speed_m_s, double gdop) {
  const double alpha = gdop < 5.0 ? 1.2 : std::sqrt(2.0 * std::sqrt(8.0 / 3.0) / gdop);
  const Eigen::Vector3d p_E = ecef_from_geodetic(kHere), v_E = speed_m_s * Eigen::Vector3d(0.6, -0.48, 0.64);
  std::vector<RateMeasurement> rates;
  for (int k = 0; k < 4; ++k) {
    const RangeMeasurement r = exact_range(kHere, 2.1 * k, k == 0 ? 0.5 * kPi : 0.5 * kPi - alpha);
    RateMeasurement m{r.p_E, 3.9e3 * Eigen::Vector3d(std::cos(2.0 * k), std::sin(2.0 * k), 0.4).normalized(), 0.0,
                      0.05};
    m.rate_m_s = range_rate_m_s(m, p_E, v_E) + 30.0;
    rates.push_back(m);
  }
  const auto found = solve_velocity(rates, p_E, {.max_gdop = 1e12});
  const double error = found.ok ? worse((found.v_E - v_E).norm(), std::abs(found.clock_drift_m_s - 30.0)) : kNaN;
  // The clock's column is 1, that of the position u / stretch: GDOP holds for both to 3e-5.
  std::vector<Eigen::Vector3d> lines;
  for (const auto& r : rates) lines.push_back((r.p_E - p_E).normalized());
  const double true_gdop = dilution_of_precision(lines, rotation_E_from_enu(kHere), true).gdop;
  return {error, 4.0 * kEpsilon * (4e3 + speed_m_s) * true_gdop};
}

/// Rates of which three are trusted by `ratio` more than the others: the geometry is whole, but the weighed system has
/// a direction `ratio` weaker than the rest, which the poor ones alone tell. Rates of a true velocity, so it comes
/// back: 64 epsilons of the rates, carried through `ratio` once, times the GDOP; and the covariance is the inverse of
/// the normal equations, whose condition is the ratio's square, where that leaves digits.
StressFigure velocity_of_weights(double ratio) {
  stress::Worst worst;
  const Eigen::Vector3d p_E = ecef_from_geodetic({0.8, 0.3, 200.0}), v_E(12.0, -7.0, 3.0);
  const double drift_m_s = 41.0;
  const RandomStream draws(8, "stress.velocity");
  const Eigen::Matrix3d R = rotation_E_from_enu({0.8, 0.3, 200.0});
  for (int set = 0; set < 20; ++set) {
    std::vector<RateMeasurement> rates;
    Eigen::MatrixXd A(9, 4);
    for (int k = 0; k < 9; ++k) {
      const double azimuth = 0.7 * k + draws.uniform(0.0, 0.5, 0, 9 * set + k),
                   elevation = draws.uniform(0.2, 1.4, 1, 9 * set + k);
      const Eigen::Vector3d line = R * Eigen::Vector3d(std::cos(elevation) * std::sin(azimuth),
                                                       std::cos(elevation) * std::cos(azimuth), std::sin(elevation));
      RateMeasurement m;
      m.p_E = p_E + 2.2e7 * line;
      m.v_E = 3000.0 * line.cross(Eigen::Vector3d(0.3, -0.5, 0.8).normalized());
      m.sigma_m_s = k < 3 ? 0.1 / ratio : 0.1;
      m.rate_m_s = range_rate_m_s(m, p_E, v_E) + drift_m_s;
      rates.push_back(m);
      A.row(k) << -line.transpose() / m.sigma_m_s, 1.0 / m.sigma_m_s;
    }
    const VelocitySolution found = solve_velocity(rates, p_E);
    if (!found.ok) return {stress::kInfinity, 1.0};
    const double bound = 64.0 * kEpsilon * 3000.0 * ratio * 10.0;
    worst.look((found.v_E - v_E).norm(), bound);
    worst.look(found.clock_drift_m_s - drift_m_s, bound);
    for (std::size_t k = 0; k < 9; ++k)
      worst.look(found.residuals_m_s[k], k < 3 ? 64.0 * kEpsilon * 3000.0 * 10.0 : bound);
    // By an orthogonal factor, whose error is that of A and not of A' A; the Earth turns while the signal travels, 7e-6
    // of A.
    const Eigen::Matrix4d inverse =
        A.householderQr().matrixQR().topRows<4>().triangularView<Eigen::Upper>().solve(Eigen::Matrix4d::Identity());
    const Eigen::Matrix3d P = (inverse * inverse.transpose()).topLeftCorner<3, 3>();
    worst.look((found.covariance_E - P).norm() / P.norm(), 1e-4 + 64.0 * kEpsilon * ratio);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> solver_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "a fix from a poor first guess, everywhere",
           "at the poles and the Earth's centre latitude and its frame are singular; a linearised step from there "
           "overshoots",
           "the true place to GDOP * 8 eps range; 7 latitudes, 5 longitudes, -400 m to 20 km",
           "of the rounding bound"});
  rows.add("solver/guess_at_the_earths_centre_eight_satellites", [] { return everywhere(8, true); })
      .add("solver/guess_at_the_earths_centre_exactly_four", [] { return everywhere(4, true); })
      .add("solver/guess_at_the_truth_exactly_four", [] { return everywhere(4, false); });

  rows.of({StressGroup::kGeometry, "a fix of great dilution",
           "steps that rounding keeps above a fixed threshold never converge; normal equations lose half the digits",
           "the true place to GDOP * 8 eps range = GDOP * 4.6e-8 m", "m"});
  for (const double gdop : {1e1, 1e2, 1e3, 1e4, 1e6}) {
    const std::string name = printed("%.0e", gdop);
    rows.add(std::string("solver/four_of_gdop_") + name, [gdop] { return narrow(gdop); });
  }

  rows.of({StressGroup::kGeometry, "ranges that do not determine a place",
           "rounding makes a singular system solvable: a fix thousands of kilometres off, as if it were good",
           "no fix, with a reason", "fixes"});
  rows.add("solver/all_on_a_cone_refused",
           [] {
             return taken({ring(4, 0.6), ring(5, 0.6), ring(9, 0.05), ring(4, 1.5)});
           })
      .add("solver/all_in_a_plane_refused",
           [] {
             return taken({meridian(4), meridian(7)});
           })
      .add("solver/too_few_or_twice_the_same_refused", [] {
        auto three = open_sky(kHere, 3), twice = three;
        twice.push_back(twice.back());
        std::vector<RangeMeasurement> four_times(4, three[0]);
        return taken({{}, {three[0]}, three, twice, four_times});
      });

  rows.of({StressGroup::kStiff, "weights many decades apart",
           "rows of a least-squares problem scaled apart: elimination without regard to rows loses the ratio in digits",
           "the place of the precise four: GDOP * 8 eps range, and the others' pull of (1 / ratio)^2", "m"});
  for (const double ratio : {1e3, 1e6, 1e9, 1e12}) {
    const std::string name = printed("%.0e", ratio);
    rows.add(std::string("solver/sigma_ratio_") + name + "_precise_first", [ratio] { return weights(ratio, false); });
    rows.add(std::string("solver/sigma_ratio_") + name + "_precise_last", [ratio] { return weights(ratio, true); });
  }

  rows.of(
      {StressGroup::kData, "a range that is wrong by far",
       "the fit goes where the linear test is no longer true, and a good range is excluded in its place",
       "that range alone is excluded, the place that of the others to GDOP * 8 eps range; beyond 1e8 m no fix will do",
       "m"});
  for (const double by : {1e2, 1e4, 1e6, 1e9, -1e6}) {
    const std::string name = printed("%s%.0e", by < 0 ? "minus_" : "", std::abs(by));
    rows.add(std::string("solver/outlier_greedy_") + name + "_m", [by] { return outlier("greedy", by); });
    rows.add(std::string("solver/outlier_leave_one_out_") + name + "_m", [by] { return outlier("leave_one_out", by); });
  }

  rows.of({StressGroup::kData, "ranges that contradict one another by halves",
           "exclusions go on until too few are left to contradict, and what is left is told as a fix",
           "no fix within three exclusions", "fixes"});
  rows.add("solver/two_halves_greedy", [] { return two_halves("greedy"); }).add("solver/two_halves_leave_one_out", [] {
    return two_halves("leave_one_out");
  });

  rows.of({StressGroup::kData, "a range, satellite, sigma or guess that is not finite",
           "NaN compares false everywhere and ends as a position; an infinite sigma is a weight of zero that leaves no "
           "rank",
           "a range refused field by field, of a guess no fix", "otherwise"});
  rows.add("solver/not_finite_field_by_field", not_finite);

  rows.of({StressGroup::kGeometry, "velocity at orbital speed and of great dilution",
           "the light time's stretch neglected; normal equations", "the true velocity to GDOP * 4 eps speed", "m/s"});
  rows.add("solver/velocity_at_rest", [] { return velocity(0.0, 3.0); })
      .add("solver/velocity_at_8_km_s", [] { return velocity(8e3, 3.0); })
      .add("solver/velocity_of_gdop_1e+04", [] { return velocity(30.0, 1e4); })
      .add("solver/velocity_of_gdop_1e+08", [] { return velocity(30.0, 1e8); })
      .loose("where no residual is left the decomposition errs far less than its bound in the worst direction");
  rows.of({StressGroup::kStiff, "velocity of rates with weights many decades apart",
           "a direction that poor rates alone tell is taken for one that none tells, and left at nothing",
           "the true velocity and covariance to 64 eps of the rates times the ratio", "of the bound"});
  for (const double ratio : {1.0, 1e4, 1e10})
    rows.add("solver/velocity_of_weights_1_to_" + stress::text(ratio), [=] { return velocity_of_weights(ratio); });
  return rows.take();
}

}  // namespace canyon::gnss
