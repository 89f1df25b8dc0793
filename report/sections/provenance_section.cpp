#include <array>
#include <cmath>
#include <utility>

#include "canyon/report/draw/html.h"
#include "canyon/report/format.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

std::string row(std::string_view name, const std::string& value) {
  return "<div><dt>" + std::string(name) + "</dt><dd>" +
         (value.empty() ? "<span class=\"undefined\">not recorded</span>" : escape_html(value)) + "</dd></div>\n";
}

/// The words a newcomer needs to read the page, as Canyon defines them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kWords{{
    {"Frames",
     "Positions are in the scene\xE2\x80\x99s local frame W: metres east, north and up of its origin. Times are "
     "seconds "
     "from the mission\xE2\x80\x99s start; instants are GPS time."},
    {"Error",
     "Estimate minus truth. RMS: root mean square over the run\xE2\x80\x99s epochs; 95 %: the value that 95 of 100 "
     "epochs stay below in size."},
    {"DOP jump", "Two consecutive epochs with |\xCE\x94GDOP| &gt; 2, or a change between fix and no fix."},
    {"NLOS share",
     "Tracked satellite-epochs whose direct path is blocked, of all tracked ones. GDOP figures are over solved "
     "epochs."},
    {"Fixes lost", "Due epochs without a solution."},
    {"Registration error", "Position of the scored keyframes against truth."},
    {"Map error", "Distance of the scored map points to the nearest true surface of the static scene."},
    {"Prior, registered",
     "A keyframe placed by the navigation filter alone; then aligned with the keyframes before it."},
    {"Real-time factor", "Simulated seconds per second of wall time: above 1 is faster than real time."},
}};

}  // namespace

std::string provenance_section(const Results& results) {
  std::string body = "<dl class=\"facts\">\n";
  body += row("mission", results.mission.name);
  body += row("seed", results.mission.seed);
  body += row("start (GPS time)", results.mission.start);
  if (std::isfinite(results.mission.nominal_duration_s)) {
    body += row("nominal duration", show_quantity(results.mission.nominal_duration_s, "s") +
                                        (std::isfinite(results.mission.time_limit_s)
                                             ? ", limit " + show_quantity(results.mission.time_limit_s, "s")
                                             : std::string()));
  }
  std::vector<std::string> runs;
  for (const Run& run : results.runs) {
    runs.push_back(run.fidelity + (run.is_pure() ? "" : " (GNSS " + run.gnss + ", IMU " + run.imu + ")"));
  }
  body += row("runs", listed(runs));
  body += row("Canyon version", results.version);
  body += row("commit of the source", results.commit);
  body += row("command line", results.command_line);
  body += row("ray tracer\xE2\x80\x99s instruction set", results.instruction_set);
  body += row("scene hash", results.scene_hash);
  body += row("results hash (SHA-256)", results.hash);
  body +=
      "</dl>\n<p>The same mission, seed and version give the same hash with any number of threads, and on another "
      "type of CPU as far as <code>docs/results.md</code> says. All numbers of this page "
      "are in, or follow from, <code>summary.json</code>, <code>epochs/</code> and <code>clouds/</code> beside it; the "
      "full configuration in "
      "<code>manifest.json</code>; "
      "<code>canyon report DIR</code> makes the page again. The full notation is in the source tree, "
      "<code>docs/notation.md</code>.</p>\n"
      "<h3 id=\"notation\">Words and notation</h3>\n<dl class=\"words\">\n";
  for (const auto& [word, meaning] : kWords)
    body += "<div><dt>" + std::string(word) + "</dt><dd>" + std::string(meaning) + "</dd></div>\n";
  return section("made", "How it was made", {}, body + "</dl>\n");
}

}  // namespace canyon::report
