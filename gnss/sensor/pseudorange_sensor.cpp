#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/carrier_noise.h"
#include "canyon/gnss/receiver/loop_noise.h"
#include "canyon/gnss/receiver/modes/receiver_fix.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/solver/velocity.h"

namespace canyon::gnss {
namespace {

/// One kind of signal in the receiver: how it is tracked, and how noisy that is.
struct Channel {
  std::unique_ptr<MultipathRule> multipath;
  std::unique_ptr<CodeTracking> tracking;
};

/// All that a pseudorange is made of; one model per effect.
struct PseudorangeParts {
  std::shared_ptr<const Constellation> constellation;
  std::unique_ptr<IonosphereModel> ionosphere;
  std::unique_ptr<TroposphereModel> troposphere;
  std::unique_ptr<EphemerisError> ephemeris_error;
  std::unique_ptr<PathModel> paths;
  PathParameters path_limits;                  ///< that they were made with
  std::array<Channel, kModulations> channels;  ///< by Modulation
  std::unique_ptr<ReceiverClock> clock;
  std::unique_ptr<ReceiverMode> mode;
  std::unique_ptr<PositionSolver> solver;
  std::unique_ptr<RangeWeighting> weighting;
  LinkBudget link;
  SignalLockParameters locks;
  std::vector<std::string> warnings;
};

/// Which signal's peak is tracked, as a number that stays the same from epoch to epoch.
std::uint64_t identity(const SignalPaths& paths, int source) {
  if (source < 0) return 1;
  const SignalPath& p = paths.echoes[static_cast<std::size_t>(source)];
  std::uint64_t hash = 14695981039346656037u;
  const auto mix = [&hash](std::uint64_t value) { hash = (hash ^ value) * 1099511628211u; };
  mix(static_cast<std::uint64_t>(p.reflections));
  mix(static_cast<std::uint64_t>(p.diffractions));
  for (const std::uint32_t facet : p.facets) mix(facet);
  return hash;
}

/// Streams of one of the receiver's signals, and what it is locked to.
struct SignalStreams {
  SignalStreams(const std::string& prefix, const TrackingConfig& config, const SignalLockParameters& lock_parameters)
      : code(lock_parameters.seed, prefix + "code_noise", config.code_loop_hz, lock_parameters.interval_s),
        carrier(lock_parameters.seed, prefix + "carrier_noise"),
        doppler(lock_parameters.seed, prefix + "doppler_noise"),
        locks(lock_parameters) {}

  LoopNoise code;
  RandomStream carrier, doppler;
  SignalLocks locks;
};

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
  PseudorangeSensor(const GnssConfig& config, const LocalFrame& frame, PseudorangeParts parts)
      : config_(config),
        frame_(frame),
        parts_(std::move(parts)),
        first_("gnss.", config.tracking, parts_.locks),
        second_("gnss.second.", config.tracking, parts_.locks) {
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
    Epoch epoch{index, t, p_A_W, v_A_W, Horizon(frame_.to_E(p_A_W)), {}};
    GnssOutput& out = epoch.out;
    out.truth.t = t;
    out.truth.p_A_E = frame_.to_E(p_A_W);
    out.truth.v_A_E = frame_.R_EW() * v_A_W;
    out.truth.receiver_clock_m = parts_.clock->offset_m(index);
    out.truth.receiver_clock_rate_m_s = parts_.clock->rate_m_s(index);
    out.epoch.t = t + out.truth.receiver_clock_m / kSpeedOfLight;

    const std::vector<Sight> sights = satellites_above_mask(epoch);
    const std::vector<SignalPaths> paths = trace(
        p_A_W, sights, [](GnssSystem system) { return first_band(system); }, scene);
    // Fields, and so which ways are worth following, depend on the carrier.
    std::vector<SignalPaths> second_paths;
    if (parts_.mode->dual_frequency())
      second_paths = trace(
          p_A_W, sights, [this](GnssSystem system) { return second_band(system, config_.tracking.second_frequency); },
          scene);
    receive_epoch(epoch, sights, paths, second_paths);
    return std::move(out);
  }

  GnssCounters counters() const override { return counters_; }
  void leave_out(const PathOmissions& omissions) override { leave_out_ = omissions; }
  void leave_out(const RangeOmissions& omissions) override { ranges_ = omissions; }
  bool has_satellites() const override { return true; }
  std::vector<std::string> warnings() const override { return parts_.warnings; }

 private:
  struct Sight {
    SatelliteId sv;
    Transmission signal;
    SkyView view;
    Eigen::Vector3d direction_W;

    double carrier_hz(int band) const { return gnss::carrier_hz(sv.system, band, signal.state.frequency_channel); }
  };

  /// What all satellites of an epoch share.
  struct Epoch {
    std::int64_t index;
    GpsTime t;
    Eigen::Vector3d p_A_W, v_A_W;
    Horizon horizon;
    GnssOutput out;
  };

  struct Measured {
    bool tracked = false;
    double pseudorange_m = kNaN, doppler_hz = kNaN, carrier_phase_cycles = kNaN, cn0_dbhz = kNaN;
    bool slipped = false;
    double noise_m = 0.0, multipath_m = 0.0;
    Reception reception;
    double ambiguity_cycles = 0.0;
  };

  void begin_epoch(std::int64_t index) {
    ++counters_.epochs;
    if (index != last_index_ + 1) {
      first_.locks.restart();
      second_.locks.restart();
      if (filter_) filter_->reset();
    }
    last_index_ = index;
    first_.locks.begin_epoch(index);
    second_.locks.begin_epoch(index);
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
    const SignalLocks first = first_.locks, second = second_.locks;
    const GnssOutput empty = epoch.out;
    if (solve_epoch(epoch, sights, paths, second_paths, ranges_.delays)) return;
    ++counters_.epochs_in_full;
    first_.locks = first;
    second_.locks = second;
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
    const ReceiverParts receiver{*parts_.constellation,
                                 *parts_.mode,
                                 *parts_.solver,
                                 *parts_.weighting,
                                 config_.position.max_gdop,
                                 frame_.origin_E(),
                                 filter_ ? &*filter_ : nullptr};
    std::vector<Correction> corrections;
    PositionSolution solution;
    out.fix = compute_fix(receiver, epoch.t, out.epoch, inputs, corrections, &solution);
    out.range_gain = solution.ok ? solution.range_gain : kNaN;
    for (std::size_t k = 0; k < corrections.size(); ++k)
      keep_residual(corrections[k], ranges_.bound_m > 0.0 ? leave_out : DelayOmissions{},
                    out.truth.satellites[truth_of[k]]);
    return out.range_gain <= ranges_.most_gain &&
           decisions_hold(solution, out.epoch, ranges_.bound_m, config_.position.max_gdop);
  }

  /// A satellite that was last seen below the mask, and when it may have risen above it at the earliest.
  struct Below {
    GpsTime t;
    Eigen::Vector3d p_A_W;
    double by_rad;

    /// No line of sight turns faster than the fastest satellite, 3.9 km/s, and the ground under the antenna, 0.5 km/s,
    /// turn that of the nearest, 18,000 km away: 2.5e-4 rad/s. An antenna that is elsewhere sees it in another place. A
    /// minute later it is looked at in any case, as ephemerides change.
    bool still(const Epoch& epoch) const {
      return std::abs(epoch.t - t) < 60.0 && 3e-4 * std::abs(epoch.t - t) + (epoch.p_A_W - p_A_W).norm() / 5e6 < by_rad;
    }
  };

  std::vector<Sight> satellites_above_mask(const Epoch& epoch) {
    const Eigen::Vector3d& p_A_E = epoch.out.truth.p_A_E;
    std::vector<Sight> sights;
    for (const SatelliteId sv : parts_.constellation->satellites()) {
      const auto below = below_.find(sv);
      if (below != below_.end() && below->second.still(epoch)) continue;
      const auto signal = transmission_to(*parts_.constellation, sv, epoch.t, p_A_E, epoch.out.epoch.t);
      if (!signal) continue;
      const Eigen::Vector3d satellite_E = signal->p_E();
      const SkyView view = epoch.horizon.view(epoch.t, satellite_E);
      if (const double by_rad = config_.mask_deg * kDegree - view.elevation_rad; by_rad > 0.0) {
        below_.insert_or_assign(sv, Below{epoch.t, epoch.p_A_W, by_rad});
        continue;
      }
      sights.push_back({sv, *signal, view, frame_.R_EW().transpose() * (satellite_E - p_A_E).normalized()});
    }
    return sights;
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

  template <class BandOf>
  std::vector<SignalPaths> trace(const Eigen::Vector3d& p_A_W, const std::vector<Sight>& sights, const BandOf& band_of,
                                 const scene::SceneAt& scene) {
    std::vector<Eigen::Vector3d> directions_W;
    std::vector<double> carriers_hz;
    for (const auto& s : sights) {
      directions_W.push_back(s.direction_W);
      carriers_hz.push_back(s.carrier_hz(band_of(s.sv.system)));
    }
    std::vector<SignalPaths> paths(sights.size());
    paths_now().trace(p_A_W, {directions_W, carriers_hz}, scene, paths, counters_);
    return paths;
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

  const Channel& channel(GnssSystem system, int band) const {
    return parts_.channels[static_cast<std::size_t>(config_.tracking.modulation.value_or(modulation_of(system, band)))];
  }

  Reception receive_signals(const Epoch& epoch, const Sight& sight, const SignalPaths& paths, const Channel& channel,
                            double wavelength_m) const {
    const Eigen::Vector3d up_W = frame_.R_EW().transpose() * epoch.horizon.R_E_enu().col(2);
    std::vector<ReceivedSignal> echoes;
    for (const auto& p : paths.echoes)
      echoes.push_back(receive(p, parts_.link, up_W, sight.direction_W, epoch.v_A_W, wavelength_m));
    std::optional<ReceivedSignal> direct;
    if (paths.line_of_sight) {
      direct.emplace();
      direct->cn0_dbhz = parts_.link.direct_cn0_dbhz(sight.view.elevation_rad, paths.foliage_m, std::abs(paths.direct));
      direct->phase_rad = std::arg(paths.direct);
    }
    return channel.multipath->receive(direct, echoes, wavelength_m);
  }

  /// One signal of one satellite. `acting` has the ionosphere of the first band.
  Measured measure_signal(const Epoch& epoch, const Sight& sight, const SignalPaths& paths, int band,
                          SignalStreams& streams, const GnssObservationTruth& truth, const RangeDelays& acting) const {
    const SatelliteState& state = sight.signal.state;
    const double carrier = sight.carrier_hz(band);
    const double wavelength_m = kSpeedOfLight / carrier;
    const Channel& own = channel(sight.sv.system, band);
    Measured m;
    m.reception = receive_signals(epoch, sight, paths, own, wavelength_m);
    const Reception& r = m.reception;
    const auto lock = streams.locks.update(sight.sv, r.tracked ? r.cn0_dbhz : kNaN, identity(paths, r.source));
    if (!lock.tracked) return m;

    m.tracked = true;
    m.cn0_dbhz = r.cn0_dbhz;
    m.slipped = lock.slipped;
    m.ambiguity_cycles = lock.ambiguity_cycles;
    m.multipath_m = r.error_m;
    const std::uint32_t entity = sight.sv.entity();
    const auto sample = static_cast<std::uint64_t>(epoch.index);
    const TrackingConfig& tracking = config_.tracking;
    const double scale = tracking.thermal_noise_scale, T = 1e-3 * tracking.integration_ms;
    m.noise_m = scale * own.tracking->noise_m(r.cn0_dbhz) * streams.code.at(entity, epoch.index);

    const double ratio = sight.carrier_hz(first_band(sight.sv.system)) / carrier;
    const double ionosphere_m = acting.ionosphere_m * ratio * ratio;
    const double common_m = sight.signal.range_m + epoch.out.truth.receiver_clock_m -
                            kSpeedOfLight * state.clock_of_band_s(band) + acting.troposphere_m + acting.ephemeris_m +
                            truth.phase_centre_m;
    m.pseudorange_m = common_m + ionosphere_m + r.error_m + m.noise_m;
    const double phase_noise = scale * carrier_phase_noise_rad(r.cn0_dbhz, tracking.carrier_loop_hz, T) / (2.0 * kPi) *
                               streams.carrier.normal(entity, sample);
    m.carrier_phase_cycles =
        (common_m - ionosphere_m + r.carrier_error_m) / wavelength_m + phase_noise + lock.ambiguity_cycles;
    const double rate_m_s = truth.range_rate_m_s + epoch.out.truth.receiver_clock_rate_m_s -
                            kSpeedOfLight * state.clock_rate * (1.0 - truth.range_rate_m_s / kSpeedOfLight) +
                            r.range_rate_error_m_s;
    m.doppler_hz = -rate_m_s / wavelength_m + scale * doppler_noise_hz(r.cn0_dbhz, tracking.carrier_loop_hz, T) *
                                                  streams.doppler.normal(entity, sample);
    CANYON_CHECK(std::isfinite(m.pseudorange_m) && std::isfinite(m.cn0_dbhz) && std::isfinite(m.carrier_phase_cycles) &&
                     std::isfinite(m.doppler_hz),
                 "pseudorange sensor, ", sight.sv.str(), ": pseudorange_m = ", m.pseudorange_m,
                 ", carrier_phase_cycles = ", m.carrier_phase_cycles, ", doppler_hz = ", m.doppler_hz,
                 ", cn0_dbhz = ", m.cn0_dbhz);
    return m;
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

    const Measured first = measure_signal(epoch, sight, paths, band, first_, truth, acting);
    const int other_band = second_band(sight.sv.system, config_.tracking.second_frequency);
    Measured second;
    if (second_paths != nullptr)
      second = measure_signal(epoch, sight, *second_paths, other_band, second_, truth, acting);
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
    truth.multipath_m = first.multipath_m;
    truth.noise_m = first.noise_m;
    truth.carrier_multipath_m = first.reception.carrier_error_m;
    truth.range_rate_multipath_m_s = first.reception.range_rate_error_m_s;
    truth.ambiguity_cycles = first.ambiguity_cycles;
    CorrectionInput input{sight.sv, epoch.t,           sight.view, {},       sight.signal.range_m,
                          acting,   from_l1 * from_l1, {},         leave_out};
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
      input.two->multipath_m = second.multipath_m - first.multipath_m;
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
    truth.noise_m -= c.noise_m;
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
  SignalStreams first_, second_;
  std::optional<PvtFilter> filter_;
  PathOmissions leave_out_;
  RangeOmissions ranges_;
  std::map<SatelliteId, Below> below_;
  std::vector<std::pair<PathOmissions, std::unique_ptr<PathModel>>> reduced_;
  std::int64_t last_index_ = -2;
  GnssCounters counters_;
};

SignalLockParameters lock_parameters(const GnssConfig& c, std::uint64_t seed) {
  return {.seed = seed,
          .interval_s = 1.0 / c.rate_hz,
          .threshold_dbhz = c.locks.tracking_threshold_dbhz,
          .reacquisition_margin_db = c.locks.reacquisition_margin_db,
          .reacquisition_s = c.locks.reacquisition_s,
          .carrier_loop_hz = c.tracking.carrier_loop_hz,
          .integration_s = 1e-3 * c.tracking.integration_ms,
          .slips = c.tracking.thermal_noise_scale > 0.0};
}

/// Satellites, and what acts on their signals outside the scene.
Result<KlobucharCoefficients> add_sky(const SensorSetup& at, PseudorangeParts& parts) {
  const GnssConfig& c = at.config;
  CANYON_TRY(const SatelliteSource source, make_satellite_source(c.satellites, at.start, at.end));
  parts.constellation = source.constellation;
  parts.warnings = source.warnings;
  CANYON_TRY(parts.ionosphere, c.ionosphere.make("gnss.ionosphere",
                                                 IonosphereSetup{source.klobuchar, at.start, at.end, &parts.warnings}));
  CANYON_TRY(parts.troposphere, c.troposphere.make("gnss.troposphere"));
  CANYON_TRY(parts.ephemeris_error,
             c.ephemeris_error.make("gnss.ephemeris_error",
                                    EphemerisErrorSetup{at.seed, source.constellation, c.satellites.systems,
                                                        source.navigation.has_ephemeris(), &parts.warnings}));
  return source.klobuchar;
}

/// Builds the models that the configuration names; an Error names the key.
Result<PseudorangeParts> make_parts(const SensorSetup& at) {
  const GnssConfig& c = at.config;
  PseudorangeParts parts;
  CANYON_TRY(const KlobucharCoefficients klobuchar, add_sky(at, parts));
  for (std::size_t i = 0; i < kModulations; ++i) {
    const CorrelatorDesign design = c.tracking.channel(static_cast<Modulation>(i));
    CANYON_TRY(parts.channels[i].multipath,
               c.reception.multipath_rule.make(
                   "gnss.multipath_rule",
                   MultipathParameters{c.reception.cutoff_m(), c.locks.tracking_threshold_dbhz, design}));
    parts.channels[i].tracking = std::make_unique<CodeTracking>(design);
  }
  parts.path_limits = path_limits(c);
  parts.path_limits.cutoff_m = parts.channels[0].multipath->reach_m();
  CANYON_TRY(parts.paths, make_propagation(c.propagation, parts.path_limits));
  CANYON_TRY(parts.clock,
             c.receiver_clock.make("gnss.receiver_clock", ReceiverClockParameters{at.seed, 1.0 / c.rate_hz}));
  CANYON_TRY(parts.mode, c.mode.make("gnss.mode", ReceiverModeSetup{at.seed, parts.ionosphere->acts(),
                                                                    parts.troposphere->acts(), klobuchar}));
  CANYON_TRY(parts.solver, c.position.solver.make("gnss.solver", c.position.parameters()));
  CANYON_TRY(parts.weighting,
             c.position.weighting.make("gnss.weighting", RangeWeightingParameters{c.position.solver_sigma_m}));
  CANYON_TRY(parts.link, c.link.budget());
  parts.locks = lock_parameters(c, at.seed);
  if (!parts.solver->solves_clock() && !parts.clock->perfect())
    return Error{
        "", 0, "gnss.receiver_clock",
        "is \"" + c.receiver_clock.name + "\", but solver \"" + c.position.solver.name + "\" has no unknown for it",
        "\"none\""};
  if (!parts.solver->solves_clock() && c.position.estimator == Estimator::kKalman)
    return Error{"", 0, "gnss.estimator",
                 "is \"kalman\", but the solver " + c.position.solver.name + " has no receiver clock",
                 "solver \"least_squares\""};
  return parts;
}

}  // namespace

Result<std::unique_ptr<GnssSensor>> make_pseudorange_sensor(const ModelParameters&, const SensorSetup& at) {
  CANYON_TRY(PseudorangeParts parts, make_parts(at));
  return std::unique_ptr<GnssSensor>(
      std::make_unique<PseudorangeSensor>(at.config, at.scene.frame(), std::move(parts)));
}

}  // namespace canyon::gnss
