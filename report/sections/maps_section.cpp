#include <algorithm>
#include <cmath>
#include <utility>

#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/maps/map_raster.h"
#include "canyon/report/sections/run_paths.h"
#include "canyon/report/sections/sections.h"

namespace canyon::report {
namespace {

/// All pictures of the page together stay below this, so that the page stays below 5 MB whatever the clouds hold.
constexpr std::size_t kPicturesBudget_bytes = 2'800'000;

/// More points than this with one and the same greatest error are no chance: the scorer counts anything farther as that
/// much.
constexpr double kCapped = 0.001;

struct NamedCloud {
  std::size_t run = 0;
  bool registered = false;
  const CloudSummary* cloud = nullptr;
};

const char* placing(const NamedCloud& c) {
  return c.registered ? "registered" : "prior";
}

std::vector<NamedCloud> clouds_of(const Results& results) {
  std::vector<NamedCloud> out;
  for (const std::size_t i : pure_runs(results)) {
    const Run& run = results.runs[i];
    for (const bool registered : {false, true}) {
      const auto& cloud = registered ? run.registered_cloud : run.prior_cloud;
      if (cloud && cloud->points > 0) out.push_back({i, registered, &*cloud});
    }
  }
  return out;
}

/// The pictures, shrunk until they fit the budget.
std::vector<std::string> pictures(const Results& results, const MapDrawing& map, const CellBox& box,
                                  const std::vector<NamedCloud>& clouds) {
  for (std::size_t shrink = 1;; ++shrink) {
    std::vector<std::string> out;
    std::size_t bytes = 0;
    for (const NamedCloud& c : clouds) {
      out.push_back(draw_cloud(map, results.grid, box, *c.cloud, shrink));
      bytes += out.back().size();
    }
    if (bytes <= kPicturesBudget_bytes || shrink == 16) return out;
  }
}

/// A figure of summary.json, which is exact; what the histogram says where that is undefined.
double figure_or(const Results& results, const NamedCloud& c, const char* prior_key, const char* registered_key,
                 double otherwise) {
  const double value = results.runs[c.run].figure(c.registered ? registered_key : prior_key);
  return std::isfinite(value) ? value : otherwise;
}

std::string caption(const Results& results, const NamedCloud& c) {
  const double rms_m = figure_or(results, c, "map_error_prior_rms_m", "map_error_rms_m", c.cloud->rms_m());
  const double p95_m = figure_or(results, c, "map_error_p95_prior_m", "map_error_p95_m", c.cloud->quantile_m(0.95));
  std::string text =
      run_tag(results.runs, c.run) + " " + placing(c) + ": RMS " + show_quantity(rms_m, "m") +
      (c.cloud->at_max > 1 && p95_m >= c.cloud->max_m ? ", 95 % at " + show_quantity(p95_m, "m") + " or more, "
                                                      : ", 95 % below " + show_quantity(p95_m, "m") + ", ") +
      count_of(static_cast<double>(c.cloud->points), "point", "points");
  const double capped = static_cast<double>(c.cloud->at_max) / static_cast<double>(c.cloud->points);
  if (capped > kCapped) text += ", " + show_share(capped) + " of them at " + show_quantity(c.cloud->max_m, "m");
  if (c.cloud->undefined > 0) {
    text += ", " + show_count(static_cast<double>(c.cloud->undefined)) + " more without a defined error";
  }
  return text + ".";
}

/// Share of points with an error below x: the distribution function.
std::string distribution(const Results& results, const std::vector<NamedCloud>& clouds) {
  Chart chart;
  chart.id = "map-error-chart";
  chart.title = "Distribution of map error";
  chart.x_label = "point error, m (logarithmic)";
  Panel panel{.title = "Share of map points with a smaller error", .unit = "%"};
  panel.height_px = 260;
  panel.y = Axis::linear(0, 100, 5);
  double low_m = ErrorBins::kMax_m, high_m = ErrorBins::kMin_m;
  for (const NamedCloud& c : clouds) {
    Line line{.run = c.run, .name = results.runs[c.run].fidelity + ", " + placing(c)};
    line.style = c.registered ? Line::Style::kNormal : Line::Style::kThin;
    for (std::size_t i = 0; i <= ErrorBins::kCount; ++i) {
      line.x.push_back(ErrorBins::edge_m(i));
      line.y.push_back(100 * c.cloud->share_below_edge(i));
    }
    low_m = std::min(low_m, c.cloud->quantile_m(0.02));
    high_m = std::max(high_m, c.cloud->quantile_m(0.999));
    chart.description += line.name + ": half below " + show_quantity(c.cloud->quantile_m(0.5), "m") + ", 95 % below " +
                         show_quantity(c.cloud->quantile_m(0.95), "m") + ". ";
    panel.lines.push_back(std::move(line));
  }
  chart.x = Axis::logarithmic(std::min(low_m, 0.5 * high_m), high_m);
  chart.panels.push_back(std::move(panel));
  std::vector<std::size_t> runs;
  for (const NamedCloud& c : clouds) {
    if (runs.empty() || runs.back() != c.run) runs.push_back(c.run);
  }
  return "<h3>Distribution of the point errors</h3>\n" + run_legend(results.runs, runs) +
         "<p class=\"legend\"><span class=\"key\"><svg class=\"sample\" viewBox=\"0 0 34 12\" "
         "aria-hidden=\"true\"><path class=\"line r0 keep thin\" d=\"M1 "
         "6H33\"/></svg>thin: prior alone</span><span class=\"key\"><svg class=\"sample\" viewBox=\"0 0 34 12\" "
         "aria-hidden=\"true\"><path class=\"line r0 "
         "keep\" d=\"M1 6H33\"/></svg>bold: registered</span></p>\n" +
         figure(draw(chart), {});
}

}  // namespace

std::string maps_section(const Results& results) {
  const std::vector<NamedCloud> clouds = clouds_of(results);
  std::vector<const CloudSummary*> all;
  for (const NamedCloud& c : clouds) all.push_back(c.cloud);
  const CellBox box = occupied_box(results.grid, all);
  const std::string title = "The maps\xE2\x80\x99 error";
  std::string missing;
  for (const std::size_t i : pure_runs(results)) {
    const Run& run = results.runs[i];
    std::vector<std::string> absent;
    if (!run.prior_cloud || run.prior_cloud->points == 0) absent.push_back("prior");
    if (run.registers() && (!run.registered_cloud || run.registered_cloud->points == 0)) absent.push_back("registered");
    if (!absent.empty())
      missing += note("Run " + run.fidelity + ": the results hold no " + listed(absent) + " map cloud with points.");
  }
  if (clouds.empty()) return section("maps", title, {}, missing);

  std::string body;
  const MapDrawing map(results.drawing);
  if (box.empty()) {
    body += note("All map points lie outside the scene, so there is no picture.");
  } else {
    const MapWindow window = window_of(results.grid, box);
    const bool tall = window.size_m().y() > 1.25 * window.size_m().x();
    const std::vector<std::string> images = pictures(results, map, box, clouds);
    body += map_error_legend() + (tall ? "<div class=\"columns maps tall\">\n" : "<div class=\"columns maps\">\n");
    for (std::size_t k = 0; k < clouds.size(); ++k) {
      const NamedCloud& c = clouds[k];
      const std::string name = results.runs[c.run].fidelity + ", " + placing(c);
      body += "<figure class=\"" + run_class(c.run) + "\">\n" +
              map.window(window, "outlines", "map-" + std::to_string(k), "Map of run " + name + ", coloured by error",
                         "RMS " + show_quantity(c.cloud->rms_m(), "m") + ".", images[k], {}) +
              "<figcaption>" + caption(results, c) + "</figcaption>\n</figure>\n";
    }
    body += "</div>\n";
  }
  body += distribution(results, clouds);
  const std::string intro = "Distance of each map point to the nearest true surface, seen from above (squares of " +
                            show_quantity(results.grid.cell_m, "m", 2) +
                            "). \xE2\x80\x9CPrior\xE2\x80\x9D: scans placed by the filter alone; "
                            "\xE2\x80\x9Cregistered\xE2\x80\x9D: then aligned with the map "
                            "so far. A point beyond the scorer\xE2\x80\x99s reach counts with that reach.";
  return section("maps", title, intro, body + missing);
}

}  // namespace canyon::report
