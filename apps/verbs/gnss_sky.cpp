#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/answers/sky.h"
#include "canyon/apps/options/antenna_way.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/staged.h"
#include "canyon/core/process/parallel.h"
#include "canyon/gnss/antenna_height.h"

namespace canyon::apps {

namespace {

struct Options {
  GnssSetupOptions setup;
  std::string at, xy;
  double height_m = 1.5, duration_s = 0.0, step_s = 300.0;
};

/// The antenna in W: --at, or --xy above the ground of the scene.
Result<Eigen::Vector3d> antenna(const Options& options, const scene::Scene& scene, const std::optional<Geodetic>& at) {
  if (at) {
    const Eigen::Vector3d p_A_W = scene.frame().from_geodetic(*at);
    CANYON_TRY_STATUS(check_above_ground(scene, p_A_W, "--at"));
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

Status write_folder(const std::string& folder, const SkyAnswer& answer) {
  CANYON_TRY_STATUS(write_text_file(folder + "/satellites.csv", gnss::sky_satellites_csv(answer.epochs)));
  CANYON_TRY_STATUS(write_text_file(folder + "/dop.csv", gnss::sky_dop_csv(answer.epochs)));
  return write_text_file(folder + "/sky.svg", sky_svg(answer));
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
  OutputSet outputs(options.setup.force);
  CANYON_TRY(const StagedDirectory* const folder, outputs.directory(options.setup.out));
  auto epochs = gnss::follow_sky(*sensor, setup.config, setup.start, options.duration_s, options.step_s, p_A_W, scene);
  const LocalFrame& frame = setup.scene->frame();
  const Geodetic g = frame.to_geodetic(p_A_W);
  const Eigen::Matrix3d R_W_enu = frame.R_EW().transpose() * rotation_E_from_enu(g);
  const SkyAnswer answer{setup,
                         g,
                         options.duration_s,
                         options.step_s,
                         std::move(epochs),
                         gnss::ObstructionMask(p_A_W, R_W_enu.col(2), R_W_enu.col(1), scene)};
  print_warnings(sensor->warnings());
  if (folder != nullptr) CANYON_TRY_STATUS(write_folder(folder->staging_path(), answer));
  CANYON_TRY_STATUS(outputs.commit());
  if (options.setup.common.json) {
    std::printf("%s\n", json_text(sky_json(answer)).c_str());
    return 0;
  }
  print_sky(answer);
  if (folder != nullptr) std::printf("Files: %s/{sky.svg, satellites.csv, dop.csv}\n", folder->final_path().c_str());
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
