#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/json.h"
#include "canyon/apps/options/gnss_errors.h"
#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/earth/geoid.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/place_files.h"
#include "canyon/core/fix_status.h"
#include "canyon/core/math/median.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/gnss/nmea/nmea_writer.h"
#include "canyon/gnss/rinex/navigation/navigation_writer.h"
#include "canyon/gnss/rinex/navigation/simulated_navigation.h"
#include "canyon/gnss/rinex/observation/observation_writer.h"
#include "canyon/gnss/sensor/satellite_source.h"

namespace canyon::apps {

namespace {

struct Options {
  GnssSetupOptions setup;
  std::string at, trajectory, errors = "all", nmea, rinex_obs, rinex_nav;
  double duration_s = 0.0, rate_hz = 1.0;
};

std::string text(const char* format, auto... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

std::string field(double value, int decimals) {
  return std::isfinite(value) ? text("%.*f", decimals, value) : std::string();
}

/// Where the antenna goes: --at, or --trajectory.
Result<PlacePath> antenna_path(const Options& options, const GnssSetup& setup, const std::optional<Geodetic>& at) {
  if (at) return PlacePath({{setup.start, ecef_from_geodetic(*at)}});
  if (options.trajectory.ends_with(".tum")) {
    CANYON_TRY(const Trajectory trajectory, read_tum(options.trajectory));
    return PlacePath(trajectory, setup.scene->frame(), setup.config.lever_arm_m);
  }
  CANYON_TRY(auto places, read_places(options.trajectory));
  for (const StampedPlace& place : places)
    CANYON_TRY_STATUS(gnss::check_antenna_height(place.p_E, {.file = options.trajectory, .line = place.line}));
  return PlacePath(std::move(places));
}

/// What lies between an antenna and the scene's ground.
class GroundCheck {
 public:
  explicit GroundCheck(const scene::Scene& scene) : scene_(scene) {}

  /// Terrain hides the sky from an antenna below it; where the place was typed in, that is a mistake.
  void add(const Eigen::Vector3d& p_A_W) {
    const auto ground = scene_.ground(p_A_W.x(), p_A_W.y());
    if (!ground || p_A_W.z() >= ground->height_m) return;
    ++below_;
    deepest_m_ = std::max(deepest_m_, ground->height_m - p_A_W.z());
  }
  std::int64_t below() const { return below_; }
  double deepest_m() const { return deepest_m_; }

 private:
  const scene::Scene& scene_;
  std::int64_t below_ = 0;
  double deepest_m_ = 0.0;
};

/// Collects what is told at the end.
struct Totals {
  std::int64_t epochs = 0, fixes = 0, tracked = 0, nlos = 0, used = 0;
  double square_m2 = 0.0;
  std::vector<double> gdop;

  void add(const gnss::GnssOutput& output) {
    ++epochs;
    for (const GnssObservationTruth& s : output.truth.satellites) {
      if (!s.tracked) continue;
      ++tracked;
      nlos += s.line_of_sight ? 0 : 1;
    }
    if (output.fix.status == FixStatus::kNone) return;
    ++fixes;
    used += output.fix.satellites;
    square_m2 += (output.fix.p_A_E - output.truth.p_A_E).squaredNorm();
    if (std::isfinite(output.fix.dop.gdop)) gdop.push_back(output.fix.dop.gdop);
  }
  double satellites_mean() const {
    return epochs > 0 ? static_cast<double>(tracked) / static_cast<double>(epochs) : kNaN;
  }
  double nlos_share() const { return tracked > 0 ? static_cast<double>(nlos) / static_cast<double>(tracked) : kNaN; }
  double rms_m() const { return fixes > 0 ? std::sqrt(square_m2 / static_cast<double>(fixes)) : kNaN; }
  double gdop_median() const { return median(gdop); }
};

/// The files of a simulation, filled epoch by epoch.
class Recorder {
 public:
  /// `undulation_m`: of the scene, 0 where it has none; then the geoid's at each place.
  explicit Recorder(double undulation_m) : undulation_m_(undulation_m) {}

  void add(const gnss::GnssOutput& output) {
    epochs_.push_back(output.epoch);
    nmea_ += nmea_of(output);
    add_fix(output);
    add_satellites(output);
  }
  const std::vector<GnssEpoch>& epochs() const { return epochs_; }
  const std::string& nmea() const { return nmea_; }
  const std::string& fixes() const { return fixes_; }
  const std::string& satellites() const { return satellites_; }

 private:
  std::string nmea_of(const gnss::GnssOutput& output) {
    const double undulation_m =
        undulation_m_ != 0.0 ? undulation_m_ : geoid_.undulation_m(geodetic_from_ecef(output.truth.p_A_E));
    gnss::NmeaEpoch epoch{.fix = output.fix, .undulation_m = undulation_m, .satellites = {}};
    for (const GnssObservationTruth& s : output.truth.satellites) {
      gnss::NmeaSatellite satellite{s.sv, s.elevation_rad, s.azimuth_rad};
      for (const GnssObservation& o : output.epoch.observations)
        if (o.sv == s.sv) {
          satellite.cn0_dbhz = o.cn0_dbhz;
          satellite.used = o.used;
        }
      epoch.satellites.push_back(satellite);
    }
    return gnss::nmea_text(epoch);
  }

  void add_fix(const gnss::GnssOutput& output) {
    const GnssFix& fix = output.fix;
    const Eigen::Vector3d& truth = output.truth.p_A_E;
    const Eigen::Vector3d error = rotation_E_from_enu(geodetic_from_ecef(truth)).transpose() * (fix.p_A_E - truth);
    fixes_ += text("%d,%.9f,%s,%d", fix.t.week(), fix.t.sow_s(), fix_status_name(fix.status), fix.satellites);
    for (const double dop : {fix.dop.gdop, fix.dop.pdop, fix.dop.hdop, fix.dop.vdop}) fixes_ += "," + field(dop, 3);
    for (const Eigen::Vector3d& v : {fix.p_A_E, truth, error})
      for (int i = 0; i < 3; ++i) fixes_ += "," + field(v[i], 4);
    fixes_ += "\n";
  }

  void add_satellites(const gnss::GnssOutput& output) {
    for (const GnssObservationTruth& s : output.truth.satellites) {
      GnssObservation measured;
      for (const GnssObservation& o : output.epoch.observations)
        if (o.sv == s.sv) measured = o;
      satellites_ += text("%d,%.9f,%s,%.4f,%.4f,%d,%d,%d,", output.fix.t.week(), output.fix.t.sow_s(),
                          s.sv.str().c_str(), s.elevation_rad / kDegree, s.azimuth_rad / kDegree,
                          s.line_of_sight ? 1 : 0, s.tracked ? 1 : 0, s.reflections) +
                     field(measured.pseudorange_m, 4) + "," + field(measured.doppler_hz, 4) + "," +
                     field(measured.carrier_phase_cycles, 4) + "," + field(measured.cn0_dbhz, 2);
      for (const double error : {s.range_m, s.multipath_m, s.ionosphere_m, s.troposphere_m, s.ephemeris_m, s.noise_m})
        satellites_ += "," + field(s.tracked ? error : kNaN, 4);
      satellites_ += "\n";
    }
  }

  double undulation_m_;
  Geoid geoid_;
  std::vector<GnssEpoch> epochs_;
  std::string nmea_;
  std::string fixes_ =
      "gps_week,sow,status,satellites,gdop,pdop,hdop,vdop,x_m,y_m,z_m,true_x_m,true_y_m,true_z_m,error_e_m,error_n_m,"
      "error_u_m\n";
  std::string satellites_ =
      "gps_week,sow,satellite,elevation_deg,azimuth_deg,line_of_sight,tracked,reflections,pseudorange_m,doppler_hz,"
      "carrier_phase_cycles,cn0_dbhz,range_m,multipath_m,ionosphere_m,troposphere_m,ephemeris_m,noise_m\n";
};

/// RINEX observations of what was measured, with the bands that occur in each system.
Result<std::string> observations(const std::vector<GnssEpoch>& epochs, const Options& options,
                                 const gnss::SatelliteSource& source, const Eigen::Vector3d& start_E) {
  gnss::ObservationWriterOptions header;
  header.first = epochs.front().t;
  header.interval_s = 1.0 / options.rate_hz;
  if (!options.at.empty()) header.approx_position_E = start_E;
  std::map<GnssSystem, std::set<int>> bands;
  for (const GnssEpoch& epoch : epochs) {
    throw_if_cancelled();
    for (const GnssObservation& o : epoch.observations) {
      bands[o.sv.system].insert(o.band);
      if (o.second.band != 0) bands[o.sv.system].insert(o.second.band);
      if (o.sv.system != GnssSystem::kGlonass) continue;
      if (const auto state = source.constellation->state(o.sv, epoch.t))
        header.glonass_channels[o.sv.prn] = state->frequency_channel;
    }
  }
  if (bands.empty()) return Error{options.rinex_obs, 0, "", "nothing was received", "at least one satellite"};
  for (const auto& [system, digits] : bands)
    header.bands.emplace_back(system, std::vector<int>(digits.begin(), digits.end()));
  const gnss::ObservationWriter writer(header);
  std::string out = writer.header();
  for (const GnssEpoch& epoch : epochs) {
    throw_if_cancelled();
    out += writer.epoch(epoch);
  }
  return out;
}

/// RINEX navigation of the satellites simulated; warns of those that it cannot describe.
Result<std::string> navigation(const gnss::SatelliteSource& source, const std::string& systems, GpsTime start,
                               GpsTime end) {
  CANYON_TRY(auto simulated, gnss::simulated_navigation(*source.constellation, source.navigation, systems, start, end));
  for (const std::string& warning : simulated.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (!simulated.data.klobuchar_at(GnssSystem::kGps, start))
    simulated.data.klobuchar.push_back({GnssSystem::kGps, start, source.klobuchar});
  return gnss::navigation_file_text(simulated.data);
}

void tell(const Options& options, const Totals& totals, const GnssSetup& setup) {
  if (options.setup.common.json) {
    const Json json{{"epochs", totals.epochs},
                    {"fixes", totals.fixes},
                    {"satellites_mean", or_null(totals.satellites_mean())},
                    {"nlos_share", or_null(totals.nlos_share())},
                    {"gdop_median", or_null(totals.gdop_median())},
                    {"rms_3d_m", or_null(totals.rms_m())}};
    std::printf("%s\n", json.dump().c_str());
    return;
  }
  std::printf("%lld epochs from %s GPS time, scene: %s\n", static_cast<long long>(totals.epochs),
              setup.start.iso().c_str(), setup.scene_name.c_str());
  std::printf("  satellites tracked, mean   %8.2f\n", totals.satellites_mean());
  std::printf("  NLOS share of tracked, %%   %8.1f\n", 100.0 * totals.nlos_share());
  std::printf("  epochs with a fix          %8lld\n", static_cast<long long>(totals.fixes));
  std::printf("  GDOP, median               %8.2f\n", totals.gdop_median());
  std::printf("  3-D error, RMS, m          %8.3f\n", totals.rms_m());
}

Result<int> run(const Options& options) {
  set_threads(options.setup.common.threads);
  std::optional<Geodetic> at;
  if (!options.at.empty()) {
    CANYON_TRY(at, parse_place(options.at, "--at"));
  }
  CANYON_TRY(GnssSetup setup, gnss_setup(options.setup, at));
  CANYON_TRY_STATUS(keep_errors(options.errors, setup.config));
  setup.config.rate_hz = options.rate_hz;
  CANYON_TRY(const PlacePath path, antenna_path(options, setup, at));
  if (!at && options.setup.start.empty()) setup.start = path.first();
  double duration_s = options.duration_s;
  if (!at && duration_s == 0.0) duration_s = path.last() - setup.start;
  if (!at && (setup.start < path.first() || path.last() < setup.start + duration_s))
    return Error{options.trajectory, 0, "", "covers " + path.first().iso() + " to " + path.last().iso(),
                 "all of " + setup.start.iso() + " and the " + text("%g s", duration_s) + " that follow"};
  // Open sky stands where the way begins.
  if (!at && options.setup.scene == "none") {
    CANYON_TRY(const GnssSetup there, gnss_setup(options.setup, geodetic_from_ecef(path.at(setup.start)->p_E)));
    setup.scene = there.scene;
  }
  const LocalFrame& frame = setup.scene->frame();
  const scene::SceneAt scene(*setup.scene);
  CANYON_TRY(const auto sensor,
             make_gnss_sensor(setup.config, setup.seed, setup.start, setup.start + duration_s, *setup.scene));

  OutputSet outputs(options.setup.force);
  CANYON_TRY(const StagedDirectory* const folder, outputs.directory(options.setup.out));
  CANYON_TRY(StagedFile* const rinex_obs, outputs.file(options.rinex_obs));
  CANYON_TRY(StagedFile* const rinex_nav, outputs.file(options.rinex_nav));
  CANYON_TRY(StagedFile* const nmea, outputs.file(options.nmea));
  CANYON_TRY(const auto source, make_satellite_source(setup.config, setup.start, setup.start + duration_s));
  GroundCheck ground(*setup.scene);
  if (at) {
    ground.add(frame.from_geodetic(*at));
    if (ground.below() > 0)
      return Error{"--at", 0, "", text("the antenna would be %.2f m below the ground of the scene", ground.deepest_m()),
                   "an ellipsoidal height above it"};
  }
  const auto count = static_cast<std::int64_t>(std::floor(duration_s * options.rate_hz + 1e-9)) + 1;
  Progress progress("simulating", static_cast<double>(count), !options.setup.common.json);
  Recorder recorder(setup.scene->parts().undulation_m);
  Totals totals;
  for (std::int64_t k = 0; k < count; ++k) {
    throw_if_cancelled();
    const GpsTime t = tick(setup.start, k, options.rate_hz);
    const auto state = path.at(t);
    if (!state) break;  // the last tick may round to a nanosecond past the end
    // Between places the way is a smooth curve, which may lead where they do not.
    CANYON_TRY_STATUS(gnss::check_antenna_height(state->p_E, {options.trajectory, 0, t.iso()}));
    const Eigen::Vector3d p_A_W = frame.to_W(state->p_E);
    ground.add(p_A_W);
    const auto output = sensor->measure(k, t, p_A_W, frame.R_EW().transpose() * state->v_E, scene);
    totals.add(output);
    recorder.add(output);
    progress.advance(1.0);
  }

  for (const std::string& warning : sensor->warnings()) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (ground.below() > 0)
    std::fprintf(
        stderr,
        "warning: %s: the antenna is below the ground of the scene in %lld of %lld epochs, by up to %.2f m, and "
        "receives nothing there; heights are ellipsoidal\n",
        options.trajectory.c_str(), static_cast<long long>(ground.below()), static_cast<long long>(totals.epochs),
        ground.deepest_m());
  if (folder != nullptr) {
    CANYON_TRY_STATUS(write_text_file(folder->staging_path() + "/fixes.csv", recorder.fixes()));
    CANYON_TRY_STATUS(write_text_file(folder->staging_path() + "/satellites.csv", recorder.satellites()));
  }
  if (rinex_obs != nullptr) {
    CANYON_TRY(const std::string text, observations(recorder.epochs(), options, source, path.at(setup.start)->p_E));
    CANYON_TRY_STATUS(rinex_obs->write(text));
  }
  if (rinex_nav != nullptr) {
    CANYON_TRY(const std::string text, navigation(source, setup.config.systems, setup.start, setup.start + duration_s));
    CANYON_TRY_STATUS(rinex_nav->write(text));
  }
  if (nmea != nullptr) CANYON_TRY_STATUS(nmea->write(recorder.nmea()));
  CANYON_TRY_STATUS(outputs.commit());
  tell(options, totals, setup);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_gnss_setup(arguments, options->setup, "none");
  const auto at =
      arguments.option("--at", options->at, "LAT,LON,H of the antenna: degrees, degrees, ellipsoidal metres");
  const auto trajectory = arguments.option(
      "--trajectory", options->trajectory,
      "way of the antenna: CSV of gps_week,sow and lat_deg,lon_deg,h_m or x_m,y_m,z_m; or .tum, poses of "
      "the vehicle in the scene's frame W");
  at.excludes(trajectory);
  arguments.option("--duration", options->duration_s, "seconds; default: one epoch with --at, all of --trajectory")
      .within(0.0, 30.0 * 86400.0);
  arguments.option("--rate", options->rate_hz, "epochs per second").default_shown().within(1e-3, 100.0);
  arguments
      .option("--errors", options->errors,
              "all, none, or a list of: ionosphere,troposphere,ephemeris,receiver_clock,multipath,noise,base_station")
      .default_shown();
  arguments.option("--rinex-obs", options->rinex_obs, "RINEX 3.04 observation file to write");
  arguments.option("--rinex-nav", options->rinex_nav,
                   "RINEX 3.04 navigation file to write, of the satellites simulated");
  arguments.option("--nmea", options->nmea, "NMEA 0183 log to write: GGA, RMC, GSA, GSV");
  return [options]() -> Result<int> {
    if (options->at.empty() && options->trajectory.empty())
      return Error{"", 0, "command line", "no place given", "--at LAT,LON,H or --trajectory FILE"};
    return run(*options);
  };
}

}  // namespace

Verb gnss_simulate_verb() {
  return {"gnss simulate", "measurements at a point or along a way, as RINEX, NMEA and CSV",
          "canyon gnss simulate --at 32.35,-90.88,60 --duration 3600 --rate 1 --nmea log.nmea --out out", declare};
}

}  // namespace canyon::apps
