#include "canyon/gnss/single_point/single_point.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere_map.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/single_point/code_choice.h"
#include "canyon/gnss/single_point/group_delay.h"
#include "canyon/gnss/single_point/range_corrections.h"
#include "canyon/gnss/sky_view.h"
#include "canyon/gnss/solver/carrier_smoothing.h"
#include "canyon/gnss/solver/pvt_filter.h"
#include "canyon/gnss/solver/velocity.h"
#include "canyon/gnss/solver/weighting.h"

namespace canyon::gnss {
namespace {

bool is_klobuchar(IonosphereCorrection model) {
  return model == IonosphereCorrection::kKlobuchar || model == IonosphereCorrection::kKlobucharOwn;
}

constexpr double kOutlierSigmas = 5.0;  // of Dopplers

/// One satellite of an epoch on its way to a range.
struct Candidate {
  SatelliteId sv;
  CodeMeasurement code;
  SignalObservation signal;
  SatelliteState state;  // at transmission, in E of transmission
  double group_delay_s = 0.0;
  double group_delay_sigma_m = 0.0;
  bool loss_of_lock = false;
  BroadcastKlobuchar klobuchar;
  double base_m = 0.0, base_sigma_m = 0.0;  // what the base's range is off, and how uncertain that is
};

/// Satellites observed without an ephemeris: told once each.
class MissingEphemerides {
 public:
  explicit MissingEphemerides(const std::string& file) : file_(file) {}
  void add(SatelliteId sv, int line, GpsTime t) {
    auto& m = by_satellite_[sv];
    if (m.count++ == 0) m = {1, line, t};
  }
  std::vector<std::string> list() const {
    std::vector<std::string> out;
    for (const auto& [sv, m] : by_satellite_)
      out.push_back(Error{file_, m.line, "", sv.str() + " has no valid healthy ephemeris at " + m.t.iso(0)}.str() +
                    (m.count > 1 ? " and " + std::to_string(m.count - 1) + " other epochs" : "") + "; not used");
    return out;
  }

 private:
  struct Missing {
    int count = 0, line = 0;
    GpsTime t;
  };
  std::string file_;
  std::map<SatelliteId, Missing> by_satellite_;
};

/// Satellites that are used with something missing: told in one line, with the first epoch's number.
class Shortcomings {
 public:
  Shortcomings(const std::string& file, std::string what) : file_(file), what_(std::move(what)) {}
  void add(SatelliteId sv, int line) {
    if (satellites_.empty()) line_ = line;
    satellites_.insert(sv);
  }
  void append_to(std::vector<std::string>& warnings) const {
    if (satellites_.empty()) return;
    std::string names;
    for (const SatelliteId sv : satellites_) names += (names.empty() ? "" : ", ") + sv.str();
    warnings.push_back(Error{file_, line_, "", names + ": " + what_}.str());
  }

 private:
  std::string file_, what_;
  int line_ = 0;
  std::set<SatelliteId> satellites_;
};

/// The figures in a reason differ from epoch to epoch; what is counted is the kind.
std::string kind_of(const std::string& reason) {
  return reason.substr(0, reason.find(':'));
}

class SinglePoint {
 public:
  SinglePoint(const ObservationFile& file, const SinglePointInputs& inputs, const SinglePointConfig& config)
      : file_(file),
        inputs_(inputs),
        config_(config),
        group_delays_(config.group_delay, inputs.navigation),
        smoothing_(config.smoothing_s),
        missing_(file.name),
        without_channel_(file.name, "no one tells the GLONASS channel; phase and Doppler are not used"),
        lent_delay_(file.name,
                    "the navigation message does not tell this band's group delay; that of the band beside it is used, "
                    "and its ranges count for less") {
    report_ = *config.reported_covariance.make("reported_covariance");  // the name was checked when it was read
    troposphere_m_ = model_row(troposphere_corrections(), config.troposphere).make;
    weighting_ = model_row(range_weightings(), config.weighting).make({}, {config.sigma_m});
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

  /// As a base at p_E: what its ranges are off.
  BaseDifferences differences(const Eigen::Vector3d& p_E) {
    BaseDifferences out;
    for (const auto& epoch : file_.epochs) {
      throw_if_cancelled();
      std::vector<Candidate> candidates = usable(epoch);
      smooth(candidates, epoch, p_E);
      GnssEpoch corrected;
      std::vector<RangeMeasurement> ranges;
      correct(candidates, epoch.t, p_E, corrected, ranges);
      const Horizon horizon(p_E);
      auto& of = out.epochs.emplace_back(BaseDifferences::Epoch{epoch.t, {}}).satellites;
      for (const auto& o : corrected.observations)
        of[o.sv] = {o.corrected_m() - (o.p_E - p_E).norm(), o.band, horizon.view(epoch.t, o.p_E).elevation_rad};
    }
    return out;
  }
  std::vector<std::string> warnings() const {
    std::vector<std::string> out = missing_.list();
    without_channel_.append_to(out);
    lent_delay_.append_to(out);
    return out;
  }

  /// Errors: see solve_observations().
  Result<SinglePointResult> run(const BaseDifferences* base) {
    base_ = base;
    SinglePointResult out;
    for (const auto& epoch : file_.epochs) {
      throw_if_cancelled();
      out.epochs.push_back(solve(epoch));
      const auto& fix = out.epochs.back().fix;
      if (fix.status == FixStatus::kNone) ++out.reasons[kind_of(fix.reason)];
    }
    out.warnings = warnings();
    if (observed_ == 0)
      return Error{file_.name, 0, "systems", "no pseudorange of the systems " + config_.systems + " in it",
                   "systems that were observed"};
    if (with_ephemeris_ == 0)
      return Error{file_.name, file_.epochs.front().line, "",
                   "no satellite observed from " + file_.epochs.front().t.iso(0) + " to " +
                       file_.epochs.back().t.iso(0) + " has a valid ephemeris in " + inputs_.navigation.names(),
                   "navigation files of the same day and systems"};
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
  bool take_differences(GpsTime t, std::vector<Candidate>& candidates) {
    if (base_ == nullptr) return true;
    const BaseDifferences::Epoch* now = base_->near(t, config_.base_age_s);
    if (now == nullptr) {
      candidates.clear();
      return false;
    }
    ++near_base_;
    std::erase_if(candidates, [&](Candidate& c) {
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
    std::vector<Candidate> candidates = usable(epoch);
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
    smooth(candidates, epoch, at_E);

    // Corrected for elevations at the position before, until it stays: a metre moves a delay by less than 1e-6 m.
    constexpr int kPasses = 6;
    PositionSolution solution;
    std::vector<RangeMeasurement> ranges;
    for (int pass = 0; pass < kPasses; ++pass) {
      correct(candidates, epoch.t, at_E, out.epoch, ranges);
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
    if (velocity.ok) out.fix.v_A_E = velocity.v_E;
    return out;
  }

  std::vector<Candidate> usable(const ObservationEpoch& epoch) {
    std::vector<Candidate> out;
    for (const auto& s : epoch.satellites) {
      if (config_.systems.find(system_letter(s.sv.system)) == std::string::npos) continue;
      const auto& codes = file_.codes(epoch, s.sv.system);
      std::optional<SignalPair> pair;
      std::optional<SignalObservation> signal;
      if (config_.frequencies == Frequencies::kDual) {
        pair = dual_frequency_signals(codes, s);
        if (pair) signal = pair->first;
      } else {
        signal = single_frequency_signal(codes, s);
      }
      if (!signal) continue;
      ++observed_;
      const auto view = transmission_from_pseudorange(inputs_.constellation, s.sv, epoch.t, signal->pseudorange_m);
      if (!view) {
        missing_.add(s.sv, epoch.line, epoch.t);
        continue;
      }
      ++with_ephemeris_;
      Candidate c;
      c.sv = s.sv;
      c.signal = *signal;
      c.loss_of_lock = signal->loss_of_lock || (pair && pair->second.loss_of_lock);
      c.state = view->state;
      const int channel = c.state.frequency_channel;
      c.code = pair ? ionosphere_free_measurement(*pair, s.sv, channel) : single_measurement(*signal, s.sv, channel);
      if (std::isnan(c.code.hz)) without_channel_.add(s.sv, epoch.line);
      const int band = signal->code.band - '0';
      const auto second = pair ? std::optional(pair->second.code.band - '0') : std::nullopt;
      c.group_delay_s = group_delays_.delay_s(c.state, s.sv, band, second);
      c.group_delay_sigma_m = group_delays_.sigma_m(c.state, s.sv, band, second);
      if (c.group_delay_sigma_m > 0.0) lent_delay_.add(s.sv, epoch.line);
      if (uses_klobuchar()) c.klobuchar = coefficients(s.sv.system, epoch.t);
      if (std::isfinite(c.code.pseudorange_m)) out.push_back(c);
    }
    return out;
  }

  bool uses_klobuchar() const {
    return config_.frequencies == Frequencies::kSingle && is_klobuchar(config_.ionosphere);
  }

  BroadcastKlobuchar coefficients(GnssSystem system, GpsTime t) const {
    if (config_.ionosphere == IonosphereCorrection::kKlobucharOwn)
      if (const auto own = inputs_.navigation.klobuchar_at(system, t)) return {system, t, *own};
    return {GnssSystem::kGps, t,
            inputs_.navigation.klobuchar_at(GnssSystem::kGps, t).value_or(KlobucharCoefficients{})};
  }

  static RangeMeasurement uncorrected(const Candidate& c, double sigma_m) {
    return {c.state.p_E, c.code.pseudorange_m + kSpeedOfLight * (c.state.clock_s - c.group_delay_s), sigma_m,
            c.sv.system};
  }

  /// Without corrections, which need elevations: the atmosphere counts as noise. A satellite with a gross error would
  /// spoil the elevations, so it is left out here already.
  PositionSolution rough_position(const std::vector<Candidate>& candidates, const Eigen::Vector3d& guess_E) const {
    constexpr double kAtmosphereM = 30.0;
    std::vector<RangeMeasurement> ranges;
    for (const auto& c : candidates) ranges.push_back(uncorrected(c, kAtmosphereM));
    const auto solution = rough_robust_->solve(ranges, guess_E);
    return solution.ok ? solution : rough_->solve(ranges, guess_E);
  }

  double ionosphere_m(const Candidate& c, const SkyView& view) const {
    if (config_.frequencies != Frequencies::kSingle || config_.ionosphere == IonosphereCorrection::kNone) return 0.0;
    // A GLONASS channel that nobody tells changes the delay by less than 1 %.
    const double hz = std::isnan(c.code.hz) ? carrier_hz(c.sv.system, c.signal.code.band - '0') : c.code.hz;
    const double scale = kL1Hz / hz;
    if (config_.ionosphere == IonosphereCorrection::kIonex) {
      SkyView held = view;
      held.elevation_rad = std::max(held.elevation_rad, 5.0 * kDegree);
      const double delay_m = ionosphere_map_delay_m(*inputs_.ionosphere_maps, held);
      return std::isfinite(delay_m) ? scale * scale * delay_m : 0.0;  // holes of a map; its time was checked
    }
    return scale * scale * klobuchar_correction_m(c.klobuchar.system, c.klobuchar.coefficients, view);
  }

  void smooth(std::vector<Candidate>& candidates, const ObservationEpoch& epoch, const Eigen::Vector3d& at_E) {
    if (config_.smoothing_s <= 0.0) return;
    const Horizon horizon(at_E);
    for (auto& c : candidates) {
      CarrierSmoothing::Input in{c.code.pseudorange_m, c.code.phase_m, 0.0,
                                 c.loss_of_lock || epoch.after_power_failure};
      in.ionosphere_m = ionosphere_m(c, horizon.view(epoch.t, c.state.p_E));
      c.code.pseudorange_m = smoothing_.smooth(c.sv, epoch.t, in).code_m;
    }
  }

  void correct(const std::vector<Candidate>& candidates, GpsTime t, const Eigen::Vector3d& at_E, GnssEpoch& epoch,
               std::vector<RangeMeasurement>& ranges) const {
    const Horizon horizon(at_E);
    epoch.observations.clear();
    ranges.clear();
    for (const auto& c : candidates) {
      const double travel_s = (c.state.p_E - at_E).norm() / kSpeedOfLight;
      GnssObservation o;
      o.sv = c.sv;
      o.band = c.signal.code.band - '0';
      o.p_E = turned_by_earth(c.state.p_E, travel_s);
      const SkyView view = horizon.view(t, o.p_E);
      if (view.elevation_rad < config_.mask_deg * kDegree) continue;
      const double delay_m = ionosphere_m(c, view);
      o.v_E = turned_by_earth(c.state.v_E, travel_s);
      o.pseudorange_m = c.code.pseudorange_m;
      const bool carrier_known = std::isfinite(c.code.hz);
      o.carrier_phase_cycles = carrier_known ? c.signal.phase_cycles : kNaN;
      o.doppler_hz = carrier_known ? c.signal.doppler_hz : kNaN;
      o.rate_m_s = pseudorange_rate_m_s(o.doppler_hz, c.code.hz) + kSpeedOfLight * c.state.clock_rate;
      o.cn0_dbhz = c.signal.cn0_dbhz;
      o.clock_m = kSpeedOfLight * (c.state.clock_s - c.group_delay_s);
      o.correction_m = delay_m + troposphere_m_(view) + c.base_m;
      o.sigma_m = std::hypot(weighting_->sigma_m({.system = c.sv.system,
                                                  .elevation_rad = view.elevation_rad,
                                                  .cn0_dbhz = o.cn0_dbhz,
                                                  .ionosphere_m = base_ != nullptr ? 0.0 : delay_m,
                                                  .code_factor = c.code.noise_factor,
                                                  .accuracy_m = c.state.accuracy_m,
                                                  .differential = base_ != nullptr}),
                             base_ != nullptr ? c.base_sigma_m : c.group_delay_sigma_m);
      epoch.observations.push_back(o);
      const double shared_m = base_ != nullptr ? 0.0 : config_.shared_ionosphere * delay_m;
      ranges.push_back({c.state.p_E, o.corrected_m(), o.sigma_m, c.sv.system, shared_m});
    }
  }

  FixStatus status() const { return base_ != nullptr ? FixStatus::kDifferential : FixStatus::kSingle; }

  static std::vector<RangeSignal> signals_of(const std::vector<Candidate>& candidates, const GnssEpoch& epoch) {
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
  std::vector<RateMeasurement> rates_of(const std::vector<Candidate>& candidates, const GnssEpoch& epoch) const {
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
  void filter(const std::vector<Candidate>& candidates, const std::vector<RangeMeasurement>& ranges,
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
  void bridge(const std::vector<Candidate>& candidates, SinglePointEpoch& out) {
    const auto expected_E = filter_ ? filter_->predicted_p_E(out.fix.t) : std::nullopt;
    if (!expected_E) return;
    std::vector<RangeMeasurement> ranges;
    correct(candidates, out.fix.t, *expected_E, out.epoch, ranges);
    filter(candidates, ranges, *expected_E, out);
  }

  const ObservationFile& file_;
  const SinglePointInputs& inputs_;
  const SinglePointConfig& config_;
  std::unique_ptr<RangeWeighting> weighting_;
  std::unique_ptr<PositionSolver> rough_, rough_robust_, solver_;
  std::optional<PvtFilter> filter_;
  std::unique_ptr<RangeErrorReport> report_;
  const BaseDifferences* base_ = nullptr;
  Eigen::Vector3d guess_E_ = Eigen::Vector3d::Zero();
  TroposphereCorrection* troposphere_m_;
  GroupDelays group_delays_;
  CarrierSmoothing smoothing_;
  MissingEphemerides missing_;
  Shortcomings without_channel_, lent_delay_;
  std::int64_t observed_ = 0, with_ephemeris_ = 0, near_base_ = 0, with_base_ = 0;
};

}  // namespace

int SinglePointResult::solved() const {
  return static_cast<int>(
      std::count_if(epochs.begin(), epochs.end(), [](const auto& e) { return e.fix.status != FixStatus::kNone; }));
}

Result<SinglePointResult> solve_observations(const ObservationFile& observations, const SinglePointInputs& inputs,
                                             const SinglePointConfig& config) {
  CANYON_TRY_STATUS(check_systems(config.systems, "systems"));
  const bool single = config.frequencies == Frequencies::kSingle;
  if (single && config.ionosphere == IonosphereCorrection::kIonex) {
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
  if (single && is_klobuchar(config.ionosphere) && inputs.navigation.klobuchar.empty())
    return Error{inputs.navigation.names(), 0, "ionosphere",
                 std::string("\"") + row_of(ionosphere_corrections(), config.ionosphere).name +
                     "\" needs Klobuchar coefficients, and there are none in it",
                 "a navigation file with them, or ionosphere = \"none\""};
  if (inputs.base == nullptr) return SinglePoint(observations, inputs, config).run(nullptr);
  SinglePoint at_base(inputs.base->observations, inputs, config);
  const BaseDifferences base = at_base.differences(inputs.base->p_E);
  CANYON_TRY(SinglePointResult out, SinglePoint(observations, inputs, config).run(&base));
  for (std::string& warning : at_base.warnings()) out.warnings.push_back(std::move(warning));
  return out;
}

}  // namespace canyon::gnss
