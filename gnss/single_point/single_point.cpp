#include "canyon/gnss/single_point/single_point.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/solver/pvt_filter.h"
#include "canyon/gnss/solver/velocity.h"

namespace canyon::gnss {
namespace {

constexpr double kOutlierSigmas = 5.0;  // of Dopplers

/// The figures in a reason differ from epoch to epoch; what is counted is the kind.
std::string kind_of(const std::string& reason) {
  return reason.substr(0, reason.find(':'));
}

class SinglePoint {
 public:
  /// `base`: null without one.
  SinglePoint(const ObservationFile& file, const SinglePointInputs& inputs, const SinglePointConfig& config,
              const BaseDifferences* base)
      : file_(file), inputs_(inputs), config_(config), base_(base), observer_(file, inputs, config, base != nullptr) {
    report_ = *config.reported_covariance.make("reported_covariance");  // the name was checked when it was read
    PositionSolverParameters p;
    p.max_gdop = config.max_gdop;
    rough_ = make_least_squares(p);
    p.fault_exclusion = config.fault_exclusion;
    p.false_alarm = config.false_alarm;
    p.max_exclusions = static_cast<int>(config.max_exclusions);
    solver_ = make_least_squares(p);
    p.false_alarm = 1e-6;
    rough_robust_ = make_least_squares(p);
    if (config.estimator == Estimator::kKalman) {
      PvtFilterParameters f;
      f.acceleration_m_s2 = config.acceleration_m_s2;
      f.start.max_gdop = config.max_gdop;
      f.start.fault_exclusion = config.fault_exclusion;
      f.start.false_alarm = config.false_alarm;
      f.start.max_exclusions = static_cast<int>(config.max_exclusions);
      filter_.emplace(f);
    }
    if (file.header.approx_position_E) guess_E_ = *file.header.approx_position_E;
  }

  /// Errors: see solve_observations().
  Result<SinglePointResult> run() {
    SinglePointResult out;
    for (const auto& epoch : file_.epochs) {
      throw_if_cancelled();
      out.epochs.push_back(solve(epoch));
      const auto& fix = out.epochs.back().fix;
      if (fix.status == FixStatus::kNone) ++out.reasons[kind_of(fix.reason)];
    }
    out.warnings = observer_.warnings();
    CANYON_TRY_STATUS(observer_.anything_usable());
    if (base_ != nullptr && with_base_ == 0) return lonely();
    return out;
  }

 private:
  Error lonely() const {
    const std::string span = file_.epochs.front().t.iso(0) + " to " + file_.epochs.back().t.iso(0);
    const std::string& name = inputs_.base->observations.name;
    if (near_base_ > 0)
      return Error{name, 0, "", "has no satellite in common with " + file_.name + " from " + span,
                   "a base near by that observed the same systems and bands"};
    return Error{name, 0, "",
                 "has epochs from " + base_->epochs.front().t.iso(0) + " to " + base_->epochs.back().t.iso(0) +
                     ", none near those of " + file_.name + ", " + span,
                 "a base that observed at the same time"};
  }

  /// Leaves those that the base has at that time; none, and false, if the base has no such time.
  bool take_differences(GpsTime t, std::vector<ObservedRange>& candidates) {
    if (base_ == nullptr) return true;
    const BaseDifferences::Epoch* now = base_->near(t, config_.base_age_s);
    if (now == nullptr) {
      candidates.clear();
      return false;
    }
    ++near_base_;
    std::erase_if(candidates, [&](ObservedRange& c) {
      const auto of = now->satellites.find(c.sv);
      if (of == now->satellites.end() || of->second.band != c.signal.code.band - '0') return true;
      c.base_m = of->second.m;
      c.base_sigma_m = base_code_sigma_m(of->second.elevation_rad);
      return false;
    });
    with_base_ += static_cast<std::int64_t>(candidates.size());
    return true;
  }

  SinglePointEpoch solve(const ObservationEpoch& epoch) {
    SinglePointEpoch out;
    out.fix.t = epoch.t;
    out.epoch.t = epoch.t;
    std::vector<ObservedRange> candidates = observer_.usable(epoch);
    const bool corrected = take_differences(epoch.t, candidates);
    Eigen::Vector3d at_E = guess_E_;
    const PositionSolution rough = rough_position(candidates, at_E);
    if (!rough.ok) {
      out.fix.dop = rough.dop;
      out.fix.reason = corrected ? rough.reason : "the base observed nothing near that time";
      bridge(candidates, out);
      return out;
    }
    at_E = rough.p_E;
    observer_.smooth(candidates, epoch, at_E);

    // Corrected for elevations at the position before, until it stays: a metre moves a delay by less than 1e-6 m.
    constexpr int kPasses = 6;
    PositionSolution solution;
    std::vector<RangeMeasurement> ranges;
    for (int pass = 0; pass < kPasses; ++pass) {
      observer_.correct(candidates, epoch.t, at_E, out.epoch, ranges);
      solution = (pass == 0 ? *rough_ : *solver_).solve(ranges, at_E);
      if (!solution.ok) break;
      const double moved_m = (solution.p_E - at_E).norm();
      at_E = solution.p_E;
      if (pass > 0 && moved_m < 0.1) break;
    }
    out.fix.dop = solution.dop;
    out.fix.reason = solution.reason;
    out.integrity = solution.integrity;
    if (!solution.ok) {
      bridge(candidates, out);
      return out;
    }
    fill(solution, out);
    if (!report_->as_assumed())
      out.fix.covariance_E = covariance_of_fit(
          ranges, report_->sigma_m(evidence_of(ranges, signals_of(candidates, out.epoch), solution)), solution);
    guess_E_ = solution.p_E;
    if (filter_) {
      filter(candidates, ranges, solution.p_E, out);
      return out;
    }
    const auto velocity =
        solve_velocity(rates_of(candidates, out.epoch), solution.p_E, {config_.max_gdop, kOutlierSigmas});
    if (velocity.ok) {
      out.fix.v_A_E = velocity.v_E;
      out.fix.velocity_covariance_E = velocity.covariance_E;
    }
    return out;
  }

  static RangeMeasurement uncorrected(const ObservedRange& c, double sigma_m) {
    return {c.state.p_E, c.code.pseudorange_m + kSpeedOfLight * (c.state.clock_s - c.group_delay_s), sigma_m,
            c.sv.system};
  }

  /// Without corrections, which need elevations: the atmosphere counts as noise. A satellite with a gross error would
  /// spoil the elevations, so it is left out here already.
  PositionSolution rough_position(const std::vector<ObservedRange>& candidates, const Eigen::Vector3d& guess_E) const {
    constexpr double kAtmosphereM = 30.0;
    std::vector<RangeMeasurement> ranges;
    for (const auto& c : candidates) ranges.push_back(uncorrected(c, kAtmosphereM));
    const auto solution = rough_robust_->solve(ranges, guess_E);
    return solution.ok ? solution : rough_->solve(ranges, guess_E);
  }

  FixStatus status() const { return base_ != nullptr ? FixStatus::kDifferential : FixStatus::kSingle; }

  static std::vector<RangeSignal> signals_of(const std::vector<ObservedRange>& candidates, const GnssEpoch& epoch) {
    std::vector<RangeSignal> out;
    for (const auto& o : epoch.observations)
      for (const auto& c : candidates)
        if (c.sv == o.sv) out.push_back({o.sv.entity(), o.cn0_dbhz, c.code.noise_factor});
    return out;
  }

  void fill(const PositionSolution& solution, SinglePointEpoch& out) const {
    GnssFix& fix = out.fix;
    fix.status = status();
    fix.p_A_E = solution.p_E;
    fix.covariance_E = solution.covariance_E;
    fix.clock_m = solution.clock_m;
    fix.satellites = solution.satellites_used();
    out.residuals_m = solution.residuals_m;
    for (std::size_t i = 0; i < out.epoch.observations.size(); ++i) out.epoch.observations[i].used = solution.used[i];
    out.excluded = static_cast<int>(out.epoch.observations.size()) - fix.satellites;
  }

  /// From the Dopplers of the satellites in use.
  std::vector<RateMeasurement> rates_of(const std::vector<ObservedRange>& candidates, const GnssEpoch& epoch) const {
    std::vector<RateMeasurement> rates;
    for (const auto& o : epoch.observations) {
      if (!o.used || !std::isfinite(o.doppler_hz)) continue;
      for (const auto& c : candidates) {
        if (c.sv != o.sv) continue;
        // Tracking of a carrier worsens as that of the code does.
        const double sigma_m_s = config_.doppler_sigma_m_s * o.sigma_m / config_.sigma_m;
        rates.push_back({c.state.p_E, c.state.v_E, o.rate_m_s, sigma_m_s});
      }
    }
    return rates;
  }

  /// Puts the filter's solution in the place of the epoch's own, if there is one. The filter is given all ranges: what
  /// it expects tells a fault better than one epoch's residuals.
  void filter(const std::vector<ObservedRange>& candidates, const std::vector<RangeMeasurement>& ranges,
              const Eigen::Vector3d& at_E, SinglePointEpoch& out) {
    const std::vector<GnssObservation> own = out.epoch.observations;
    for (auto& o : out.epoch.observations) o.used = true;
    const std::vector<RangeSignal> signals = signals_of(candidates, out.epoch);
    const PvtFilter::Report report{*report_, signals};
    const PvtFilter::Estimate e = filter_->update(out.fix.t, ranges, rates_of(candidates, out.epoch), at_E, &report);
    const auto used = std::count(e.ranges_used.begin(), e.ranges_used.end(), true);
    if (!e.ok || used == 0) {
      out.epoch.observations = own;
      return;
    }
    for (std::size_t i = 0; i < ranges.size(); ++i) out.epoch.observations[i].used = e.ranges_used[i];
    out.fix.satellites = static_cast<int>(used);
    out.excluded = static_cast<int>(ranges.size()) - out.fix.satellites;
    out.fix.status = status();
    out.fix.reason.clear();
    e.fill(out.fix);
    guess_E_ = e.p_E;
  }

  /// An epoch without a position of its own, for want of satellites or because its ranges contradict one another: a
  /// filter that runs makes use of what there is.
  void bridge(const std::vector<ObservedRange>& candidates, SinglePointEpoch& out) {
    const auto expected_E = filter_ ? filter_->predicted_p_E(out.fix.t) : std::nullopt;
    if (!expected_E) return;
    std::vector<RangeMeasurement> ranges;
    observer_.correct(candidates, out.fix.t, *expected_E, out.epoch, ranges);
    filter(candidates, ranges, *expected_E, out);
  }

  const ObservationFile& file_;
  const SinglePointInputs& inputs_;
  const SinglePointConfig& config_;
  const BaseDifferences* base_;
  RangeObserver observer_;
  std::unique_ptr<PositionSolver> rough_, rough_robust_, solver_;
  std::optional<PvtFilter> filter_;
  std::unique_ptr<RangeErrorReport> report_;
  Eigen::Vector3d guess_E_ = Eigen::Vector3d::Zero();
  std::int64_t near_base_ = 0, with_base_ = 0;
};

/// Errors: the configured corrections need maps or coefficients that are not there.
Status check_ionosphere(const ObservationFile& observations, const SinglePointInputs& inputs,
                        const SinglePointConfig& config) {
  if (config.frequencies != Frequencies::kSingle) return Ok{};
  if (config.ionosphere == IonosphereCorrection::kIonex) {
    const IonexMaps* maps = inputs.ionosphere_maps;
    if (maps == nullptr || maps->maps.empty())
      return Error{"", 0, "ionosphere", "\"ionex\" needs ionosphere maps", "an IONEX file (--ionex)"};
    if (observations.epochs.front().t < maps->maps.front().t || observations.epochs.back().t > maps->maps.back().t)
      return Error{maps->name, 0, "ionosphere",
                   "covers " + maps->maps.front().t.iso(0) + " to " + maps->maps.back().t.iso(0) +
                       ", not the observations' " + observations.epochs.front().t.iso(0) + " to " +
                       observations.epochs.back().t.iso(0),
                   "maps of the same day"};
  }
  if (is_klobuchar(config.ionosphere) && inputs.navigation.klobuchar.empty())
    return Error{inputs.navigation.names(), 0, "ionosphere",
                 std::string("\"") + row_of(ionosphere_corrections(), config.ionosphere).name +
                     "\" needs Klobuchar coefficients, and there are none in it",
                 "a navigation file with them, or ionosphere = \"none\""};
  return Ok{};
}

}  // namespace

int SinglePointResult::solved() const {
  return static_cast<int>(
      std::count_if(epochs.begin(), epochs.end(), [](const auto& e) { return e.fix.status != FixStatus::kNone; }));
}

Result<SinglePointResult> solve_observations(const ObservationFile& observations, const SinglePointInputs& inputs,
                                             const SinglePointConfig& config) {
  CANYON_TRY_STATUS(check_systems(config.systems, "systems"));
  CANYON_TRY_STATUS(check_ionosphere(observations, inputs, config));
  if (inputs.base == nullptr) return SinglePoint(observations, inputs, config, nullptr).run();
  RangeObserver at_base(inputs.base->observations, inputs, config, false);
  const BaseDifferences base = base_differences(at_base, inputs.base->observations, inputs.base->p_E);
  CANYON_TRY(SinglePointResult out, SinglePoint(observations, inputs, config, &base).run());
  for (std::string& warning : at_base.warnings()) out.warnings.push_back(std::move(warning));
  return out;
}

}  // namespace canyon::gnss
