#include "canyon/apps/options/antenna_way.h"

#include <algorithm>

#include "canyon/core/output/printed.h"
#include "canyon/gnss/antenna_height.h"

namespace canyon::apps {

namespace {

/// Where the antenna goes: --at, or --trajectory.
Result<PlacePath> antenna_path(const std::string& trajectory, const GnssSetup& setup,
                               const std::optional<Geodetic>& at) {
  if (at) return PlacePath({{setup.start, ecef_from_geodetic(*at)}});
  if (trajectory.ends_with(".tum")) {
    CANYON_TRY(const Trajectory poses, read_tum(trajectory));
    return PlacePath(poses, setup.scene->frame(), setup.config.lever_arm_m);
  }
  CANYON_TRY(auto places, read_places(trajectory));
  for (const StampedPlace& place : places)
    CANYON_TRY_STATUS(gnss::check_antenna_height(place.p_E, {.file = trajectory, .line = place.line}));
  return PlacePath(std::move(places));
}

}  // namespace

void declare_antenna_way(Arguments& arguments, AntennaWayOptions& o) {
  const auto at = arguments.option("--at", o.at, "LAT,LON,H of the antenna: degrees, degrees, ellipsoidal metres");
  const auto trajectory = arguments.option(
      "--trajectory", o.trajectory,
      "way of the antenna: CSV of gps_week,sow and lat_deg,lon_deg,h_m or x_m,y_m,z_m; or .tum, poses of "
      "the vehicle in the scene's frame W");
  at.excludes(trajectory);
  arguments.option("--duration", o.duration_s, "seconds; default: one epoch with --at, all of --trajectory")
      .within(0.0, 30.0 * 86400.0);
  arguments.option("--rate", o.rate_hz, "epochs per second").default_shown().within(1e-3, 100.0);
}

Status check_above_ground(const scene::Scene& scene, const Eigen::Vector3d& p_A_W, const std::string& option) {
  const double depth_m = gnss::depth_below_ground_m(scene, p_A_W);
  if (depth_m == 0.0) return Ok{};
  return Error{option, 0, "", printed("the antenna would be %.2f m below the ground of the scene", depth_m),
               "an ellipsoidal height above it"};
}

Result<PlacedReceiver> place_receiver(const AntennaWayOptions& options, const GnssSetupOptions& setup_options) {
  std::optional<Geodetic> at;
  if (!options.at.empty()) {
    CANYON_TRY(at, parse_place(options.at, "--at"));
  }
  CANYON_TRY(GnssSetup setup, gnss_setup(setup_options, at));
  CANYON_TRY(PlacePath path, antenna_path(options.trajectory, setup, at));
  if (!at && setup_options.start.empty()) setup.start = path.first();
  double duration_s = options.duration_s;
  if (!at && duration_s == 0.0) duration_s = std::max(0.0, path.last() - setup.start);
  if (!at && (setup.start < path.first() || path.last() < setup.start + duration_s))
    return Error{options.trajectory, 0, "", "covers " + path.first().iso() + " to " + path.last().iso(),
                 "all of " + setup.start.iso() + " and the " + printed("%g s", duration_s) + " that follow"};
  // Open sky stands where the way begins.
  if (!at && setup_options.scene == "none") {
    CANYON_TRY(const GnssSetup there, gnss_setup(setup_options, geodetic_from_ecef(path.at(setup.start)->p_E)));
    setup.scene = there.scene;
  }
  if (at) CANYON_TRY_STATUS(check_above_ground(*setup.scene, setup.scene->frame().from_geodetic(*at), "--at"));
  const GpsTime start = setup.start;
  return PlacedReceiver{std::move(setup), {std::move(path), options.trajectory, start, duration_s, options.rate_hz}};
}

}  // namespace canyon::apps
