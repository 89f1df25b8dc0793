#include "canyon/tests/study/causes/planted_failures.h"

namespace canyon::study::testing {
namespace {

// Whoever drives follows the middle of the street by its estimate alone, so that a drive costs hardly any time.
constexpr const char* kDrive = R"(
base = "vicksburg"
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[registration]
method = "none"
[autonomy]
model = "route_follower"
[[autonomy.waypoint]]
name = "half way"
p_m = [213.9, 80.0]
[[autonomy.waypoint]]
name = "goal"
p_m = [213.9, 140.0]
[success]
waypoint_radius_m = 2.0
)";

constexpr const char* kPerfectFixes = R"(
gnss.model = "truth_plus_white"
gnss.white_sigma_m = 0.05
gnss.white_sigma_up_m = 0.05
)";
constexpr const char* kPerfectUnit = R"(
imu.errors = "none"
)";
constexpr const char* kAligned = R"(
run.initial_attitude_error_deg = [0.0, 0.0, 0.0]
)";
// A differential receiver in a street, its ranges perfect but for what the street does.
constexpr const char* kReceiver = R"(
gnss.model = "pseudorange"
gnss.mode = "dgps"
gnss.paths = "specular2"
gnss.diffraction = "double_knife_edge"
gnss.multipath_rule = "correlator"
gnss.raim = "none"
)";
// The same with a thin ionosphere that nobody corrects: in all directions of a clear sky it goes into height and clock,
// in a slit of sky to the side. Noise would not do: what fixes of few satellites suffer of it, the vehicle survives or
// not with all of them, too.
constexpr const char* kThinIonosphere = R"(
gnss.mode = "single_uncorrected"
gnss.vtec_tecu = 20.0
gnss.ephemeris_error = "none"
gnss.thermal_noise_scale = 0.1
gnss.max_gdop = 1000.0
)";
// The same under a sky that nothing is built into.
constexpr const char* kOpenSky = R"(
gnss.model = "pseudorange"
gnss.mode = "dgps"
gnss.paths = "none"
gnss.multipath_rule = "none"
)";
// Things that stand in the lane, all across the street.
constexpr const char* kBarrier = R"(
scene.moving = [
  {name = "barrier 1", path_m = [210.4, 100.0, 210.4, 101.0], start_s = 1e5},
  {name = "barrier 2", path_m = [213.9, 100.0, 213.9, 101.0], start_s = 1e5},
  {name = "barrier 3", path_m = [217.4, 100.0, 217.4, 101.0], start_s = 1e5},
]
)";
// An autonomy that looks, with a LIDAR that is cheap to simulate.
constexpr const char* kLooks = R"(
autonomy.model = "reference"
lidar.azimuth_steps = 600
lidar.rate_hz = 5.0
)";
// Somebody who stands 0.75 m to the right of the lane's middle: body and person together are 1.0 m wide to either side,
// so that the vehicle hits from 0.25 m left of the middle to 1.75 m right of it. Whoever knows where it is hits;
// whoever errs may pass, by the sign of its error: of draws 0.34 to 0.47 for fixes that err across the street by 1 to 2
// m, for some two seconds alike (a filter of position, velocity, heading, tilt and bias, as sure at the start as this
// one). So nothing that is taken away helps, and each is at work: six or seven of eight satellites are in sight here,
// one of them beside its reflection; the unit errs by its datasheet, the start is askew by less than the filter allows
// for. Who drives takes for a wall what is 1.8 m high within a cell. A person of 1.75 m it sees only where its height
// has moved by the rest within its memory: on its true height it would hit that one too.
constexpr const char* kBesideTheMiddle = R"(
vehicle.start_m = [112.9, -146.0]
autonomy.waypoint = [{name = "goal", p_m = [112.9, -78.0]}]
scene.moving = [{name = "somebody", shape = "person", path_m = [113.65, -91.0, 113.65, -90.0], start_s = 1e5}]
gnss.paths = "specular1"
gnss.thermal_noise_scale = 2.0
gnss.solver_sigma_m = 2.0
imu.errors = "datasheet"
run.initial_attitude_error_deg = [0.02, 0.02, 0.3]
autonomy.model = "reference_2012"
autonomy.max_offset_m = 1.5
autonomy.choice.horizon_m = 12.0
autonomy.grid.half_size_m = 15.0
autonomy.grid.obstacle_step_m = 1.8
lidar.azimuth_steps = 360
lidar.rate_hz = 5.0
success.waypoint_radius_m = 6.0
success.limit_factor = 3.0
success.stuck_after_s = 10.0
)";

}  // namespace

const std::vector<Plant>& plants() {
  using Kind = Plant::Kind;
  static const std::vector<Plant> all{
      // One source, with a switch of its own.
      {"a cheap inertial unit, no fixes",
       {"imu"},
       Kind::kOwnSwitch,
       {kPerfectFixes, kAligned,
        "imu.errors = \"datasheet\"\nimu.sensor = \"mpu6050\"\nrun.withhold_fixes_after_s = 0.0\n"}},
      {"another, no fixes",
       {"imu"},
       Kind::kOwnSwitch,
       {kPerfectFixes, kAligned,
        "imu.errors = \"datasheet\"\nimu.sensor = \"phidget_3_3_3\"\nrun.withhold_fixes_after_s = 0.0\n"}},
      {"a crooked start, no fixes",
       {"alignment"},
       Kind::kOwnSwitch,
       {kPerfectFixes, kPerfectUnit,
        "run.initial_attitude_error_deg = [0.0, 0.0, 12.0]\nrun.withhold_fixes_after_s = 0.0\n"}},
      {"a tilted start, no fixes",
       {"alignment"},
       Kind::kOwnSwitch,
       {kPerfectFixes, kPerfectUnit,
        "run.initial_attitude_error_deg = [1.5, 1.5, 0.0]\nrun.withhold_fixes_after_s = 0.0\n"}},
      {"reflected signals, half-chip correlator",
       {"reflections_healed", "reflections_dropped"},
       Kind::kOwnSwitch,
       {kReceiver, kPerfectUnit, kAligned, "gnss.multipath_scale = 3.0\ngnss.thermal_noise_scale = 0.1\n"}},
      {"hidden signals that a sensitive receiver holds",
       {"reflections_healed", "reflections_dropped"},
       Kind::kOwnSwitch,
       {kReceiver, kPerfectUnit, kAligned, "gnss.tracking_threshold_dbhz = 10.0\ngnss.thermal_noise_scale = 0.1\n"}},
      {"blocked satellites, a thin ionosphere",
       {"blockage"},
       Kind::kOwnSwitch,
       {kReceiver, kThinIonosphere, kPerfectUnit, kAligned,
        "gnss.multipath_scale = 0.0\ngnss.hidden_signals = \"dropped\"\n"}},
      // Its scans are put straight by the true motion: the filter's vertical speed, which such heights make wrong,
      // bends them too.
      {"heights that jump, an autonomy that remembers heights",
       {"height"},
       Kind::kOwnSwitch,
       {kPerfectUnit, kAligned, kLooks,
        "lidar.deskew = \"truth\"\n"
        "autonomy.model = \"reference_2012\"\ngnss.model = \"truth_plus_white\"\ngnss.white_sigma_m = 0.05\n"
        "gnss.white_sigma_up_m = 6.0\nsuccess.stuck_after_s = 20.0\n"}},
      // One source without a switch: of the pose as a whole it can be said.
      {"fixes that err by ten metres and claim decimetres",
       {"navigation"},
       Kind::kNoSwitch,
       {kPerfectUnit, kAligned,
        "gnss.model = \"truth_plus_isotropic\"\ngnss.isotropic_min_m = 6.0\ngnss.isotropic_max_m = 12.0\n"}},
      {"an ionosphere that nobody corrects",
       {"navigation"},
       Kind::kNoSwitch,
       {kOpenSky, kPerfectUnit, kAligned, "gnss.mode = \"single_uncorrected\"\ngnss.vtec_tecu = 300.0\n"}},
      {"satellites that are not where they say",
       {"navigation"},
       Kind::kNoSwitch,
       {kOpenSky, kPerfectUnit, kAligned, "gnss.mode = \"single\"\ngnss.ephemeris_sigma_m = 15.0\n"}},
      {"a base station that is wrong",
       {"navigation"},
       Kind::kNoSwitch,
       {kOpenSky, kPerfectUnit, kAligned, "gnss.base_error_scale = 30.0\n"}},
      {"a loop that is all noise",
       {"navigation"},
       Kind::kNoSwitch,
       {kOpenSky, kPerfectUnit, kAligned, "gnss.thermal_noise_scale = 20.0\n"}},
      // Two together.
      {"blocked satellites and a cheap unit: both are needed",
       {"blockage", "imu"},
       Kind::kTwoTogether,
       {kReceiver, kAligned,
        "imu.errors = \"datasheet\"\nimu.sensor = \"mpu6050\"\ngnss.multipath_scale = 0.0\ngnss.hidden_signals = "
        "\"dropped\"\n"
        "gnss.fewest_satellites = 9\n"}},
      {"a crooked start and a cheap unit: either is enough",
       {"navigation"},
       Kind::kTwoTogether,
       {kPerfectFixes,
        "imu.errors = \"datasheet\"\nimu.sensor = \"mpu6050\"\nrun.initial_attitude_error_deg = [2.0, 2.0, 10.0]\n"
        "run.withhold_fixes_after_s = 0.0\n"}},
      {"blocked satellites and reflections: either is enough",
       {"buildings"},
       Kind::kTwoTogether,
       {kReceiver, kThinIonosphere, kPerfectUnit, kAligned,
        "gnss.multipath_scale = 3.0\ngnss.hidden_signals = \"dropped\"\n"}},
      // None: the true pose would not have helped.
      {"a street that is barred", {}, Kind::kNone, {kPerfectFixes, kPerfectUnit, kAligned, kBarrier}},
      {"a street that is barred, and fixes of a metre",
       {},
       Kind::kNone,
       {kPerfectUnit, kAligned, kBarrier, "gnss.model = \"truth_plus_white\"\ngnss.white_sigma_m = 1.0\n"}},
      {"a LIDAR that sees nothing",
       {},
       Kind::kNone,
       {kPerfectFixes, kPerfectUnit, kAligned, kLooks, "lidar.blinded = true\nsuccess.stuck_after_s = 10.0\n"}},
      {"a car that drives into it",
       {},
       Kind::kNone,
       {kPerfectFixes, kPerfectUnit, kAligned,
        "scene.moving = [{name = \"car\", path_m = [213.9, 190.0, 213.9, 30.0], speed_m_s = 4.0}]\n"}},
  };
  return all;
}

const std::vector<Plant>& plants_of_chance() {
  using Kind = Plant::Kind;
  static const std::vector<Plant> all{
      // The true pose never passes: who asked for a difference, not for help, would name navigation each time.
      {"somebody whom only an error passes by", {}, Kind::kNone, {kReceiver, kBesideTheMiddle}},
  };
  return all;
}

Result<Comparison> planted(const Plant& plant, std::int64_t seed) {
  CANYON_TRY(auto file, mission::MissionFile::parse(kDrive, "drive.toml"));
  for (const char* toml : plant.toml) {
    CANYON_TRY(const auto over, ConfigNode::parse(toml, plant.name));
    file.lay_over(over);
  }
  file.set_option("run.seed", ConfigNode::of(seed), "test");
  return prepare_comparison(file, plan_runs({"low"}, false));
}

}  // namespace canyon::study::testing
