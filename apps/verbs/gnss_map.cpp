#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/report/maps/raster_map.h"
#include "canyon/study/gnss_map.h"

namespace canyon::apps {

namespace {

struct Options {
  GnssSetupOptions setup;
  double cell_m = 2.0, height_m = 1.5, duration_s = 0.0, step_s = 3600.0;
};

struct Layer {
  const char* file;
  const char* title;
  const char* unit;
  Grid study::GnssMap::*grid;
  std::vector<double> edges;
  bool bad_is_low;
  int decimals;
};

const std::vector<Layer>& layers() {
  using Map = study::GnssMap;
  static const std::vector<Layer> all = {
      {"visible", "Satellites in direct sight, mean", "", &Map::visible, {1, 2, 3, 4, 5, 6, 8, 12}, true, 3},
      {"gdop", "GDOP, median", "", &Map::gdop, {2, 3, 4, 6, 10, 20, 50}, false, 3},
      {"error_horizontal",
       "Horizontal position error, RMS",
       "m",
       &Map::error_horizontal_m,
       {0.5, 1, 2, 5, 10, 20, 50},
       false,
       3},
      {"error_up", "Vertical position error, RMS", "m", &Map::error_up_m, {0.5, 1, 2, 5, 10, 20, 50}, false, 3},
      {"fix_share", "Share of epochs with a fix", "", &Map::fix_share, {0.01, 0.25, 0.5, 0.75, 0.9, 0.99}, true, 4},
  };
  return all;
}

/// Of the cells that have a value; NaN without any.
double quantile(const Grid& grid, double q) {
  std::vector<double> x;
  for (const double v : grid.values)
    if (std::isfinite(v)) x.push_back(v);
  if (x.empty()) return std::nan("");
  const auto k = std::min(x.size() - 1, static_cast<std::size_t>(q * static_cast<double>(x.size())));
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(k), x.end());
  return x[k];
}

Result<int> run(const Options& options) {
  set_threads(options.setup.common.threads);
  CANYON_TRY(const GnssSetup setup, gnss_setup(options.setup, std::nullopt));
  study::GnssMapConfig config{.gnss = setup.config, .seed = setup.seed, .start = setup.start};
  config.epochs = static_cast<int>(std::floor(options.duration_s / options.step_s + 1e-9)) + 1;
  config.step_s = options.step_s;
  config.cell_m = options.cell_m;
  config.height_m = options.height_m;
  const double origin_m = setup.scene->frame().origin().h_m;
  CANYON_TRY_STATUS(gnss::check_antenna_height(origin_m + options.height_m, {.file = "--scene, --height"}));
  const std::string out = options.setup.out.empty() ? "gnss-map" : options.setup.out;
  CANYON_TRY(auto staged, StagedDirectory::create(out, options.setup.force));

  const auto extent = setup.scene->extent();
  const double cells =
      (extent.max.x() - extent.min.x()) * (extent.max.y() - extent.min.y()) / std::pow(options.cell_m, 2);
  Progress progress("mapping", cells, !options.setup.common.json);
  CANYON_TRY(const study::GnssMap map, study::map_gnss(config, *setup.scene, &progress));

  const std::string subtitle = setup.start.iso(0) + " GPS time, " + std::to_string(config.epochs) +
                               (config.epochs == 1 ? " epoch" : " epochs") + "; scene " + setup.scene_name +
                               ", receiver " + options.setup.fidelity;
  for (const Layer& layer : layers()) {
    throw_if_cancelled();
    const Grid& grid = map.*layer.grid;
    const report::RasterMap picture{layer.title, subtitle, layer.unit, &grid, layer.edges, layer.bad_is_low};
    const std::string stem = staged.staging_path() + "/" + layer.file;
    CANYON_TRY_STATUS(write_text_file(stem + ".png", report::raster_png(picture)));
    CANYON_TRY_STATUS(write_text_file(stem + ".svg", report::raster_svg(picture)));
    CANYON_TRY_STATUS(write_text_file(stem + ".asc", ascii_grid_text(grid, layer.decimals)));
    CANYON_TRY_STATUS(write_text_file(stem + ".prj", projection_text(setup.scene->frame())));
  }
  CANYON_TRY_STATUS(staged.commit());

  if (options.setup.common.json) {
    Json json{{"columns", map.visible.columns},
              {"rows", map.visible.rows},
              {"cell_m", map.visible.cell_m},
              {"epochs", config.epochs},
              {"directory", staged.final_path()}};
    for (const Layer& layer : layers())
      json[layer.file] = {{"median", or_null(quantile(map.*layer.grid, 0.5))},
                          {"p95", or_null(quantile(map.*layer.grid, 0.95))}};
    std::printf("%s\n", json_text(json).c_str());
    return 0;
  }
  std::printf("%d x %d cells of %g m, %s\n\n", map.visible.columns, map.visible.rows, map.visible.cell_m,
              subtitle.c_str());
  std::printf("  %-34s %9s %9s %9s\n", "over the cells", "5 %", "median", "95 %");
  for (const Layer& layer : layers()) {
    const std::string title = std::string(layer.title) + (*layer.unit ? std::string(", ") + layer.unit : "");
    std::printf("  %-34s %9.2f %9.2f %9.2f\n", title.c_str(), quantile(map.*layer.grid, 0.05),
                quantile(map.*layer.grid, 0.5), quantile(map.*layer.grid, 0.95));
  }
  std::printf("\nFiles: %s/, each as .svg (to look at), .png, .asc and .prj (for a GIS)\n",
              staged.final_path().c_str());
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_gnss_setup(arguments, options->setup, "vicksburg");
  arguments.option("--cell", options->cell_m, "edge of a cell, m").default_shown().within(0.1, 1000.0);
  arguments.option("--height", options->height_m, "of the antenna above ground, m").default_shown().within(0.1, 1000.0);
  arguments.option("--duration", options->duration_s, "seconds to cover, 86400 for a day; 0 = the start alone")
      .within(0.0, 7.0 * 86400.0);
  arguments.option("--step", options->step_s, "seconds between epochs").default_shown().within(1.0, 86400.0);
  return [options]() -> Result<int> {
    if (options->setup.scene == "none") return Error{"--scene", 0, "", "\"none\" has no ground to map", "a scene"};
    return run(*options);
  };
}

}  // namespace

Verb gnss_map_verb() {
  return {"gnss map", "satellites in sight, DOP and position error over the scene",
          "canyon gnss map --scene vicksburg --cell 5 --duration 86400 --out day", declare};
}

}  // namespace canyon::apps
