#include "canyon/apps/answers/sky.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <nlohmann/json.hpp>

#include "canyon/core/math/median.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/report/draw/sky_plot.h"

namespace canyon::apps {

namespace {

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

report::SkyPlot plot_of(const SkyAnswer& a) {
  const GnssSetup& setup = a.setup;
  const Geodetic& g = a.place;
  report::SkyPlot plot;
  plot.title = "Sky at " + printed("%.5f°, %.5f°, %.1f m", g.lat_rad / kDegree, g.lon_rad / kDegree, g.h_m);
  plot.subtitle = setup.start.iso(0) + " GPS time" +
                  (a.duration_s > 0.0 ? printed(" and the %.1f hours that follow", a.duration_s / 3600.0) : "") +
                  "; scene: " + setup.scene_name;
  plot.mask_deg = setup.config.mask_deg;
  plot.blocked = [&a](int azimuth, int elevation) { return a.mask.blocked(azimuth, elevation); };
  std::map<SatelliteId, report::SkyTrack> tracks;
  std::map<SatelliteId, double> last;
  for (const gnss::SkyEpoch& e : a.epochs) {
    throw_if_cancelled();
    for (const GnssObservationTruth& s : e.output.truth.satellites) {
      // A satellite that set and rose again gets a second track.
      if (last.contains(s.sv) && e.t_s - last[s.sv] > 1.5 * a.step_s) {
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

}  // namespace

Json sky_json(const SkyAnswer& a) {
  Json out;
  out["start"] = a.setup.start.iso();
  out["open_sky_share_above_10_deg"] = a.mask.open_share(10);
  out["epochs"] = Json::array();
  for (const gnss::SkyEpoch& e : a.epochs) {
    throw_if_cancelled();
    Json satellites = Json::array();
    for (const GnssObservationTruth& s : e.output.truth.satellites)
      satellites.push_back({{"satellite", s.sv.str()},
                            {"elevation_deg", s.elevation_rad / kDegree},
                            {"azimuth_deg", s.azimuth_rad / kDegree},
                            {"cn0_dbhz", or_null(gnss::cn0_of(e.output, s.sv))},
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

void print_sky(const SkyAnswer& a) {
  const GnssSetup& setup = a.setup;
  const Geodetic& g = a.place;
  const auto& epochs = a.epochs;
  const gnss::GnssOutput& first = epochs.front().output;
  std::printf("Sky at %.6f deg, %.6f deg, %.1f m; %s GPS time; scene: %s\n\n", g.lat_rad / kDegree, g.lon_rad / kDegree,
              g.h_m, setup.start.iso(0).c_str(), setup.scene_name.c_str());
  std::printf("  satellite  elevation  azimuth   C/N0\n                   deg      deg  dB-Hz\n");
  for (const GnssObservationTruth& s : first.truth.satellites) {
    const double cn0 = gnss::cn0_of(first, s.sv);
    std::printf("  %-9s  %9.1f  %7.1f  %5s  %s\n", s.sv.str().c_str(), s.elevation_rad / kDegree,
                s.azimuth_rad / kDegree, std::isfinite(cn0) ? printed("%.1f", cn0).c_str() : "-", word(s));
  }
  const Dop& d = first.fix.dop;
  if (first.fix.status != FixStatus::kNone)
    std::printf("\n%d satellites in the fix: GDOP %.2f, PDOP %.2f, HDOP %.2f, VDOP %.2f\n", first.fix.satellites,
                d.gdop, d.pdop, d.hdop, d.vdop);
  else
    std::printf("\nno fix: %s\n", first.fix.reason.c_str());
  std::printf("open sky above 10 deg: %.0f %% of the solid angle\n", 100.0 * a.mask.open_share(10));
  if (epochs.size() == 1) return;
  std::vector<double> gdop, satellites;
  for (const gnss::SkyEpoch& e : epochs) {
    satellites.push_back(e.output.fix.satellites);
    if (e.output.fix.status != FixStatus::kNone) gdop.push_back(e.output.fix.dop.gdop);
  }
  std::printf("over %zu epochs: fix in %zu; GDOP median %.2f, max %.2f; satellites median %.0f, fewest %.0f\n",
              epochs.size(), gdop.size(), median(gdop),
              gdop.empty() ? kNaN : *std::max_element(gdop.begin(), gdop.end()), median(satellites),
              *std::min_element(satellites.begin(), satellites.end()));
}

std::string sky_svg(const SkyAnswer& answer) {
  return report::sky_plot_svg(plot_of(answer));
}

}  // namespace canyon::apps
