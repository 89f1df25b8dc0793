#include "canyon/apps/options/imu_simulation.h"

#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/config/text.h"
#include "canyon/core/units.h"

namespace canyon::apps {

void visit(FieldVisitor& f, LogConfig& c) {
  inertial::visit(f, c.motion);
  f.group("imu", c.imu, "the sensor, as in a mission");
}

namespace {

std::string paths_help() {
  std::string out = "a motion in closed form, or a TOML file of one:";
  for (const auto& row : inertial::motion_models()) out += std::string("\n") + row.name + ": " + row.doc;
  return out;
}

}  // namespace

Result<LogConfig> log_config(const ImuSimulationOptions& options) {
  ConfigNode node;
  node.value_ = ConfigNode::Table{};
  if (options.path.ends_with(".toml")) {
    CANYON_TRY(node, ConfigNode::load(options.path));
  } else if (!options.path.empty()) {
    node.set("path", ConfigNode::of(options.path), "--path");
  }
  if (!options.points.empty()) {
    node.set("path", ConfigNode::of(std::string("spline")), "--points");
    node.set("file", ConfigNode::of(options.points), "--points");
  }
  if (!options.trajectory.empty()) {
    node.set("path", ConfigNode::of(std::string("recorded")), "--trajectory");
    node.set("file", ConfigNode::of(options.trajectory), "--trajectory");
  }
  if (!options.sensor.empty()) node.set("imu.sensor", ConfigNode::of(options.sensor), "--sensor");
  if (!options.errors.empty()) node.set("imu.errors", ConfigNode::of(options.errors), "--errors");
  if (options.rate_hz > 0.0) node.set("imu.rate_hz", ConfigNode::of(options.rate_hz), "--rate");
  for (const std::string& setting : options.settings) {
    CANYON_TRY(const ConfigNode one, ConfigNode::parse(setting, "--set"));
    node.overlay(one);
  }
  LogConfig config;
  CANYON_TRY_STATUS(read_config(&node, "", config));
  if (!options.at.empty()) {
    CANYON_TRY(const Geodetic at, parse_place(options.at, "--at"));
    config.motion.lat_deg = at.lat_rad / kDegree;
    config.motion.lon_deg = at.lon_rad / kDegree;
    config.motion.height_m = at.h_m;
  }
  return config;
}

Status check_motion_given(const ImuSimulationOptions& o) {
  if (!o.at.empty() || !o.path.empty() || !o.points.empty() || !o.trajectory.empty()) return Ok{};
  return Error{"", 0, "command line", "no motion given", "--at LAT,LON,H, --path NAME, --points or --trajectory FILE"};
}

void declare_imu_simulation(Arguments& arguments, ImuSimulationOptions& o) {
  const LogConfig usual;
  arguments.option("--sensor", o.sensor,
                   "entry of the catalogue, or a TOML file of your own sensor; default " + usual.imu.sensor);
  arguments.option("--errors", o.errors, "error chain, default " + usual.imu.errors + "; none: an ideal sensor");
  const auto path = arguments.option("--path", o.path, paths_help());
  const auto points =
      arguments.option("--points", o.points,
                       "smooth through points: CSV of t_s,x_m,y_m,z_m and yaw_deg,pitch_deg,roll_deg or nose "
                       "ahead, in W");
  const auto trajectory =
      arguments.option("--trajectory", o.trajectory,
                       "a recorded trajectory: .tum, .kitti or CSV of poses in W; KF-GINS truth text, or CSV with "
                       "sow,lat_deg,lon_deg,h_m,roll_deg,pitch_deg,heading_deg");
  path.excludes(points).excludes(trajectory);
  points.excludes(trajectory);
  arguments.option("--set", o.settings,
                   "KEY=VALUE of the motion, as radius_m=50 or smoothing_s=0.5, or of the sensor, as "
                   "imu.lever_arm_m=[0.3,0,0.5] or 'imu.leave_out=[\"white_noise\"]'; may be repeated");
  arguments.option("--at", o.at, "LAT,LON,H: where it stands, or W's origin; degrees, ellipsoidal metres");
  arguments.option("--start", o.start, "first instant: ISO date or WEEK:SOW; default: the trajectory's, else 0:0");
  arguments.option("--rate", o.rate_hz, "samples per second; default " + number_text(usual.imu.rate_hz))
      .within(10.0, 5000.0);
}

}  // namespace canyon::apps
