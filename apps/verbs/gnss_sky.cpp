#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/json.h"
#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/files/files.h"
#include "canyon/core/math/median.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/gnss/paths/obstruction.h"
#include "canyon/report/draw/sky_plot.h"

namespace canyon::apps {

namespace {

struct Options {
  GnssSetupOptions setup;
  std::string at, xy;
  double height_m = 1.5, duration_s = 0.0, step_s = 300.0;
};

struct Epoch {
  double t_s = 0.0;
  gnss::GnssOutput output;
};

std::string text(const char* format, auto... values) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

/// The antenna in W: --at, or --xy above the ground of the scene.
Result<Eigen::Vector3d> antenna(const Options& options, const scene::Scene& scene, const std::optional<Geodetic>& at) {
  if (at) {
    const Eigen::Vector3d p_A_W = scene.frame().from_geodetic(*at);
    const auto ground = scene.ground(p_A_W.x(), p_A_W.y());
    if (ground && p_A_W.z() < ground->height_m)
      return Error{"--at", 0, "",
                   text("the antenna would be %.2f m below the ground of the scene", ground->height_m - p_A_W.z()),
                   "an ellipsoidal height above it"};
    return p_A_W;
  }
  CANYON_TRY(const auto xy, parse_numbers(options.xy, 2, "--xy", "X,Y: metres east and north of the scene's origin"));
  const double x = xy[0], y = xy[1];
  const auto ground = scene.ground(x, y);
  if (!ground)
    return Error{"--xy", 0, "", "\"" + options.xy + "\" lies outside the scene", "X,Y in metres from its origin"};
  const Eigen::Vector3d p_A_W(x, y, ground->height_m + options.height_m);
  CANYON_TRY_STATUS(gnss::check_antenna_height(scene.frame().to_E(p_A_W), {.file = "--xy, --height"}));
  return p_A_W;
}

report::SkyState state_of(const GnssObservationTruth& s) {
  if (!s.tracked) return report::SkyState::kNotTracked;
  if (!s.line_of_sight) return report::SkyState::kReflectedOnly;
  return s.reflections > 0 ? report::SkyState::kDirectAndReflected : report::SkyState::kDirect;
}

const char* word(const GnssObservationTruth& s) {
  switch (state_of(s)) {
    case report::SkyState::kDirect:
      return "direct";
    case report::SkyState::kDirectAndReflected:
      return "direct and reflected";
    case report::SkyState::kReflectedOnly:
      return "by reflection or diffraction only";
    case report::SkyState::kNotTracked:
      return s.line_of_sight ? "not tracked" : "hidden";
  }
  return "";
}

double cn0_of(const gnss::GnssOutput& output, SatelliteId sv) {
  for (const GnssObservation& o : output.epoch.observations)
    if (o.sv == sv) return o.cn0_dbhz;
  return kNaN;
}

std::string satellites_csv(const std::vector<Epoch>& epochs) {
  std::string out = "t_s,satellite,elevation_deg,azimuth_deg,cn0_dbhz,line_of_sight,tracked,reflections,multipath_m\n";
  for (const Epoch& e : epochs) {
    throw_if_cancelled();
    for (const GnssObservationTruth& s : e.output.truth.satellites) {
      const double cn0 = cn0_of(e.output, s.sv);
      out += text("%.3f,%s,%.3f,%.3f,%s,%d,%d,%d,%s\n", e.t_s, s.sv.str().c_str(), s.elevation_rad / kDegree,
                  s.azimuth_rad / kDegree, std::isfinite(cn0) ? text("%.2f", cn0).c_str() : "", s.line_of_sight ? 1 : 0,
                  s.tracked ? 1 : 0, s.reflections, s.tracked ? text("%.3f", s.multipath_m).c_str() : "");
    }
  }
  return out;
}

std::string dop_csv(const std::vector<Epoch>& epochs) {
  std::string out = "t_s,satellites,gdop,pdop,hdop,vdop,tdop\n";
  for (const Epoch& e : epochs) {
    out += text("%.3f,%d", e.t_s, e.output.fix.satellites);
    const Dop& d = e.output.fix.dop;
    for (const double dop : {d.gdop, d.pdop, d.hdop, d.vdop, d.tdop})
      out += std::isfinite(dop) ? text(",%.3f", dop) : std::string(",");
    out += "\n";
  }
  return out;
}

report::SkyPlot plot_of(const std::vector<Epoch>& epochs, const gnss::ObstructionMask& mask, const Options& options,
                        const GnssSetup& setup, const Geodetic& g) {
  report::SkyPlot plot;
  plot.title = "Sky at " + text("%.5f°, %.5f°, %.1f m", g.lat_rad / kDegree, g.lon_rad / kDegree, g.h_m);
  plot.subtitle =
      setup.start.iso(0) + " GPS time" +
      (options.duration_s > 0.0 ? text(" and the %.1f hours that follow", options.duration_s / 3600.0) : "") +
      "; scene: " + setup.scene_name;
  plot.mask_deg = setup.config.mask_deg;
  plot.blocked = [&mask](int azimuth, int elevation) { return mask.blocked(azimuth, elevation); };
  std::map<SatelliteId, report::SkyTrack> tracks;
  std::map<SatelliteId, double> last;
  for (const Epoch& e : epochs) {
    throw_if_cancelled();
    for (const GnssObservationTruth& s : e.output.truth.satellites) {
      // A satellite that set and rose again gets a second track.
      if (last.contains(s.sv) && e.t_s - last[s.sv] > 1.5 * options.step_s) {
        plot.tracks.push_back(std::move(tracks[s.sv]));
        tracks.erase(s.sv);
      }
      last[s.sv] = e.t_s;
      report::SkyTrack& track = tracks[s.sv];
      track.name = s.sv.str();
      track.points.push_back({s.azimuth_rad / kDegree, s.elevation_rad / kDegree, state_of(s)});
    }
  }
  for (auto& [sv, track] : tracks) plot.tracks.push_back(std::move(track));
  return plot;
}

Json json_of(const std::vector<Epoch>& epochs, const gnss::ObstructionMask& mask, const GnssSetup& setup) {
  Json out;
  out["start"] = setup.start.iso();
  out["open_sky_share_above_10_deg"] = mask.open_share(10);
  out["epochs"] = Json::array();
  for (const Epoch& e : epochs) {
    throw_if_cancelled();
    Json satellites = Json::array();
    for (const GnssObservationTruth& s : e.output.truth.satellites)
      satellites.push_back({{"satellite", s.sv.str()},
                            {"elevation_deg", s.elevation_rad / kDegree},
                            {"azimuth_deg", s.azimuth_rad / kDegree},
                            {"cn0_dbhz", or_null(cn0_of(e.output, s.sv))},
                            {"line_of_sight", s.line_of_sight},
                            {"tracked", s.tracked},
                            {"reflections", s.reflections}});
    const Dop& d = e.output.fix.dop;
    out["epochs"].push_back({{"t_s", e.t_s},
                             {"fix", e.output.fix.status != FixStatus::kNone},
                             {"gdop", or_null(d.gdop)},
                             {"pdop", or_null(d.pdop)},
                             {"hdop", or_null(d.hdop)},
                             {"vdop", or_null(d.vdop)},
                             {"satellites", satellites}});
  }
  return out;
}

void print(const std::vector<Epoch>& epochs, const gnss::ObstructionMask& mask, const GnssSetup& setup,
           const Geodetic& g) {
  const gnss::GnssOutput& first = epochs.front().output;
  std::printf("Sky at %.6f deg, %.6f deg, %.1f m; %s GPS time; scene: %s\n\n", g.lat_rad / kDegree, g.lon_rad / kDegree,
              g.h_m, setup.start.iso(0).c_str(), setup.scene_name.c_str());
  std::printf("  satellite  elevation  azimuth   C/N0\n                   deg      deg  dB-Hz\n");
  for (const GnssObservationTruth& s : first.truth.satellites) {
    const double cn0 = cn0_of(first, s.sv);
    std::printf("  %-9s  %9.1f  %7.1f  %5s  %s\n", s.sv.str().c_str(), s.elevation_rad / kDegree,
                s.azimuth_rad / kDegree, std::isfinite(cn0) ? text("%.1f", cn0).c_str() : "-", word(s));
  }
  const Dop& d = first.fix.dop;
  if (first.fix.status != FixStatus::kNone)
    std::printf("\n%d satellites in the fix: GDOP %.2f, PDOP %.2f, HDOP %.2f, VDOP %.2f\n", first.fix.satellites,
                d.gdop, d.pdop, d.hdop, d.vdop);
  else
    std::printf("\nno fix: %s\n", first.fix.reason.c_str());
  std::printf("open sky above 10 deg: %.0f %% of the solid angle\n", 100.0 * mask.open_share(10));
  if (epochs.size() == 1) return;
  std::vector<double> gdop, satellites;
  for (const Epoch& e : epochs) {
    satellites.push_back(e.output.fix.satellites);
    if (e.output.fix.status != FixStatus::kNone) gdop.push_back(e.output.fix.dop.gdop);
  }
  std::printf("over %zu epochs: fix in %zu; GDOP median %.2f, max %.2f; satellites median %.0f, fewest %.0f\n",
              epochs.size(), gdop.size(), median(gdop),
              gdop.empty() ? kNaN : *std::max_element(gdop.begin(), gdop.end()), median(satellites),
              *std::min_element(satellites.begin(), satellites.end()));
}

Result<int> run(const Options& options) {
  set_threads(options.setup.common.threads);
  std::optional<Geodetic> at;
  if (!options.at.empty()) {
    CANYON_TRY(at, parse_place(options.at, "--at"));
  }
  CANYON_TRY(const GnssSetup setup, gnss_setup(options.setup, at));
  CANYON_TRY(const Eigen::Vector3d p_A_W, antenna(options, *setup.scene, at));
  const scene::SceneAt scene(*setup.scene);
  CANYON_TRY(const auto sensor,
             make_gnss_sensor(setup.config, setup.seed, setup.start, setup.start + options.duration_s, *setup.scene));
  std::unique_ptr<StagedDirectory> staged;
  if (!options.setup.out.empty()) {
    CANYON_TRY(auto directory, StagedDirectory::create(options.setup.out, options.setup.force));
    staged = std::make_unique<StagedDirectory>(std::move(directory));
  }

  const auto count = static_cast<std::int64_t>(std::floor(options.duration_s / options.step_s + 1e-9)) + 1;
  std::vector<Epoch> epochs;
  for (std::int64_t k = 0; k < count; ++k) {
    throw_if_cancelled();
    const double t_s = static_cast<double>(k) * options.step_s;
    epochs.push_back({t_s, sensor->measure(gnss::epoch_index(setup.config, t_s), setup.start + t_s, p_A_W,
                                           Eigen::Vector3d::Zero(), scene)});
  }
  const Geodetic g = setup.scene->frame().to_geodetic(p_A_W);
  const Eigen::Matrix3d R_W_enu = setup.scene->frame().R_EW().transpose() * rotation_E_from_enu(g);
  const gnss::ObstructionMask mask(p_A_W, R_W_enu.col(2), R_W_enu.col(1), scene);

  for (const std::string& warning : sensor->warnings()) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (staged) {
    const std::string folder = staged->staging_path();
    CANYON_TRY_STATUS(write_text_file(folder + "/satellites.csv", satellites_csv(epochs)));
    CANYON_TRY_STATUS(write_text_file(folder + "/dop.csv", dop_csv(epochs)));
    CANYON_TRY_STATUS(
        write_text_file(folder + "/sky.svg", report::sky_plot_svg(plot_of(epochs, mask, options, setup, g))));
    CANYON_TRY_STATUS(staged->commit());
  }
  if (options.setup.common.json) {
    std::printf("%s\n", json_of(epochs, mask, setup).dump().c_str());
    return 0;
  }
  print(epochs, mask, setup, g);
  if (staged) std::printf("Files: %s/{sky.svg, satellites.csv, dop.csv}\n", staged->final_path().c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_gnss_setup(arguments, options->setup, "none");
  const auto at =
      arguments.option("--at", options->at, "LAT,LON,H of the antenna: degrees, degrees, ellipsoidal metres");
  const auto xy =
      arguments.option("--xy", options->xy, "X,Y of the antenna in the scene, metres east and north of its origin");
  at.excludes(xy);
  arguments.option("--height", options->height_m, "with --xy: metres above ground")
      .default_shown()
      .within(0.0, gnss::kHighestAntennaM);
  arguments.option("--duration", options->duration_s, "seconds to follow the sky").within(0.0, 7.0 * 86400.0);
  arguments.option("--step", options->step_s, "seconds between epochs").default_shown().within(0.1, 86400.0);
  return [options]() -> Result<int> {
    if (options->at.empty() && (options->xy.empty() || options->setup.scene == "none"))
      return Error{"", 0, "command line", "no place given", "--at LAT,LON,H, or --scene and --xy X,Y"};
    return run(*options);
  };
}

}  // namespace

Verb gnss_sky_verb() {
  return {"gnss sky", "sky plot with what the scene hides, satellites, DOP over time",
          "canyon gnss sky --scene vicksburg --xy 120,-40 --duration 7200 --out sky", declare};
}

}  // namespace canyon::apps
