#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/modes/receiver_fix.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/sensor/base_receiver.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/pseudorange_parts.h"
#include "canyon/gnss/sensor/satellites_in_view.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/gnss/sensor/signal_tracker.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/solver/velocity.h"

namespace canyon::gnss {
namespace {

/// Forms pseudoranges, carrier phases and Dopplers from first principles and solves them. An epoch at GPS time t:
///
///   pseudorange = |satellite(t - light time), turned by the Earth - antenna(t)| + receiver clock - satellite clock
///                 + ionosphere + troposphere + broadcast error + antenna phase centre + multipath + code noise,
///   carrier     = the same with - ionosphere, the carrier's own multipath and noise, and whole cycles,
///   Doppler     = -(range rate + clock rates + multipath + noise) / wavelength.
///
/// Left out: phase wind-up (below a cycle over hours), the atmosphere's and the broadcast error's rates (mm/s). The
/// receiver labels the epoch with its own clock (GnssEpoch::t = t + receiver clock), computes the satellites from the
/// pseudoranges alone, corrects according to its mode, and solves. The light time is the vacuum's: the 1e-7 s that
/// delays add move a satellite by 0.1 mm along the line of sight.
class PseudorangeSensor final : public GnssSensor {
 public:
  /// `base`: of modes that need one, else null.
  PseudorangeSensor(const GnssConfig& config, const LocalFrame& frame, PseudorangeParts parts,
                    std::unique_ptr<BaseReceiver> base)
      : config_(config),
        frame_(frame),
        parts_(std::move(parts)),
        base_(std::move(base)),
        in_view_(parts_.constellation, frame, config.mask_deg * kDegree),
        first_("gnss.", config, parts_),
        second_("gnss.second.", config, parts_) {
    if (config_.position.smoothing_s > 0.0) smoothing_.emplace(config_.position.smoothing_s);
    if (config_.position.estimator != Estimator::kKalman) return;
    PvtFilterParameters p;
    p.acceleration_m_s2 = config_.position.estimator_acceleration_m_s2;
    p.start = config_.position.parameters();
    filter_.emplace(p);
  }

  GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& v_A_W,
                     const scene::SceneAt& scene) override {
    CANYON_CHECK(index >= 0, "index = ", index);
    CANYON_CHECK(p_A_W.allFinite() && v_A_W.allFinite(), "antenna at ", p_A_W.transpose(), ", velocity ",
                 v_A_W.transpose());
    begin_epoch(index);
    Epoch epoch{t, Horizon(frame_.to_E(p_A_W)), {}, {}, corrections_at(t)};
    GnssOutput& out = epoch.out;
    out.truth.t = t;
    out.truth.p_A_E = frame_.to_E(p_A_W);
    out.truth.v_A_E = frame_.R_EW() * v_A_W;
    out.truth.receiver_clock_m = parts_.clock->offset_m(index);
    out.truth.receiver_clock_rate_m_s = parts_.clock->rate_m_s(index);
    out.epoch.t = t + out.truth.receiver_clock_m / kSpeedOfLight;
    epoch.antenna = {index, frame_.R_EW().transpose() * epoch.horizon.R_E_enu().col(2), v_A_W,
                     out.truth.receiver_clock_m, out.truth.receiver_clock_rate_m_s};

    const std::vector<Sight> sights = in_view_.at(t, out.epoch.t, out.truth.p_A_E, epoch.horizon);
    std::vector<SignalPaths> paths, second_paths;
    trace(t, p_A_W, sights, scene, paths, second_paths);
    receive_epoch(epoch, sights, paths, second_paths);
    return std::move(out);
  }

  GnssCounters counters() const override { return counters_; }
  void leave_out(const PathOmissions& omissions) override { leave_out_ = omissions; }
  void leave_out(const RangeOmissions& omissions) override { ranges_ = omissions; }
  bool has_satellites() const override { return true; }
  std::vector<std::string> warnings() const override { return parts_.warnings; }

 private:
  /// What all satellites of an epoch share.
  struct Epoch {
    GpsTime t;
    Horizon horizon;
    ReceivingAntenna antenna;
    GnssOutput out;
    const BaseReceiver::Sent* from_base;  ///< null: no base, or nothing of it that is young enough
  };

  const BaseReceiver::Sent* corrections_at(GpsTime t) {
    const BaseReceiver::Sent* newest = base_ != nullptr ? base_->arrived(t) : nullptr;
    constexpr double kRounding_s = 1e-6;
    return newest != nullptr && t - newest->t <= parts_.mode->base()->age_s + kRounding_s ? newest : nullptr;
  }

  /// Why there is no fix, of a receiver that its base has left alone.
  std::string alone(GpsTime t) {
    const BaseReceiver::Sent* newest = base_->arrived(t);
    if (newest == nullptr) return "no corrections of the base yet";
    char text[64];
    std::snprintf(text, sizeof text, "no corrections of the base for %.0f s", t - newest->t);
    return text;
  }

  void begin_epoch(std::int64_t index) {
    ++counters_.epochs;
    if (index != last_index_ + 1) {
      first_.restart();
      second_.restart();
      if (filter_) filter_->reset();
      if (base_ != nullptr) base_->restart();
      if (smoothing_) smoothing_.emplace(config_.position.smoothing_s);
    }
    last_index_ = index;
    first_.begin_epoch(index);
    second_.begin_epoch(index);
  }

  /// Measures what has been traced, and solves it: without what is left out, and in full where the promise that came
  /// with it might not hold.
  void receive_epoch(Epoch& epoch, const std::vector<Sight>& sights, const std::vector<SignalPaths>& paths,
                     const std::vector<SignalPaths>& second_paths) {
    const bool promised = ranges_.any() && ranges_.bound_m > 0.0;
    if (!promised) {
      solve_epoch(epoch, sights, paths, second_paths, ranges_.delays);
      return;
    }
    const SignalTracker::Memory first = first_.memory(), second = second_.memory();
    const auto filter = filter_;
    const auto smoothing = smoothing_;
    const GnssOutput empty = epoch.out;
    if (solve_epoch(epoch, sights, paths, second_paths, ranges_.delays)) return;
    ++counters_.epochs_in_full;
    first_.set_memory(first);
    second_.set_memory(second);
    filter_ = filter;
    smoothing_ = smoothing;
    epoch.out = empty;
    solve_epoch(epoch, sights, paths, second_paths, {});
  }

  /// Whether the promise of what is left out holds.
  bool solve_epoch(Epoch& epoch, const std::vector<Sight>& sights, const std::vector<SignalPaths>& paths,
                   const std::vector<SignalPaths>& second_paths, const DelayOmissions& leave_out) {
    GnssOutput& out = epoch.out;
    std::vector<CorrectionInput> inputs;
    std::vector<std::size_t> truth_of;  // index of the truth record of each observation
    for (std::size_t i = 0; i < sights.size(); ++i) {
      GnssObservationTruth truth = describe(epoch, sights[i], paths[i]);
      truth.tracked = observe(epoch, sights[i], paths[i], second_paths.empty() ? nullptr : &second_paths[i], leave_out,
                              truth, inputs);
      if (truth.tracked) truth_of.push_back(i);
      out.truth.satellites.push_back(truth);
    }
    const ReceiverParts receiver{
        *parts_.constellation,
        *parts_.mode,
        *parts_.solver,
        *parts_.weighting,
        config_.position.max_gdop,
        frame_.origin_E(),
        filter_ ? &*filter_ : nullptr,
        smoothing_ ? &*smoothing_ : nullptr,
        {parts_.reported_covariance.get(), static_cast<int>(config_.position.fewest_satellites),
         config_.position.accuracy_limit_m}};
    std::vector<Correction> corrections;
    PositionSolution solution;
    out.fix = compute_fix(receiver, epoch.t, out.epoch, inputs, corrections, &solution);
    if (base_ != nullptr && epoch.from_base == nullptr) out.fix.reason = alone(epoch.t);
    counters_.delays_computed += static_cast<std::int64_t>(corrections.size()) * parts_.mode->asks(leave_out);
    out.range_gain = solution.ok ? solution.range_gain : kNaN;
    for (std::size_t k = 0; k < corrections.size(); ++k)
      keep_residual(corrections[k], ranges_.bound_m > 0.0 ? leave_out : DelayOmissions{},
                    out.truth.satellites[truth_of[k]]);
    return out.range_gain <= ranges_.most_gain &&
           decisions_hold(solution, out.epoch, ranges_.bound_m, config_.position.max_gdop);
  }

  /// The configured model of propagation, without what is left out; made when it is first asked for.
  const PathModel& paths_now() {
    if (leave_out_ == PathOmissions{}) return *parts_.paths;
    for (const auto& [omissions, model] : reduced_)
      if (omissions == leave_out_) return *model;
    PathParameters limits = parts_.path_limits;
    limits.leave_out = leave_out_;
    reduced_.emplace_back(leave_out_, *make_propagation(config_.propagation, limits));
    return *reduced_.back().second;
  }

  /// The ways of all first signals and, of a receiver of two, of all second ones. Fields, and so which ways are worth
  /// following, depend on the carrier, but what is looked for is the same: both are traced at once.
  void trace(GpsTime t, const Eigen::Vector3d& p_A_W, const std::vector<Sight>& sights, const scene::SceneAt& scene,
             std::vector<SignalPaths>& first, std::vector<SignalPaths>& second) {
    std::vector<Eigen::Vector3d> directions_W;
    std::vector<double> carriers_hz;
    const auto add = [&](const auto& band_of) {
      for (const Sight& s : sights) {
        directions_W.push_back(s.direction_W);
        carriers_hz.push_back(s.carrier_hz(band_of(s.sv.system)));
      }
    };
    add([](GnssSystem system) { return first_band(system); });
    if (parts_.mode->dual_frequency())
      add([this](GnssSystem system) { return second_band(system, config_.tracking.second_frequency); });
    first.resize(directions_W.size());
    paths_now().trace(p_A_W, PlaneWaves(directions_W, carriers_hz).at(t), scene, first, counters_);
    const auto second_begin = first.begin() + static_cast<std::ptrdiff_t>(sights.size());
    second.assign(std::make_move_iterator(second_begin), std::make_move_iterator(first.end()));
    first.erase(second_begin, first.end());
  }

  GnssObservationTruth describe(const Epoch& epoch, const Sight& sight, const SignalPaths& paths) const {
    GnssObservationTruth truth;
    truth.sv = sight.sv;
    truth.elevation_rad = sight.view.elevation_rad;
    truth.azimuth_rad = sight.view.azimuth_rad;
    truth.line_of_sight = paths.line_of_sight;
    const double cutoff_m = config_.reception.cutoff_m();
    for (const SignalPath& p : paths.echoes) {
      truth.reflections += p.reflections > 0 && p.excess_m < cutoff_m ? 1 : 0;
      truth.diffractions += p.diffractions > 0 ? 1 : 0;
    }
    truth.range_m = sight.signal.range_m;
    const SatelliteState& satellite = sight.signal.state;
    truth.range_rate_m_s =
        range_rate_m_s({.p_E = satellite.p_E, .v_E = satellite.v_E}, epoch.out.truth.p_A_E, epoch.out.truth.v_A_E);
    return truth;
  }

  RangeDelays delays(const Epoch& epoch, const Sight& sight, double ionosphere_from_l1,
                     const DelayOmissions& leave_out) {
    RangeDelays raw;
    if (!leave_out.ionosphere) raw.ionosphere_m = ionosphere_from_l1 * parts_.ionosphere->delay_m(sight.view);
    if (!leave_out.troposphere) raw.troposphere_m = parts_.troposphere->delay_m(sight.view);
    if (!leave_out.ephemeris)
      raw.ephemeris_m = parts_.ephemeris_error->range_m(sight.sv, sight.signal.state, epoch.out.truth.p_A_E, epoch.t);
    counters_.delays_computed += !leave_out.ionosphere + !leave_out.troposphere + !leave_out.ephemeris;
    return raw;
  }

  /// Measures one satellite, completes its truth record and appends the observation. False, and nothing appended, if it
  /// is not tracked at its first band; a second signal that is not is left out.
  bool observe(Epoch& epoch, const Sight& sight, const SignalPaths& paths, const SignalPaths* second_paths,
               const DelayOmissions& leave_out, GnssObservationTruth& truth, std::vector<CorrectionInput>& inputs) {
    const int band = first_band(sight.sv.system);
    const double from_l1 = kL1Hz / sight.carrier_hz(band);
    const RangeDelays acting = parts_.mode->acting(delays(epoch, sight, from_l1 * from_l1, leave_out));
    truth.phase_centre_m = config_.link.antenna_phase_centre
                               ? parts_.link.antenna->phase_centre_m(epoch.horizon.R_E_enu().transpose() *
                                                                     (frame_.R_EW() * sight.direction_W))
                               : 0.0;

    const ArrivingRange range{truth.range_rate_m_s, acting, truth.phase_centre_m};
    const SignalMeasurement first = first_.measure(epoch.antenna, sight, paths, band, range);
    const int other_band = second_band(sight.sv.system, config_.tracking.second_frequency);
    SignalMeasurement second;
    if (second_paths != nullptr) second = second_.measure(epoch.antenna, sight, *second_paths, other_band, range);
    if (!first.tracked) return false;
    if (!transmission_from_pseudorange(*parts_.constellation, sight.sv, epoch.out.epoch.t, first.pseudorange_m))
      return false;

    GnssObservation o;
    o.sv = sight.sv;
    o.band = band;
    o.pseudorange_m = first.pseudorange_m;
    o.doppler_hz = first.doppler_hz;
    o.carrier_phase_cycles = first.carrier_phase_cycles;
    o.cn0_dbhz = first.cn0_dbhz;
    o.slipped = first.slipped;
    truth.ionosphere_m = truth.ionosphere_delay_m = acting.ionosphere_m;
    truth.troposphere_m = truth.troposphere_delay_m = acting.troposphere_m;
    truth.ephemeris_m = acting.ephemeris_m;
    truth.multipath_m = first.reception.error_m;
    truth.noise_m = first.noise_m;
    truth.carrier_multipath_m = first.reception.carrier_error_m;
    truth.range_rate_multipath_m_s = first.reception.range_rate_error_m_s;
    truth.ambiguity_cycles = first.ambiguity_cycles;
    CorrectionInput input{sight.sv, epoch.t,           sight.view, {},       sight.signal.range_m,
                          acting,   from_l1 * from_l1, {},         leave_out};
    if (epoch.from_base != nullptr)
      input.base = base_->correction(*epoch.from_base, sight.sv, band, epoch.out.truth.p_A_E);
    if (second.tracked) {
      o.second.band = other_band;
      o.second.pseudorange_m = second.pseudorange_m;
      o.second.doppler_hz = second.doppler_hz;
      o.second.carrier_phase_cycles = second.carrier_phase_cycles;
      o.second.cn0_dbhz = second.cn0_dbhz;
      o.second.slipped = second.slipped;
      const double ratio = sight.carrier_hz(band) / sight.carrier_hz(other_band);
      input.two.emplace();
      input.two->gain = 1.0 / (ratio * ratio - 1.0);
      input.two->noise_m = second.noise_m - first.noise_m;
      input.two->multipath_m = second.reception.error_m - first.reception.error_m;
    }
    epoch.out.epoch.observations.push_back(o);
    inputs.push_back(input);
    return true;
  }

  /// The truth record keeps what the receiver's corrections leave; what was left out it does not know.
  static void keep_residual(const Correction& c, const DelayOmissions& leave_out, GnssObservationTruth& truth) {
    truth.ionosphere_m -= c.modelled.ionosphere_m;
    truth.troposphere_m -= c.modelled.troposphere_m;
    truth.ephemeris_m -= c.modelled.ephemeris_m;
    truth.noise_m -= c.noise_m + c.smoothing_m;
    truth.multipath_m -= c.multipath_m;
    truth.base_m -= c.base_m;
    if (leave_out.ionosphere) truth.ionosphere_delay_m = kNaN;
    if (leave_out.troposphere) truth.troposphere_delay_m = kNaN;
    if (leave_out.ionosphere_difference) truth.ionosphere_m = kNaN;
    if (leave_out.troposphere_difference) truth.troposphere_m = kNaN;
    if (leave_out.ephemeris) truth.ephemeris_m = kNaN;
  }

  GnssConfig config_;
  LocalFrame frame_;
  PseudorangeParts parts_;
  std::unique_ptr<BaseReceiver> base_;
  SatellitesInView in_view_;
  SignalTracker first_, second_;
  std::optional<PvtFilter> filter_;
  std::optional<BandSmoothing> smoothing_;
  PathOmissions leave_out_;
  RangeOmissions ranges_;
  std::vector<std::pair<PathOmissions, std::unique_ptr<PathModel>>> reduced_;
  std::int64_t last_index_ = -2;
  GnssCounters counters_;
};

}  // namespace

Result<std::unique_ptr<GnssSensor>> make_pseudorange_sensor(const ModelParameters&, const SensorSetup& at) {
  SensorSetup from = at;
  CANYON_TRY(const auto mode, at.config.mode.make("gnss.mode", ReceiverModeSetup{}));
  std::optional<GnssConfig> of_base;
  if (mode->base() != nullptr) {
    CANYON_TRY(of_base, BaseReceiver::configuration(at.config, *mode->base()));
    from.start = at.start - BaseReceiver::lead_s(*of_base, *mode->base());
  }
  CANYON_TRY(PseudorangeParts parts, make_pseudorange_parts(from));
  std::unique_ptr<BaseReceiver> base;
  if (of_base) {
    CANYON_TRY(base, BaseReceiver::make(from, *of_base, *mode->base(), parts));
  }
  return std::unique_ptr<GnssSensor>(
      std::make_unique<PseudorangeSensor>(at.config, at.scene.frame(), std::move(parts), std::move(base)));
}

}  // namespace canyon::gnss
