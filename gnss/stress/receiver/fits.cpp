// Fits of ranges and of rates of several systems, by normal equations written out.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/earth/earth.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/gnss/solver/velocity.h"
#include "canyon/gnss/stress/receiver/made_ranges.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using made::kPlace;
using made::place_in_sky;
using made::some_ranges;
using stress::kEpsilon;
using stress::Looks;

/// Clocks in the order of systems, QZSS with GPS.
std::vector<GnssSystem> clocks_of(const std::vector<RangeMeasurement>& ranges) {
  std::vector<GnssSystem> out;
  for (const RangeMeasurement& r : ranges) out.push_back(r.system == GnssSystem::kQzss ? GnssSystem::kGps : r.system);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// The normal equations of these ranges at a solution.
struct NormalEquations {
  MatrixXd A;  ///< over sigma; the last row is the shared error's prior
  VectorXd b;
  MatrixXd inverse;
  NormalEquations(const std::vector<RangeMeasurement>& ranges, const Vector3d& p_E, const std::vector<double>& clock_m,
                  double shared, bool with_shared) {
    const auto clocks = clocks_of(ranges);
    const auto n = static_cast<Index>(ranges.size()), c = static_cast<Index>(clock_m.size());
    A = MatrixXd::Zero(n + (with_shared ? 1 : 0), 3 + c + (with_shared ? 1 : 0)), b = VectorXd::Zero(A.rows());
    for (Index i = 0; i < n; ++i) {
      const RangeMeasurement& r = ranges[static_cast<std::size_t>(i)];
      const LineOfSight sight = line_of_sight(r.p_E, p_E);
      A.block<1, 3>(i, 0) = -sight.line.transpose() / r.sigma_m;
      double left = r.range_m - sight.range_m - shared * r.shared_m;
      for (Index k = 0; k < c; ++k)
        if (clocks[static_cast<std::size_t>(k)] == (r.system == GnssSystem::kQzss ? GnssSystem::kGps : r.system))
          A(i, 3 + k) = 1.0 / r.sigma_m, left -= clock_m[static_cast<std::size_t>(k)];
      if (with_shared) A(i, 3 + c) = r.shared_m / r.sigma_m;
      b[i] = left / r.sigma_m;
    }
    if (with_shared) A(n, 3 + c) = 1.0, b[n] = -shared;
    inverse = (A.transpose() * A).inverse();
  }
  double grain() const { return 16.0 * kEpsilon * (A.transpose() * A).norm() * inverse.norm(); }
};

/// A fit is where its normal equations pull nowhere, to the micrometre at which the search ends; covariance,
/// redundancies, gain and DOPs are theirs, to 16 epsilons of their condition. Residuals are differences of ranges of
/// 2e7 m, four roundings of 1.9e-9 m, over sigmas of 0.5 m at least.
StressFigure fits_by_normal_equations() {
  Looks looks;
  const Vector3d guess_E = ecef_from_geodetic({0.71, -1.19, 0.0});
  for (std::uint64_t epoch = 0; epoch < 40; ++epoch)
    for (const bool shared : {false, true})
      for (const bool clocks : {true, false}) {
        auto ranges = some_ranges(epoch, 8 + epoch % 5, epoch % 3 == 0, shared);
        if (!clocks)
          for (RangeMeasurement& r : ranges) r.range_m -= 1000.0;
        const RangeFit fit = fit_ranges(ranges, guess_E, clocks, 1e4);
        looks.right(fit.ok && fit.clock_m.size() == (clocks ? clocks_of(ranges).size() : 0));
        if (!fit.ok) continue;
        const NormalEquations now(ranges, fit.p_E, fit.clock_m, fit.shared, shared);
        const auto n = static_cast<Index>(ranges.size());
        looks.near((now.inverse * now.A.transpose() * now.b).norm(), 0.0, 1e-6);
        looks.near(fit.statistic, now.b.squaredNorm(), 2.0 * 1.5e-8 * std::sqrt(1.0 * n) * (1.0 + now.b.norm()));
        const double grain = now.grain();
        looks.right(fit.degrees_of_freedom == static_cast<int>(n) - 3 - static_cast<int>(fit.clock_m.size()));
        looks.right(shared || fit.shared == 0.0);
        double gain = 0.0;
        for (Index i = 0; i < n; ++i) {
          const auto k = static_cast<std::size_t>(i);
          looks.near(fit.weighted[k], now.b[i], 1.5e-8);
          looks.near(fit.residuals_m[k], now.b[i] * ranges[k].sigma_m, 7.6e-9);
          looks.near(fit.redundancy[k], 1.0 - now.A.row(i) * now.inverse * now.A.row(i).transpose(), grain);
          gain += (now.inverse.topRows(3) * now.A.row(i).transpose()).norm() / ranges[k].sigma_m;
        }
        looks.near(fit.range_gain / gain, 1.0, grain);
        looks.near((fit.covariance_E - now.inverse.topLeftCorner(3, 3)).norm(), 0.0,
                   grain * now.inverse.topLeftCorner(3, 3).norm());
        // DOPs: of equal weights, without the shared error.
        auto equal = ranges;
        for (RangeMeasurement& r : equal) r.sigma_m = 1.0, r.shared_m = 0.0;
        const NormalEquations plain(equal, fit.p_E, fit.clock_m, 0.0, false);
        const double of_dop = plain.grain() * fit.dop.gdop;
        const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(fit.p_E));
        const Eigen::Matrix3d enu = R.transpose() * plain.inverse.topLeftCorner(3, 3) * R;
        looks.near(fit.dop.hdop, std::sqrt(enu(0, 0) + enu(1, 1)), of_dop);
        looks.near(fit.dop.vdop, std::sqrt(enu(2, 2)), of_dop);
        looks.near(fit.dop.pdop, std::sqrt(enu.trace()), of_dop);
        const double tdop2 = clocks ? plain.inverse(3, 3) : 0.0;
        looks.near(fit.dop.gdop, std::sqrt(enu.trace() + tdop2), of_dop);
        looks.right(clocks ? std::abs(fit.dop.tdop - std::sqrt(tdop2)) < of_dop : std::isnan(fit.dop.tdop));
        // As the solvers give it out.
        const auto solver = clocks ? make_least_squares({}) : make_trilateration({});
        const PositionSolution s = solver->solve(ranges, guess_E);
        looks.right(s.ok && solver->solves_clock() == clocks && s.p_E == fit.p_E &&
                    s.satellites_used() == static_cast<int>(n));
        looks.right(clocks ? s.clock_m == fit.clock_m.front() : std::isnan(s.clock_m));
        const auto order = clocks_of(ranges);
        for (std::size_t k = 0; k < fit.clock_m.size(); ++k)
          looks.right(s.system_clock_m[static_cast<std::size_t>(order[k])] == fit.clock_m[k]);
        for (std::size_t k = 0; k < ranges.size(); ++k) looks.near(s.residuals_m[k], fit.residuals_m[k], 7.6e-9);
      }
  // Too few, of one system and of more.
  for (std::size_t count = 0; count < 9; ++count) {
    const auto ranges = some_ranges(1, count, false, false), gps = some_ranges(1, count, true, false);
    looks.right(fit_ranges(ranges, guess_E, true, 1e9).ok == (count >= 3 + clocks_of(ranges).size() && count > 0));
    looks.right(fit_ranges(gps, guess_E, true, 1e9).ok == (count >= 4));
    looks.right(fit_ranges(gps, guess_E, false, 1e9).ok == (count >= 3));
    const std::vector<Vector3d> lines(count, Vector3d::UnitX());
    if (count < 3) looks.right(std::isnan(dilution_of_precision(lines, Eigen::Matrix3d::Identity(), false).gdop));
    if (count < 4) looks.right(std::isnan(dilution_of_precision(lines, Eigen::Matrix3d::Identity(), true).gdop));
  }
  return looks.figure();
}

/// Velocities: where the weighted residuals pull nowhere, the outliers one by one left out as long as five remain, the
/// worst by its standardised residual first. Rates are linear in the velocity: 16 epsilons of the condition of their
/// normal equations.
StressFigure velocities() {
  Looks looks;
  const RandomStream draws(34, "stress.epochs");
  const Vector3d at_E = ecef_from_geodetic(kPlace), v_E(12.0, -7.0, 4.0);
  int left_out = 0;
  for (std::uint64_t epoch = 0; epoch < 60; ++epoch) {
    std::vector<RateMeasurement> rates;
    for (std::uint64_t k = 0; k < 5 + epoch % 6; ++k) {
      RateMeasurement m;
      m.p_E = place_in_sky(k, epoch), m.v_E = 3000.0 * draws.direction(4, 16 * epoch + k);
      m.sigma_m_s = draws.uniform(0.02, 0.3, 5, 16 * epoch + k);
      m.rate_m_s = range_rate_m_s(m, at_E, v_E) + 44.0 + m.sigma_m_s * draws.normal(6, 16 * epoch + k) +
                   (k == 1 + epoch % 3 && epoch % 2 == 0 ? 5.0 : 0.0);
      rates.push_back(m);
    }
    for (const double limit : {0.0, 3.0}) {
      const VelocitySolution s = solve_velocity(rates, at_E, {1000.0, limit});
      if (!s.ok) return {stress::kInfinity, 1.0};
      std::vector<std::size_t> members(rates.size());
      for (std::size_t i = 0; i < members.size(); ++i) members[i] = i;
      Eigen::Vector4d x;
      Eigen::Matrix4d inverse;
      double grain = 0.0;
      while (true) {
        const auto n = static_cast<Index>(members.size());
        MatrixXd A(n, 4);
        VectorXd b(n);
        for (Index i = 0; i < n; ++i) {
          const RateMeasurement& m = rates[members[static_cast<std::size_t>(i)]];
          // Linear in the velocity: by differences of 1 km/s.
          const double at_rest = range_rate_m_s(m, at_E, Vector3d::Zero());
          for (int a = 0; a < 3; ++a)
            A(i, a) = (range_rate_m_s(m, at_E, 1000.0 * Vector3d::Unit(a)) - at_rest) / 1000.0 / m.sigma_m_s;
          A(i, 3) = 1.0 / m.sigma_m_s, b[i] = (m.rate_m_s - at_rest) / m.sigma_m_s;
        }
        inverse = (A.transpose() * A).inverse();
        grain = 16.0 * kEpsilon * (A.transpose() * A).norm() * inverse.norm();
        x = inverse * A.transpose() * b;
        const VectorXd left = b - A * x;
        Index worst = -1;
        double most = 0.0;
        for (Index i = 0; i < n; ++i) {
          const double redundancy = 1.0 - A.row(i) * inverse * A.row(i).transpose();
          const double w = redundancy > 1e-6 ? std::abs(left[i]) / std::sqrt(redundancy) : 0.0;
          if (w > most) most = w, worst = i;
        }
        if (limit == 0.0 || n <= 5 || most <= limit) break;
        members.erase(members.begin() + worst), ++left_out;
      }
      looks.near((s.v_E - x.head<3>()).norm(), 0.0, grain * x.norm());
      looks.near(s.clock_drift_m_s, x[3], grain * x.norm());
      looks.near((s.covariance_E - inverse.topLeftCorner<3, 3>()).norm(), 0.0, grain * s.covariance_E.norm());
      for (std::size_t i = 0; i < rates.size(); ++i) {
        looks.right(s.used[i] == (std::find(members.begin(), members.end(), i) != members.end()));
        looks.near(s.residuals_m_s[i], rates[i].rate_m_s - range_rate_m_s(rates[i], at_E, x.head<3>()) - x[3],
                   2.0 * grain * x.norm() + 1e-11);
      }
    }
    // The rate itself: of the length of the way, at receptions 2 ms apart, as the satellite flies and the Earth turns.
    const RateMeasurement& m = rates[0];
    const auto range_at = [&](double dt) {
      double travel = line_of_sight(m.p_E, at_E).range_m / kSpeedOfLight;
      const double at_first = travel;
      for (int k = 0; k < 4; ++k) {
        const Vector3d sent = m.p_E + (dt - (travel - at_first)) * m.v_E;
        travel = (turned_by_earth(sent, travel) - at_E - dt * v_E).norm() / kSpeedOfLight;
      }
      return travel * kSpeedOfLight;
    };
    // Ranges round by 8e-9 m each, over 0.4 s; h^2 / 6 of a third derivative of 3 x (1 - x^2) v^3 / r^2, 1.155 at most,
    // is 4e-7 m/s.
    looks.near(range_rate_m_s(m, at_E, v_E), (range_at(0.2) - range_at(-0.2)) / 0.4, 4.4e-7);
  }
  looks.right(left_out > 15);
  looks.near(pseudorange_rate_m_s(-1000.0, 1575.42e6), 190.293672798, 0.51e-9);
  const VelocityParameters as_it_comes;
  looks.right(as_it_comes.max_gdop == 100.0 && as_it_comes.outlier_sigmas == 0.0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> fit_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "fits of ranges and rates of several systems",
           .why = "a clock of the next system, a redundancy of the wrong row, a DOP with weights",
           .expected = "normal equations written out: they pull nowhere, and their inverse is what is told",
           .unit = "of the bound"});
  rows.add("epochs/fits_by_normal_equations", fits_by_normal_equations).add("epochs/velocities", velocities);
  return rows.take();
}

}  // namespace canyon::gnss
