// An epoch as a receiver works on it: its codes smoothed, its fix and velocity, and what is filled in.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/earth/earth.h"
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
#include "canyon/gnss/stress/receiver/made_ranges.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using made::kOfSky;
using made::kPlace;
using made::place_in_sky;
using stress::kEpsilon;
using stress::Looks;

/// A smoothed code by the mean of what was measured since it began: with as many epochs as the time constant holds, a
/// running one after that. It begins anew after a gap of more than three intervals or 120 s, a loss of lock, a slip of
/// more than 15 m, an epoch without a phase. Seven roundings of ranges of 2e7 m, of 1.9e-9 m each.
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
      looks.near(found.code_m, mean + in.phase_m + 2.0 * in.ionosphere_m, 1.4e-8);
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
///
/// Views and corrections are those of the fix of the pass before. Ranges without any are up to 28 m off, the place by
/// them by so much of all in their least favourable signs; corrections there by 139 / 2.2e7 of that, the slope of 2 /
/// sin(elevation) at 0.12 rad over the distance; so is the place of the pass before, and the weights' change, 2e-4 of
/// residuals of a metre or two, is less than as much again.
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
    for (const GnssObservation& o : made.observations)
      ranges.push_back({sky.state(o.sv, t)->p_E, o.corrected_m(), o.sigma_m, o.sv.system});
    auto equal = ranges;
    for (RangeMeasurement& r : equal) r.sigma_m = 1.0;
    const RangeFit exact = fit_ranges(ranges, fix.p_A_E, true, 100.0), rough = fit_ranges(equal, at_E, true, 100.0);
    const double before_m = 2.0 * exact.range_gain * 139.0 / 2.2e7 * 28.0 * rough.range_gain;
    for (std::size_t i = 0; i < made.observations.size(); ++i) {
      const GnssObservation& o = made.observations[i];
      const SatelliteState s = *sky.state(o.sv, t);
      const Correction& c = corrections[i];
      const double clock_m = kSpeedOfLight * s.clock_of_band_s(o.band);
      looks.near(o.clock_m, clock_m, 1e-9);
      const double travel = line_of_sight(s.p_E, fix.p_A_E).range_m / kSpeedOfLight;
      // The way there is taken without the Earth's turn: w / c 2.94e7 4.88e6 = 35 m of it, 1.17e-7 s, in which the turn
      // moves places by 2.15 km/s and turns speeds of 3.3 km/s.
      looks.near((o.p_E - turned_by_earth(s.p_E, travel)).norm(), 0.0, 2150.0 * (1.17e-7 + before_m / kSpeedOfLight));
      looks.near((o.v_E - turned_by_earth(s.v_E, travel)).norm(), 0.0, 7.3e-5 * 3300.0 * 1.18e-7);
      const double elevation = horizon.view(t, o.p_E).elevation_rad;
      looks.near(asked[i].receivers_view.elevation_rad, elevation, before_m / 2.2e7 + 64.0 * kEpsilon);
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
      const double corrected_m = 139.0 * before_m / 2.2e7;
      looks.near(o.correction_m, ionosphere_m + 2.0 / std::sin(elevation) + 0.25, corrected_m + 1e-9);
      looks.near(o.corrected_m(), o.pseudorange_m + o.clock_m - o.correction_m, 1e-8);
      looks.near(c.total_m(), o.correction_m, 1e-9);
      double sigma = factor * (0.4 + 0.2 / std::sin(elevation)) + (two || lost ? 0.0 : 0.1 * ionosphere_m) +
                     0.01 * (50.0 - o.cn0_dbhz) + (o.sv.system == GnssSystem::kGlonass ? 0.5 : 0.0);
      if (lost) sigma = std::sqrt(sigma * sigma + ionosphere_m * ionosphere_m);
      looks.near(o.sigma_m, sigma, factor * 0.1 * corrected_m + 1e-9);
      const double wave_m = kSpeedOfLight / carrier_hz(o.sv.system, o.band, s.frequency_channel);
      looks.near(o.rate_m_s, -o.doppler_hz * wave_m + kSpeedOfLight * s.clock_rate, 1e-9);
      rates.push_back({s.p_E, s.v_E, o.rate_m_s, 0.1 * o.sigma_m});
      looks.right(o.used);
    }
    looks.near((fix.p_A_E - exact.p_E).norm(), 0.0, 1e-6);
    looks.near(fix.clock_m, exact.clock_m.front(), 1e-6);
    looks.right(fix.satellites == 10 && fix.dop.gdop == last.dop.gdop);
    const VelocitySolution velocity = solve_velocity(rates, fix.p_A_E, {100.0, 5.0});
    looks.near((fix.v_A_E - velocity.v_E).norm(), 0.0, 1e-9);
    looks.near((fix.velocity_covariance_E - velocity.covariance_E).norm(), 0.0, 1e-9);
    looks.near((fix.v_A_E - v_E).norm(), 0.0, 5.0 * std::sqrt(velocity.covariance_E.trace()));
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
           .mechanism = "an epoch as a receiver works on it",
           .why = "a gain of another satellite, a clock of the other band, a mean that begins too late",
           .expected = "every figure by the sky's own; the mean since it began: roundings, and what the place of the "
                       "pass before is off",
           .unit = "of the bound"});
  rows.add("epochs/smoothed_codes", smoothed_codes)
      .add("epochs/of_one_frequency", [] { return whole_epochs(false, false); })
      .add("epochs/of_one_frequency_reported", [] { return whole_epochs(false, true); })
      .add("epochs/of_two_frequencies", [] { return whole_epochs(true, false); })
      .add("epochs/of_two_frequencies_reported", [] { return whole_epochs(true, true); });
  return rows.take();
}

}  // namespace canyon::gnss
