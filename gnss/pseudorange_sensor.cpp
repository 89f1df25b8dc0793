#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "core/random.h"
#include "core/units.h"
#include "gnss/atmosphere/ionosphere.h"
#include "gnss/atmosphere/troposphere.h"
#include "gnss/errors/ephemeris_error.h"
#include "gnss/paths/path_model.h"
#include "gnss/receiver/code_noise.h"
#include "gnss/receiver/link_budget.h"
#include "gnss/receiver/multipath_rule.h"
#include "gnss/receiver/receiver_clock.h"
#include "gnss/receiver/receiver_fix.h"
#include "gnss/rinex/navigation_file.h"
#include "gnss/satellites/transmission.h"
#include "gnss/sensor_models.h"
#include "gnss/signal.h"

namespace canyon::gnss {
namespace {

/// All that a pseudorange is made of; one model per effect.
struct Parts {
  std::unique_ptr<Constellation> constellation;
  std::unique_ptr<IonosphereModel> ionosphere;
  std::unique_ptr<TroposphereModel> troposphere;
  std::unique_ptr<EphemerisError> ephemeris_error;
  std::unique_ptr<PathModel> paths;
  std::unique_ptr<MultipathRule> multipath;
  std::unique_ptr<ReceiverClock> clock;
  std::unique_ptr<ReceiverMode> mode;
  std::unique_ptr<PositionSolver> solver;
  LinkBudget link;
  std::vector<std::string> warnings;
};

/// Forms pseudoranges from first principles and solves them. An epoch at GPS time t:
///
///   pseudorange = |satellite(t - light time), turned by the Earth - antenna(t)| + receiver clock - satellite clock
///                 + ionosphere + troposphere + broadcast error + multipath + code noise.
///
/// The receiver labels the epoch with its own clock (GnssEpoch::t = t + receiver clock), computes the satellites from
/// the pseudoranges alone, corrects according to its mode, and solves. The light time is the vacuum's: the 1e-7 s that
/// delays add move a satellite by 0.1 mm along the line of sight.
class PseudorangeSensor final : public GnssSensor {
 public:
  PseudorangeSensor(const GnssConfig& config, std::uint64_t seed, const LocalFrame& frame, Parts parts)
      : config_(config), frame_(frame), parts_(std::move(parts)), code_noise_(seed, "gnss.code_noise") {}

  GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p_A_W, const Eigen::Vector3d&,
                     const scene::SceneAt& scene) override {
    CANYON_CHECK(index >= 0, "index = ", index);
    CANYON_CHECK(p_A_W.allFinite(), "antenna position = ", p_A_W.transpose());
    ++counters_.epochs;
    GnssOutput out;
    out.truth.t = t;
    out.truth.p_A_E = frame_.to_E(p_A_W);
    out.truth.receiver_clock_m = parts_.clock->offset_m(index);
    out.epoch.t = t + out.truth.receiver_clock_m / kSpeedOfLight;

    const Horizon horizon(out.truth.p_A_E);
    const std::vector<Sight> sights = satellites_above_mask(t, out.truth.p_A_E, horizon);
    const std::vector<SignalPaths> paths = trace(p_A_W, sights, scene);

    std::vector<CorrectionInput> inputs;
    std::vector<std::size_t> truth_of;  // index of the truth record of each observation
    for (std::size_t i = 0; i < sights.size(); ++i) {
      GnssObservationTruth truth = describe(sights[i], paths[i]);
      const Reception reception = receive_signals(sights[i], paths[i], horizon);
      truth.tracked = reception.tracked && measure_range(index, t, sights[i], reception, out, truth, inputs);
      if (truth.tracked) truth_of.push_back(i);
      out.truth.satellites.push_back(truth);
    }

    const ReceiverParts receiver{*parts_.constellation, *parts_.mode, *parts_.solver, config_.solver_sigma_m,
                                 frame_.origin_E()};
    std::vector<Correction> corrections;
    out.fix = compute_fix(receiver, t, out.epoch, inputs, corrections);
    for (std::size_t k = 0; k < corrections.size(); ++k)
      keep_residual(corrections[k], out.truth.satellites[truth_of[k]]);
    return out;
  }

  GnssCounters counters() const override { return counters_; }
  std::vector<std::string> warnings() const override { return parts_.warnings; }

 private:
  struct Sight {
    SatelliteId sv;
    Transmission signal;
    SkyView view;
    Eigen::Vector3d direction_W;
  };

  std::vector<Sight> satellites_above_mask(GpsTime t, const Eigen::Vector3d& p_A_E, const Horizon& horizon) const {
    std::vector<Sight> sights;
    for (const SatelliteId sv : parts_.constellation->satellites()) {
      const auto signal = transmission_to(*parts_.constellation, sv, t, p_A_E);
      if (!signal) continue;
      const Eigen::Vector3d satellite_E = signal->p_E();
      const SkyView view = horizon.view(t, satellite_E);
      if (view.elevation_rad < config_.mask_deg * kDegree) continue;
      sights.push_back({sv, *signal, view, frame_.R_EW().transpose() * (satellite_E - p_A_E).normalized()});
    }
    return sights;
  }

  std::vector<SignalPaths> trace(const Eigen::Vector3d& p_A_W, const std::vector<Sight>& sights,
                                 const scene::SceneAt& scene) {
    std::vector<Eigen::Vector3d> directions_W;
    for (const auto& s : sights) directions_W.push_back(s.direction_W);
    std::vector<SignalPaths> paths(sights.size());
    parts_.paths->trace(p_A_W, directions_W, scene, paths, counters_);
    return paths;
  }

  GnssObservationTruth describe(const Sight& sight, const SignalPaths& paths) const {
    GnssObservationTruth truth;
    truth.sv = sight.sv;
    truth.elevation_rad = sight.view.elevation_rad;
    truth.azimuth_rad = sight.view.azimuth_rad;
    truth.line_of_sight = paths.line_of_sight;
    const double cutoff_m = cutoff();
    truth.reflections =
        static_cast<int>(std::count_if(paths.echoes.begin(), paths.echoes.end(), [=](const SignalPath& p) {
          return p.reflections > 0 && p.excess_m < cutoff_m;
        }));
    truth.range_m = sight.signal.range_m;
    return truth;
  }

  double cutoff() const { return config_.cutoff_ns * 1e-9 * kSpeedOfLight; }

  Reception receive_signals(const Sight& sight, const SignalPaths& paths, const Horizon& horizon) const {
    const Eigen::Vector3d up_W = frame_.R_EW().transpose() * horizon.R_E_enu().col(2);
    std::vector<ReceivedReflection> reflections;
    for (const auto& p : paths.echoes) reflections.push_back(receive(p, parts_.link, up_W));
    std::optional<double> direct_cn0_dbhz;
    if (paths.line_of_sight)
      direct_cn0_dbhz = parts_.link.direct_cn0_dbhz(sight.view.elevation_rad, paths.foliage_m, std::abs(paths.direct));
    return parts_.multipath->receive(direct_cn0_dbhz, reflections);
  }

  /// Appends the observation. False, and nothing appended, in the millisecond in which a satellite's last ephemeris
  /// expires between the true time of transmission and the satellite clock's reading.
  bool measure_range(std::int64_t index, GpsTime t, const Sight& sight, const Reception& reception, GnssOutput& out,
                     GnssObservationTruth& truth, std::vector<CorrectionInput>& inputs) const {
    const RangeDelays raw{parts_.ionosphere->delay_m(sight.view), parts_.troposphere->delay_m(sight.view),
                          parts_.ephemeris_error->range_m(sight.sv, sight.signal.state.p_E, t)};
    const RangeDelays acting = parts_.mode->acting(raw);
    const double noise_m = config_.code_noise_m *
                           relative_code_noise(reception.cn0_dbhz, config_.correlator_spacing_chips) *
                           code_noise_.normal(sight.sv.entity(), static_cast<std::uint64_t>(index));
    GnssObservation o;
    o.sv = sight.sv;
    o.cn0_dbhz = reception.cn0_dbhz;
    o.pseudorange_m = sight.signal.range_m + out.truth.receiver_clock_m -
                      kSpeedOfLight * sight.signal.state.clock_of_band_s(first_band(o.sv.system)) +
                      acting.ionosphere_m + acting.troposphere_m + acting.ephemeris_m + reception.error_m + noise_m;
    CANYON_CHECK(std::isfinite(o.pseudorange_m) && std::isfinite(o.cn0_dbhz), "pseudorange sensor, ", o.sv.str(),
                 ": pseudorange_m = ", o.pseudorange_m, ", cn0_dbhz = ", o.cn0_dbhz);
    if (!transmission_from_pseudorange(*parts_.constellation, o.sv, out.epoch.t, o.pseudorange_m)) return false;

    truth.ionosphere_m = acting.ionosphere_m;
    truth.troposphere_m = acting.troposphere_m;
    truth.ephemeris_m = acting.ephemeris_m;
    truth.multipath_m = reception.error_m;
    truth.noise_m = noise_m;
    out.epoch.observations.push_back(o);
    inputs.push_back({sight.sv, t, sight.view, {}, sight.signal.range_m, acting});
    return true;
  }

  /// The truth record keeps what the receiver's corrections leave; the base station's error counts as noise.
  static void keep_residual(const Correction& c, GnssObservationTruth& truth) {
    truth.ionosphere_m -= c.modelled.ionosphere_m;
    truth.troposphere_m -= c.modelled.troposphere_m;
    truth.ephemeris_m -= c.modelled.ephemeris_m;
    truth.noise_m -= c.base_m;
  }

  GnssConfig config_;
  LocalFrame frame_;
  Parts parts_;
  RandomStream code_noise_;
  GnssCounters counters_;
};

/// The row of a ladder that the configuration names.
template <class Make>
Result<const ModelRow<Make>*> choose(std::span<const ModelRow<Make>> rows, const char* key, const std::string& name) {
  if (const auto* row = find_model(rows, name)) return row;
  std::string all;
  for (const auto& n : model_names(rows)) all += (all.empty() ? "" : ", ") + n;
  return Error{"", 0, std::string("gnss.") + key, "\"" + name + "\" is not a model", all};
}

/// The satellites, and what their navigation message says about the ionosphere.
Result<KlobucharCoefficients> make_satellites(const GnssConfig& config, GpsTime start, GpsTime end, Parts& parts) {
  if (config.nav_file.empty()) {
    parts.constellation = make_nominal_gps();
    return kBuiltInKlobuchar;
  }
  CANYON_TRY(const NavigationData data, read_navigation_file(config.nav_file));
  CANYON_TRY_STATUS(check_coverage(data, "G", start, end, "gnss.nav_file"));
  parts.warnings = data.warnings;
  parts.constellation = make_broadcast(data, {.systems = "G"});
  return data.klobuchar_at(GnssSystem::kGps, start).value_or(kBuiltInKlobuchar);
}

}  // namespace

Result<std::unique_ptr<GnssSensor>> make_pseudorange_sensor(const GnssConfig& c, std::uint64_t seed, GpsTime start,
                                                            GpsTime end, const scene::Scene& scene) {
  CANYON_TRY(const auto* ionosphere, choose(ionosphere_models(), "ionosphere", c.ionosphere));
  CANYON_TRY(const auto* troposphere, choose(troposphere_models(), "troposphere", c.troposphere));
  CANYON_TRY(const auto* ephemeris_error, choose(ephemeris_error_models(), "ephemeris_error", c.ephemeris_error));
  CANYON_TRY(const auto* paths, choose(path_models(), "paths", c.paths));
  CANYON_TRY(const auto* multipath, choose(multipath_rules(), "multipath_rule", c.multipath_rule));
  CANYON_TRY(const auto* clock, choose(receiver_clock_models(), "receiver_clock", c.receiver_clock));
  CANYON_TRY(const auto* mode, choose(receiver_modes(), "mode", c.mode));
  CANYON_TRY(const auto* solver, choose(position_solvers(), "solver", c.solver));

  Parts parts;
  CANYON_TRY(const KlobucharCoefficients klobuchar, make_satellites(c, start, end, parts));
  parts.ionosphere = ionosphere->make({c.vtec_tecu, klobuchar});
  parts.troposphere = troposphere->make({c.pressure_hpa, c.temperature_c, c.relative_humidity});
  parts.ephemeris_error = ephemeris_error->make({seed, c.ephemeris_sigma_m, c.ephemeris_tau_s});
  parts.paths = paths->make({c.reflection_reach_m});
  parts.multipath =
      multipath->make({c.cutoff_ns * 1e-9 * kSpeedOfLight, c.tracking_threshold_dbhz, c.correlator_spacing_chips});
  parts.clock = clock->make({seed, 1.0 / c.rate_hz});
  parts.mode = mode->make({seed, c.ionosphere != "none", c.troposphere != "none", c.ionosphere_correction, klobuchar,
                           c.baseline_km, c.ionosphere_gradient_mm_per_km, c.troposphere_gradient_mm_per_km,
                           c.base_error_scale});
  parts.solver = solver->make({c.max_gdop});
  parts.link = {c.cn0_zenith_dbhz, c.antenna_horizon_loss_db, c.lhcp_rejection_db, c.foliage_db_per_m,
                c.foliage_max_db};
  if (!parts.solver->solves_clock() && c.receiver_clock != "none")
    return Error{"", 0, "gnss.receiver_clock",
                 "is \"" + c.receiver_clock + "\", but solver \"" + c.solver + "\" has no unknown for it", "\"none\""};
  return std::unique_ptr<GnssSensor>(std::make_unique<PseudorangeSensor>(c, seed, scene.frame(), std::move(parts)));
}

}  // namespace canyon::gnss
