// An epoch from its pseudoranges to a fix: the fit, faults, velocity, smoothing, and what the receiver fills in.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/LU>

#include "canyon/core/earth/earth.h"
#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/modes/receiver_fix.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/sky_view.h"
#include "canyon/gnss/solver/carrier_smoothing.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/gnss/solver/velocity.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using stress::kEpsilon;
using stress::Looks;

const Geodetic kPlace{0.7, -1.2, 300.0};

double power2(double x) {
  return x * x;
}

constexpr GnssSystem kOfSky[] = {GnssSystem::kGps,     GnssSystem::kGlonass, GnssSystem::kGps,  GnssSystem::kGalileo,
                                 GnssSystem::kGlonass, GnssSystem::kGps,     GnssSystem::kQzss, GnssSystem::kGalileo,
                                 GnssSystem::kGps,     GnssSystem::kBeidou,  GnssSystem::kGps,  GnssSystem::kBeidou};

Vector3d place_in_sky(std::uint64_t k, std::uint64_t of) {
  const RandomStream draws(31, "stress.epochs");
  const Vector3d at_E = ecef_from_geodetic(kPlace);
  const double e = draws.uniform(0.12, 1.5, static_cast<std::uint32_t>(k), of), a = 2.4 * static_cast<double>(k);
  return at_E + 2.3e7 * (rotation_E_from_enu(kPlace) *
                         Vector3d(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)));
}

std::vector<RangeMeasurement> some_ranges(std::uint64_t epoch, std::size_t count, bool one_system, bool shared) {
  const RandomStream draws(32, "stress.epochs");
  const Vector3d at_E = ecef_from_geodetic(kPlace);
  std::vector<RangeMeasurement> out;
  for (std::uint64_t k = 0; k < count; ++k) {
    RangeMeasurement r;
    r.p_E = place_in_sky(k, epoch);
    r.system = one_system ? GnssSystem::kGps : kOfSky[k];
    r.sigma_m = draws.uniform(0.5, 4.0, 0, 16 * epoch + k);
    r.shared_m = shared ? draws.uniform(0.5, 3.0, 1, 16 * epoch + k) : 0.0;
    r.range_m = line_of_sight(r.p_E, at_E).range_m + 1000.0 +
                70.0 * static_cast<double>(r.system == GnssSystem::kQzss ? GnssSystem::kGps : r.system) +
                r.sigma_m * draws.normal(2, 16 * epoch + k);
    out.push_back(r);
  }
  return out;
}

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
};

/// A fit is where its normal equations pull nowhere, to the micrometre at which the search ends; covariance,
/// redundancies, gain and DOPs are theirs: 1e-9 of a condition of 1e3.
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
        looks.near(fit.statistic, now.b.squaredNorm(), 1e-7 * (1.0 + now.b.squaredNorm()));
        looks.right(fit.degrees_of_freedom == static_cast<int>(n) - 3 - static_cast<int>(fit.clock_m.size()));
        looks.right(shared || fit.shared == 0.0);
        double gain = 0.0;
        for (Index i = 0; i < n; ++i) {
          const auto k = static_cast<std::size_t>(i);
          looks.near(fit.weighted[k], now.b[i], 1e-7);
          looks.near(fit.residuals_m[k], now.b[i] * ranges[k].sigma_m, 1e-6);
          looks.near(fit.redundancy[k], 1.0 - now.A.row(i) * now.inverse * now.A.row(i).transpose(), 1e-9);
          gain += (now.inverse.topRows(3) * now.A.row(i).transpose()).norm() / ranges[k].sigma_m;
        }
        looks.near(fit.range_gain / gain, 1.0, 1e-9);
        looks.near((fit.covariance_E - now.inverse.topLeftCorner(3, 3)).norm(), 0.0,
                   1e-9 * now.inverse.topLeftCorner(3, 3).norm());
        // DOPs: of equal weights, without the shared error.
        auto equal = ranges;
        for (RangeMeasurement& r : equal) r.sigma_m = 1.0, r.shared_m = 0.0;
        const NormalEquations plain(equal, fit.p_E, fit.clock_m, 0.0, false);
        const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(fit.p_E));
        const Eigen::Matrix3d enu = R.transpose() * plain.inverse.topLeftCorner(3, 3) * R;
        looks.near(fit.dop.hdop, std::sqrt(enu(0, 0) + enu(1, 1)), 1e-8 * fit.dop.gdop);
        looks.near(fit.dop.vdop, std::sqrt(enu(2, 2)), 1e-8 * fit.dop.gdop);
        looks.near(fit.dop.pdop, std::sqrt(enu.trace()), 1e-8 * fit.dop.gdop);
        const double tdop2 = clocks ? plain.inverse(3, 3) : 0.0;
        looks.near(fit.dop.gdop, std::sqrt(enu.trace() + tdop2), 1e-8 * fit.dop.gdop);
        looks.right(clocks ? std::abs(fit.dop.tdop - std::sqrt(tdop2)) < 1e-8 * fit.dop.gdop
                           : std::isnan(fit.dop.tdop));
        // As the solvers give it out.
        const auto solver = clocks ? make_least_squares({}) : make_trilateration({});
        const PositionSolution s = solver->solve(ranges, guess_E);
        looks.right(s.ok && solver->solves_clock() == clocks && s.p_E == fit.p_E &&
                    s.satellites_used() == static_cast<int>(n));
        looks.right(clocks ? s.clock_m == fit.clock_m.front() : std::isnan(s.clock_m));
        const auto order = clocks_of(ranges);
        for (std::size_t k = 0; k < fit.clock_m.size(); ++k)
          looks.right(s.system_clock_m[static_cast<std::size_t>(order[k])] == fit.clock_m[k]);
        for (std::size_t k = 0; k < ranges.size(); ++k) looks.near(s.residuals_m[k], fit.residuals_m[k], 1e-6);
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

/// Faults left out as each method says, by fits of every subset: the largest standardised residual first, or the one
/// without which the rest fits best, until the chi-square test passes; refused where none helps.
StressFigure faults_left_out() {
  int wrong = 0, repaired = 0, failed = 0;
  const RandomStream draws(33, "stress.epochs");
  const Vector3d at_E = ecef_from_geodetic(kPlace);
  for (std::uint64_t epoch = 0; epoch < 40; ++epoch)
    for (const std::string method : {"none", "detect", "greedy", "leave_one_out"}) {
      auto ranges = some_ranges(epoch, 9 + epoch % 4, epoch % 2 == 0, false);
      for (std::uint64_t i = 0; i < epoch % 4; ++i)
        ranges[(3 * i + epoch) % ranges.size()].range_m += draws.uniform(20.0, 90.0, 3, 8 * epoch + i);
      PositionSolverParameters p;
      p.fault_exclusion = method, p.false_alarm = 1e-3, p.max_exclusions = 2;
      const PositionSolution s = make_least_squares(p)->solve(ranges, at_E);
      std::vector<std::size_t> members(ranges.size());
      for (std::size_t i = 0; i < members.size(); ++i) members[i] = i;
      const auto fit_of = [&](const std::vector<std::size_t>& some) {
        std::vector<RangeMeasurement> subset;
        for (const std::size_t i : some) subset.push_back(ranges[i]);
        return fit_ranges(subset, at_E, true, p.max_gdop);
      };
      const auto without = [](std::vector<std::size_t> some, std::size_t i) {
        some.erase(some.begin() + static_cast<std::ptrdiff_t>(i));
        return some;
      };
      RangeFit fit = fit_of(members);
      const auto passes = [&] { return fit.statistic <= chi_square_threshold(1e-3, fit.degrees_of_freedom); };
      bool good = method == "none" || passes();
      const bool at_once = good;
      for (int round = 0; round < 2 && !good && method != "detect"; ++round) {
        std::size_t out = members.size();
        double best = method == "greedy" ? 0.0 : 1e300;
        for (std::size_t i = 0; i < members.size(); ++i) {
          if (fit.redundancy[i] < 1e-6) continue;
          if (method == "greedy") {
            const double w2 = power2(fit.weighted[i]) / fit.redundancy[i];
            if (w2 > best) best = w2, out = i;
          } else if (const RangeFit one = fit_of(without(members, i)); one.ok && one.statistic < best) {
            best = one.statistic, out = i;
          }
        }
        if (out == members.size()) break;
        members = without(members, out);
        fit = fit_of(members);
        if (!fit.ok || fit.degrees_of_freedom < 1) break;
        good = passes();
      }
      wrong += s.ok == good ? 0 : 1;
      using Status = IntegrityTest::Status;
      const Status expected = method == "none" ? Status::kNotTested
                              : at_once        ? Status::kPassed
                              : good           ? Status::kRepaired
                                               : Status::kFailed;
      wrong += s.integrity.status == expected ? 0 : 1;
      repaired += expected == Status::kRepaired ? 1 : 0, failed += expected == Status::kFailed ? 1 : 0;
      if (!s.ok || !good) continue;
      for (std::size_t i = 0; i < ranges.size(); ++i)
        wrong += s.used[i] == (std::find(members.begin(), members.end(), i) != members.end()) ? 0 : 1;
      wrong += (s.p_E - fit.p_E).norm() < 1e-6 ? 0 : 1;
    }
  wrong += repaired > 15 && failed > 10 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Velocities: where the weighted residuals pull nowhere, the outliers one by one left out as long as five remain, the
/// worst by its standardised residual first. Rates are linear in the velocity, 1e-9 of their condition.
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
      looks.near((s.v_E - x.head<3>()).norm(), 0.0, 1e-7), looks.near(s.clock_drift_m_s, x[3], 1e-7);
      looks.near((s.covariance_E - inverse.topLeftCorner<3, 3>()).norm(), 0.0, 1e-7 * s.covariance_E.norm());
      for (std::size_t i = 0; i < rates.size(); ++i) {
        looks.right(s.used[i] == (std::find(members.begin(), members.end(), i) != members.end()));
        looks.near(s.residuals_m_s[i], rates[i].rate_m_s - range_rate_m_s(rates[i], at_E, x.head<3>()) - x[3], 1e-6);
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
    // Ranges round by 4e-9 m, over 0.4 s; curvature cancels, h^2 / 6 of a third derivative v^3 / r^2 is below 1e-5 m/s.
    looks.near(range_rate_m_s(m, at_E, v_E), (range_at(0.2) - range_at(-0.2)) / 0.4, 1e-6);
  }
  looks.right(left_out > 15);
  looks.near(pseudorange_rate_m_s(-1000.0, 1575.42e6), 190.293672798, 1e-8);
  const VelocityParameters as_it_comes;
  looks.right(as_it_comes.max_gdop == 100.0 && as_it_comes.outlier_sigmas == 0.0);
  return looks.figure();
}

/// A smoothed code by the mean of what was measured since it began: with as many epochs as the time constant holds, a
/// running one after that. It begins anew after a gap of more than three intervals or 120 s, a loss of lock, a slip of
/// more than 15 m, an epoch without a phase. 1e-8 m of ranges of 2e7 m.
StressFigure smoothed_codes() {
  Looks looks;
  const RandomStream draws(35, "stress.epochs");
  for (const double tau_s : {0.0, 5.0, 60.0}) {
    CarrierSmoothing smoothing(tau_s);
    const SatelliteId sv{GnssSystem::kGalileo, 4};
    double t_s = 0.0, mean = 0.0, count = 0.0, before_s = 0.0, step_before_s = 0.0;
    for (std::uint64_t k = 0; k < 400; ++k) {
      const double step_s = k % 97 == 50 ? 5.0 : k % 97 == 80 ? 130.0 : k % 97 == 20 ? 2.9 : 1.0;
      t_s += step_s;
      CarrierSmoothing::Input in;
      const double range_m = 2.2e7 + 500.0 * t_s;
      in.ionosphere_m = 4.0 + 0.02 * t_s;
      in.code_m = range_m + in.ionosphere_m + 0.5 * draws.normal(7, k) + (k % 61 == 30 ? 17.5 : 0.0);
      in.phase_m = k % 83 == 40 ? kNaN : range_m - in.ionosphere_m + 1234.5;
      in.loss_of_lock = k % 71 == 33;
      const auto found = smoothing.smooth(sv, GpsTime::from_week_sow(2000, t_s), in);
      if (tau_s == 0.0 || std::isnan(in.phase_m)) {
        looks.right(found.code_m == in.code_m && found.averaged == 1.0);
        count = 0.0;
        continue;
      }
      const double gap_s = t_s - before_s, off = in.code_m - in.phase_m - 2.0 * in.ionosphere_m;
      const bool anew = count == 0.0 || in.loss_of_lock || gap_s > 120.0 ||
                        (step_before_s > 0.0 && gap_s > 3.0 * step_before_s) || std::abs(off - mean) > 15.0;
      step_before_s = anew ? 0.0 : gap_s;
      const double most = tau_s / gap_s > 1.0 ? tau_s / gap_s : 1.0;
      count = anew ? 1.0 : count + 1.0 < most ? count + 1.0 : most;
      mean = anew ? off : mean * (1.0 - 1.0 / count) + off / count;
      before_s = t_s;
      looks.near(found.code_m, mean + in.phase_m + 2.0 * in.ionosphere_m, 1e-7);
      looks.near(found.averaged, count, 1e-12);
    }
    // The same instant again begins anew.
    const CarrierSmoothing::Input again{100.0, 50.0, 0.0, false};
    looks.right(smoothing.smooth(sv, GpsTime::from_week_sow(2000, t_s), again).code_m == 100.0);
  }
  return looks.figure();
}

/// Satellites that stand where place_in_sky() has them, each with a clock, its rate, delays of bands and a speed.
class StandingSky final : public Constellation {
 public:
  explicit StandingSky(std::uint64_t epoch) : epoch_(epoch) {
    for (std::uint8_t k = 0; k < 10; ++k) all_.push_back({kOfSky[k], static_cast<std::uint8_t>(k + 1)});
    std::sort(all_.begin(), all_.end());
  }
  const std::vector<SatelliteId>& satellites() const override { return all_; }
  std::optional<SatelliteState> state(SatelliteId sv, GpsTime) const override {
    SatelliteState s;
    const double k = sv.prn;
    s.p_E = place_in_sky(sv.prn - 1U, epoch_), s.v_E = Vector3d(1000.0 + 100.0 * k, -900.0, 300.0 * k);
    s.clock_s = 1e-5 * k, s.clock_rate = 1e-11 * k;
    s.group_delay_s[1] = 1e-9 * k, s.group_delay_s[2] = 3e-9 * k, s.group_delay_s[5] = -2e-9 * k,
    s.group_delay_s[7] = 4e-9;
    s.frequency_channel = sv.system == GnssSystem::kGlonass ? static_cast<int>(sv.prn) - 3 : 0;
    return s;
  }

 private:
  std::uint64_t epoch_;
  std::vector<SatelliteId> all_;
};

/// Subtracts a figure of its own for each satellite, and the ionosphere that two frequencies tell.
class ToldMode final : public ReceiverMode {
 public:
  explicit ToldMode(bool dual) : dual_(dual) {}
  Correction correction(const CorrectionInput& in) const override {
    Correction c;
    c.modelled.ionosphere_m = in.two ? in.two->gain * in.two->measured_m : 6.0 + 0.5 * in.sv.prn;
    c.modelled.troposphere_m = 2.0 / std::sin(in.receivers_view.elevation_rad);
    c.base_m = 0.25;
    return c;
  }
  FixStatus status() const override { return FixStatus::kDifferential; }
  bool dual_frequency() const override { return dual_; }
  bool corrects_atmosphere() const override { return true; }

 private:
  bool dual_;
};

class ToldWeighting final : public RangeWeighting {
 public:
  double sigma_m(const RangeQuality& q) const override {
    return q.code_factor * (0.4 + 0.2 / std::sin(q.elevation_rad)) + 0.1 * q.ionosphere_m + 0.01 * (50.0 - q.cn0_dbhz) +
           (q.system == GnssSystem::kGlonass ? 0.5 : 0.0);
  }
};

/// One epoch as a receiver works on it, some satellites with two frequencies and some with one: every figure of every
/// observation by the sky's own, the fix by its normal equations, velocity by its own, and what is withheld.
StressFigure whole_epochs(bool dual, bool reported) {
  Looks looks;
  const RandomStream draws(36, "stress.epochs");
  const Vector3d at_E = ecef_from_geodetic(kPlace), v_E(3.0, 5.0, -2.0);
  const GpsTime t = GpsTime::from_week_sow(2222, 5000.0);
  for (std::uint64_t epoch_no = 0; epoch_no < 12; ++epoch_no) {
    const StandingSky sky(epoch_no);
    const ToldMode mode(dual);
    const ToldWeighting weighting;
    const auto solver = make_least_squares({});
    GnssEpoch epoch;
    epoch.t = t + 1e-5;
    std::vector<CorrectionInput> inputs;
    for (const SatelliteId sv : sky.satellites()) {
      const SatelliteState s = *sky.state(sv, t);
      GnssObservation o;
      o.sv = sv, o.band = sv.system == GnssSystem::kBeidou ? 2 : 1, o.cn0_dbhz = 35.0 + sv.prn;
      const double ionosphere_m = 6.0 + 0.5 * sv.prn, range_m = line_of_sight(s.p_E, at_E).range_m;
      const double elevation = Horizon(at_E).view(t, turned_by_earth(s.p_E, range_m / kSpeedOfLight)).elevation_rad;
      const double common_m = range_m + 3000.0 + 2.0 / std::sin(elevation) + 0.25;
      o.pseudorange_m = common_m - kSpeedOfLight * s.clock_of_band_s(o.band) + ionosphere_m +
                        0.3 * draws.normal(8, 16 * epoch_no + sv.prn);
      const RateMeasurement m{s.p_E, s.v_E, 0.0, 1.0};
      const double carrier = carrier_hz(sv.system, o.band, s.frequency_channel);
      const double rate_m_s = range_rate_m_s(m, at_E, v_E) + 20.0 + 0.02 * draws.normal(9, 16 * epoch_no + sv.prn);
      o.doppler_hz = -(rate_m_s - kSpeedOfLight * s.clock_rate) * carrier / kSpeedOfLight;
      CorrectionInput in;
      in.sv = sv, in.t = t;
      if (dual && (sv.prn + epoch_no) % 4 != 0) {
        o.second.band = sv.system == GnssSystem::kGalileo ? 7 : sv.system == GnssSystem::kBeidou ? 7 : 2;
        const double ratio = carrier / carrier_hz(sv.system, o.second.band, s.frequency_channel);
        o.second.pseudorange_m =
            common_m - kSpeedOfLight * s.clock_of_band_s(o.second.band) + ionosphere_m * ratio * ratio;
        in.two.emplace();
        in.two->gain = 1.0 / (ratio * ratio - 1.0);
      }
      epoch.observations.push_back(o), inputs.push_back(in);
    }
    const auto errors = *ModelChoice<reported_covariances>("residual_inflated").make("stress");
    ReceiverParts receiver{sky, mode, *solver, weighting, 100.0, ecef_from_geodetic({0.7003, -1.2002, 0.0})};
    if (reported) receiver.output.errors = errors.get();
    std::vector<Correction> corrections;
    PositionSolution last;
    GnssEpoch made = epoch;
    auto asked = inputs;
    const GnssFix fix = compute_fix(receiver, t, made, asked, corrections, &last);
    looks.right(fix.status == FixStatus::kDifferential && fix.t == t && last.ok);
    if (!last.ok) continue;
    // As near as the noise lets it be, of which more is assumed than there is.
    looks.near((fix.p_A_E - at_E).norm(), 0.0, 5.0 * std::sqrt(last.covariance_E.trace()));
    std::vector<RangeMeasurement> ranges;
    std::vector<RateMeasurement> rates;
    const Horizon horizon(fix.p_A_E);
    for (std::size_t i = 0; i < made.observations.size(); ++i) {
      const GnssObservation& o = made.observations[i];
      const SatelliteState s = *sky.state(o.sv, t);
      const Correction& c = corrections[i];
      const double clock_m = kSpeedOfLight * s.clock_of_band_s(o.band);
      looks.near(o.clock_m, clock_m, 1e-9);
      const double travel = line_of_sight(s.p_E, fix.p_A_E).range_m / kSpeedOfLight;
      // Views and places by the fix of the pass before, a few metres off, and the way there without the Earth's turn:
      // 45 m of it, 1.5e-7 s at 1.9 km/s.
      looks.near((o.p_E - turned_by_earth(s.p_E, travel)).norm(), 0.0, 3e-4);
      looks.near((o.v_E - turned_by_earth(s.v_E, travel)).norm(), 0.0, 1e-7);
      const double elevation = horizon.view(t, o.p_E).elevation_rad;
      looks.near(asked[i].receivers_view.elevation_rad, elevation, 1e-6);
      looks.right(asked[i].two.has_value() == inputs[i].two.has_value());
      const bool two = inputs[i].two.has_value(), lost = dual && !two;
      double ionosphere_m = 6.0 + 0.5 * o.sv.prn, factor = 1.0;
      if (two) {
        const double gain = inputs[i].two->gain;
        const double difference =
            o.second.pseudorange_m + kSpeedOfLight * s.clock_of_band_s(o.second.band) - o.pseudorange_m - clock_m;
        looks.near(asked[i].two->measured_m, difference, 1e-7);
        ionosphere_m = gain * difference, factor = std::sqrt((1.0 + gain) * (1.0 + gain) + gain * gain);
      }
      // 10 m beside the fix change an elevation by 4e-7 rad, and 2 / sin of one of 0.12 rad by 140 times that.
      looks.near(o.correction_m, ionosphere_m + 2.0 / std::sin(elevation) + 0.25, 6e-5);
      looks.near(o.corrected_m(), o.pseudorange_m + o.clock_m - o.correction_m, 1e-8);
      looks.near(c.total_m(), o.correction_m, 1e-9);
      double sigma = factor * (0.4 + 0.2 / std::sin(elevation)) + (two || lost ? 0.0 : 0.1 * ionosphere_m) +
                     0.01 * (50.0 - o.cn0_dbhz) + (o.sv.system == GnssSystem::kGlonass ? 0.5 : 0.0);
      if (lost) sigma = std::sqrt(sigma * sigma + ionosphere_m * ionosphere_m);
      looks.near(o.sigma_m, sigma, 6e-5);
      const double wave_m = kSpeedOfLight / carrier_hz(o.sv.system, o.band, s.frequency_channel);
      looks.near(o.rate_m_s, -o.doppler_hz * wave_m + kSpeedOfLight * s.clock_rate, 1e-9);
      ranges.push_back({s.p_E, o.corrected_m(), o.sigma_m, o.sv.system});
      rates.push_back({s.p_E, s.v_E, o.rate_m_s, 0.1 * o.sigma_m});
      looks.right(o.used);
    }
    const RangeFit exact = fit_ranges(ranges, fix.p_A_E, true, 100.0);
    looks.near((fix.p_A_E - exact.p_E).norm(), 0.0, 1e-6);
    looks.near(fix.clock_m, exact.clock_m.front(), 1e-6);
    looks.right(fix.satellites == 10 && fix.dop.gdop == last.dop.gdop);
    const VelocitySolution velocity = solve_velocity(rates, fix.p_A_E, {100.0, 5.0});
    looks.near((fix.v_A_E - velocity.v_E).norm(), 0.0, 1e-9);
    looks.near((fix.velocity_covariance_E - velocity.covariance_E).norm(), 0.0, 1e-9);
    looks.near((fix.v_A_E - v_E).norm(), 0.0, 5.0);
    Eigen::Matrix3d claimed = exact.covariance_E;
    if (reported) {
      std::vector<RangeSignal> signals;
      for (std::size_t i = 0; i < made.observations.size(); ++i) {
        const double gain = inputs[i].two ? inputs[i].two->gain : 0.0;
        signals.push_back(
            {made.observations[i].sv.entity(), made.observations[i].cn0_dbhz, std::hypot(1.0 + gain, gain)});
      }
      claimed = covariance_of_fit(ranges, errors->sigma_m(evidence_of(ranges, signals, last)), last);
    }
    looks.near((fix.covariance_E - claimed).norm(), 0.0, 1e-7 * claimed.norm());
    // What nobody tests holds, as long as there is a solution and its geometry is good enough.
    looks.right(decisions_hold(last, made, 1e3, 1.02 * last.dop.gdop) &&
                !decisions_hold(last, made, 0.0, last.dop.gdop));
    looks.right(!decisions_hold(PositionSolution{}, made, 0.0, 1e9));
    // Given out, or not.
    const double sigma_m = std::sqrt(fix.covariance_E.trace());
    for (const auto& [fewest, limit_m, given] :
         {std::tuple{10, 0.0, true}, {11, 0.0, false}, {0, 1.01 * sigma_m, true}, {0, 0.99 * sigma_m, false}}) {
      receiver.output.fewest_satellites = fewest, receiver.output.accuracy_limit_m = limit_m;
      GnssEpoch other = epoch;
      auto others = inputs;
      const GnssFix out = compute_fix(receiver, t, other, others, corrections);
      looks.right((out.status != FixStatus::kNone) == given && out.reason.empty() == given && out.t == t);
      looks.right(out.dop.gdop == fix.dop.gdop && other.observations[3].used == given);
      if (!given) looks.right(std::isnan(out.p_A_E.x()) && out.satellites == 0);
    }
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> epoch_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "fits of ranges and rates of several systems",
           .why = "a clock of the next system, a redundancy of the wrong row, a DOP with weights",
           .expected = "normal equations written out: they pull nowhere, and their inverse is what is told",
           .unit = "of the bound",
           .loose = "the last step of a search is far smaller than the one that ends it"});
  rows.add("epochs/fits_by_normal_equations", fits_by_normal_equations).add("epochs/velocities", velocities);
  rows.of({StressGroup::kData, "faults that are left out", "the best for the worst, one exclusion too many",
           "each method by fits of all subsets: exact", "wrong"});
  rows.add("epochs/faults_left_out", faults_left_out);
  rows.of(
      {.group = StressGroup::kData,
       .mechanism = "an epoch as a receiver works on it",
       .why = "a gain of another satellite, a clock of the other band, a mean that begins too late",
       .expected = "every figure by the sky's own; the mean since it began: roundings, and metres of the place before",
       .unit = "of the bound",
       .loose = "what a few metres of a place may change is more than they do"});
  rows.add("epochs/smoothed_codes", smoothed_codes)
      .add("epochs/of_one_frequency", [] { return whole_epochs(false, false); })
      .add("epochs/of_one_frequency_reported", [] { return whole_epochs(false, true); })
      .add("epochs/of_two_frequencies", [] { return whole_epochs(true, false); })
      .add("epochs/of_two_frequencies_reported", [] { return whole_epochs(true, true); });
  return rows.take();
}

}  // namespace canyon::gnss
