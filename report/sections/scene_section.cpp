#include <algorithm>
#include <cmath>
#include <optional>

#include "canyon/core/output/failure_words.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/maps/map_drawing.h"
#include "canyon/report/read/run_story.h"
#include "canyon/report/sections/run_paths.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

/// A waypoint's short sign: its name if that is short, else its number.
std::string sign_of(const Waypoint& w, std::size_t i) {
  return w.name.size() <= 3 ? w.name : std::to_string(i + 1);
}

std::string waypoint_markers(const Mission& mission, const MapWindow& window) {
  std::string html;
  for (std::size_t i = 0; i < mission.waypoints.size(); ++i) {
    const Waypoint& w = mission.waypoints[i];
    html += std::string("<span class=\"waypoint") + (w.mission ? " mission" : "") + "\" style=\"" +
            MapDrawing::place(window, w.p_W) + "\" title=\"" +
            escape_html((w.mission ? "mission waypoint " : "waypoint ") + w.name) + "\"><span>" +
            escape_html(sign_of(w, i)) + "</span></span>\n";
  }
  return html;
}

std::optional<Eigen::Vector2d> failure_place(const Run& run) {
  if (!run.failure || !std::isfinite(run.failure->x_m) || !std::isfinite(run.failure->y_m)) return std::nullopt;
  return Eigen::Vector2d(run.failure->x_m, run.failure->y_m);
}

bool label_on_the_left(const Eigen::Vector2d& p_W, const MapWindow& window) {
  return p_W.x() - window.min_W.x() > 0.51 * window.size_m().x();
}

/// A cross, and its words at `label_W`, beside or beneath it.
std::string failure_marker(const Run& run, std::size_t run_number, const MapWindow& window,
                           const Eigen::Vector2d& label_W) {
  const auto p_W = failure_place(run);
  if (!p_W) return {};
  const std::string words = run.fidelity + ": " + outcome_label(run.failure->kind) +
                            (std::isfinite(run.failure->t_s) ? " at " + show_quantity(run.failure->t_s, "s") : "");
  const std::string classes = " " + run_class(run_number) + (run.is_pure() ? "" : " mixed");
  return "<span class=\"failure" + classes + "\" style=\"" + MapDrawing::place(window, *p_W) +
         "\"><svg viewBox=\"0 0 16 16\" aria-hidden=\"true\"><path class=\"halo\" d=\"M3 3L13 13M13 3L3 13\"/><path "
         "d=\"M3 "
         "3L13 13M13 3L3 13\"/></svg></span>\n<span class=\"failure-label" +
         classes + (label_on_the_left(*p_W, window) ? " left" : "") + "\" style=\"" +
         MapDrawing::place(window, label_W) + "\">" + escape_html(words) + "</span>\n";
}

/// All failures. Labels of one side that would touch are moved down, the northernmost first.
std::string failure_markers(const Results& results, const MapWindow& window) {
  constexpr double kLine = 0.03;  // height of a label as a share of the plan's, on a phone too
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < results.runs.size(); ++i)
    if (failure_place(results.runs[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return failure_place(results.runs[a])->y() > failure_place(results.runs[b])->y();
  });
  std::string html;
  double lowest_m[2] = {1e9, 1e9};  // of the labels on each side so far
  for (const std::size_t i : order) {
    Eigen::Vector2d label_W = *failure_place(results.runs[i]);
    double& lowest = lowest_m[label_on_the_left(label_W, window) ? 1 : 0];
    label_W.y() = std::min(label_W.y(), lowest - kLine * window.size_m().y());
    lowest = label_W.y();
    html += failure_marker(results.runs[i], i, window, label_W);
  }
  return html;
}

std::string overview(const Results& results, const MapDrawing& map) {
  const MapWindow window{results.drawing.min_W, results.drawing.max_W};
  std::string ribbons, estimates, tracks, missing;
  std::string html = waypoint_markers(results.mission, window);
  const double tolerance_m = 1e-4 * window.size_m().maxCoeff();
  // Ribbons lie in one another, each narrower than the one before, so that the runs show where they drove the same way;
  // of the estimates the first run's is uppermost.
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const Run& run = results.runs[i];
    ribbons += draw_ribbon(map, run, i, nullptr, tolerance_m, std::max(2.0, 11 - 2.8 * static_cast<double>(i)));
    estimates.insert(0, draw_estimate(map, run, i, nullptr, tolerance_m));
    tracks.insert(0, draw_track(map, run, i));
    if (!run.nav)
      missing += note("The path of run " + run.fidelity + " is missing: the results hold no epochs/" + run.fidelity +
                      "_nav.csv.");
  }
  html += failure_markers(results, window);
  const std::string svg =
      ribbons + "<path class=\"route\" d=\"" + map.path(results.mission.route_W) + "\"/>\n" + estimates + tracks;
  std::string description = show_count(static_cast<double>(results.drawing.buildings.size())) +
                            " buildings, the planned route through " +
                            count_of(static_cast<double>(results.mission.waypoints.size()), "waypoint", "waypoints") +
                            ", and of each run the true and the estimated path.";
  for (const Run& run : results.runs) {
    if (run.failure) description += " Run " + run.fidelity + " " + outcome_words(run.failure->kind) + ".";
  }
  return map.window(window, "scene", "overview", "The scene from above", description, svg, html) + missing;
}

std::string overview_legend(const Results& results, const MapDrawing& map) {
  std::string out = "<div class=\"map-legend\">\n<p class=\"legend\">";
  for (std::size_t i = 0; i < results.runs.size(); ++i) out += run_tag(results.runs, i) + " ";
  out +=
      "</p>\n<p class=\"legend\"><span class=\"key\"><svg class=\"sample\" viewBox=\"0 0 34 12\" "
      "aria-hidden=\"true\"><path class=\"ribbon r0 keep\" "
      "d=\"M1 6H33\"/></svg>true path</span><span class=\"key\"><svg class=\"sample\" viewBox=\"0 0 34 12\" "
      "aria-hidden=\"true\"><path "
      "class=\"line estimate r0 keep\" d=\"M1 6H33\"/></svg>estimated path</span><span class=\"key\"><svg "
      "class=\"sample\" viewBox=\"0 0 34 12\" "
      "aria-hidden=\"true\"><path class=\"route\" d=\"M1 6H33\"/></svg>planned route</span>"
      "<span class=\"key\"><span class=\"waypoint inline\"><span>2</span></span>waypoint</span><span "
      "class=\"key\"><span "
      "class=\"waypoint mission inline\"><span>7</span></span>mission waypoint</span>"
      "<span class=\"key\"><svg class=\"chip\" viewBox=\"0 0 12 12\" aria-hidden=\"true\"><path class=\"interest\" "
      "d=\"M1 1H11V11H1Z\"/></svg>building "
      "of interest</span></p>\n";
  return out + map.height_legend() + "</div>\n";
}

/// The neighbourhood of where a run failed, else of where its horizontal error was largest.
std::string close_up(const Results& results, const MapDrawing& map, std::size_t i) {
  const Run& run = results.runs[i];
  if (!run.nav || run.nav->rows == 0) return {};
  const EpochTable& nav = *run.nav;
  const bool failed = run.failure && std::isfinite(run.failure->x_m) && std::isfinite(run.failure->y_m);
  const auto worst = worst_horizontal_row(nav);
  std::optional<std::size_t> row = worst;
  if (failed && std::isfinite(run.failure->t_s)) row = row_at(nav, run.failure->t_s);
  if (!row) return {};
  const Eigen::Vector2d truth(nav["true_x_m"][*row], nav["true_y_m"][*row]);
  const Eigen::Vector2d centre = failed ? Eigen::Vector2d(run.failure->x_m, run.failure->y_m) : truth;
  if (!centre.allFinite()) return {};
  const double horizontal_m = std::hypot(nav["error_e_m"][*row], nav["error_n_m"][*row]);
  const double total_m = error_norm_m(nav, *row);
  // Wide enough for the error and some street around it, also when the estimate has gone far.
  const double half_m =
      std::clamp(2.5 * (std::isfinite(horizontal_m) ? horizontal_m : 0.0), failed ? 20.0 : 6.0, 400.0);
  const MapWindow window{centre.array() - half_m, centre.array() + half_m};

  const std::string what = failed ? outcome_label(run.failure->kind) : "largest horizontal error";
  const double t_s = nav["t_s"][*row];
  std::string svg = "<path class=\"route\" d=\"" + map.path(results.mission.route_W) + "\"/>\n";
  svg += draw_ribbon(map, run, i, &window, 1e-3 * half_m, 7) + draw_estimate(map, run, i, &window, 1e-3 * half_m) +
         draw_error_ties(map, run, i, window, 1.0);
  std::string html = failure_marker(run, i, window, centre);
  if (!failed)
    html += "<span class=\"spot " + run_class(i) + "\" style=\"" + MapDrawing::place(window, truth) + "\"></span>\n";
  const std::string words =
      what + " at " + show_quantity(t_s, "s") +
      (std::isfinite(horizontal_m) ? ", estimate " + show_quantity(horizontal_m, "m") + " from truth horizontally" +
                                         (std::isfinite(total_m) ? " (" + show_quantity(total_m, "m") + " in 3-D)" : "")
                                   : "");
  return "<figure class=\"solid " + run_class(i) + "\">\n" +
         map.window(window, "scene", "close-up-" + std::to_string(i), "Close-up of run " + run.fidelity, words + ".",
                    svg, html) +
         "<figcaption>" + run_tag(results.runs, i) + " " + escape_html(words) + "</figcaption>\n</figure>\n";
}

std::string facts(const Results& results) {
  std::vector<std::string> parts;
  const SceneFacts& s = results.scene;
  if (std::isfinite(s.buildings)) parts.push_back(count_of(s.buildings, "building", "buildings"));
  if (std::isfinite(s.triangles)) parts.push_back(count_of(s.triangles, "triangle", "triangles"));
  if (s.extent_m.size() == 3) {
    parts.push_back(show_number(s.extent_m[0], 4) + " \xC3\x97 " + show_number(s.extent_m[1], 4) + " \xC3\x97 " +
                    show_quantity(s.extent_m[2], "m"));
  }
  std::string text = "Scene" + (s.name.empty() ? std::string() : " \xE2\x80\x9C" + s.name + "\xE2\x80\x9D") + ": " +
                     listed(parts) + ".";
  if (std::isfinite(s.lat_deg) && std::isfinite(s.lon_deg)) {
    text += " Its origin is at " + show_number(std::abs(s.lat_deg), 7) + "\xC2\xB0" + (s.lat_deg < 0 ? "S " : "N ") +
            show_number(std::abs(s.lon_deg), 7) + "\xC2\xB0" + (s.lon_deg < 0 ? "W" : "E") +
            (std::isfinite(s.h_m) ? ", " + show_quantity(s.h_m, "m") + " above the ellipsoid." : ".");
  }
  return text;
}

}  // namespace

std::string scene_section(const Results& results) {
  const MapDrawing map(results.drawing);
  std::vector<std::string> of_interest;
  for (const Waypoint& w : results.mission.waypoints) {
    if (w.mission && !w.building.empty()) of_interest.push_back(w.building);
  }
  std::string body = map.definitions(of_interest);
  body += "<figure class=\"overview\">\n" + overview(results, map) + overview_legend(results, map) + "</figure>\n";
  std::string close_ups;
  for (const std::size_t i : pure_runs(results)) close_ups += close_up(results, map, i);
  if (!close_ups.empty()) {
    body +=
        "<h3>Where it went wrong</h3>\n<p class=\"intro\">While the vehicle moves, a tie joins its true and its "
        "estimated position every second.</p>\n<div class=\"columns\">\n" +
        close_ups + "</div>\n";
  }
  return section("scene-section", "From above",
                 escape_html(facts(results)) +
                     " The broad, pale ribbon is where a run really drove, the fine line where it believed to be: "
                     "while the estimate is good, "
                     "the line stays inside the ribbon.",
                 body);
}

}  // namespace canyon::report
