#include "canyon/mission/config/mission_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/tests/mission/config/mission_message.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::mission {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kEmptyScene;
using testing::message;
using testing::parse;

TEST(MissionFile, BuiltInMissionHasElevenWaypointsOfWhichThreeAreMissionWaypoints) {
  const auto config = MissionFile::load("")->resolve("high");
  ASSERT_TRUE(config.ok()) << config.error().str();
  ASSERT_EQ(config->autonomy.waypoints.size(), 11U);
  for (std::size_t i = 0; i < 11; ++i)
    EXPECT_EQ(config->autonomy.waypoints[i].is_mission(), i == 6 || i == 8 || i == 10) << i + 1;
}

TEST(MissionFile, TheBuiltInMissionHasAName) {
  const auto fields = [](const std::string& name) {
    MissionConfig config = *MissionFile::load(name)->resolve("low");
    return fields_as_json([&config](FieldVisitor& f) { visit(f, config); });
  };
  EXPECT_EQ(fields("vicksburg"), fields(""));
}

TEST(MissionFile, LayersWinInTheirOrder) {
  // The user's [gnss] holds for every fidelity, the user's [fidelity.low.gnss] for that one, an option over all.
  MissionFile file = parse("base = \"vicksburg\"\n[gnss]\nrate_hz = 5.0\n[fidelity.low.gnss]\nrate_hz = 4.0\n");
  EXPECT_EQ(file.resolve("high")->gnss.rate_hz, 5.0);
  EXPECT_EQ(file.resolve("low")->gnss.rate_hz, 4.0);
  EXPECT_EQ(file.resolve("low")->gnss.model.name, "truth_plus_isotropic");
  EXPECT_EQ(file.resolve("high")->gnss.model.name, "pseudorange");
  file.set_option("gnss.rate_hz", ConfigNode::of(1.0), "--rate");
  EXPECT_EQ(file.resolve("low")->gnss.rate_hz, 1.0);
}

TEST(MissionFile, MixedRunsTakeTheImuAndItsAlignmentFromTheOther) {
  const MissionFile file = parse("base = \"vicksburg\"\n");
  const auto mixed = file.resolve_mixed("high", "low");
  EXPECT_EQ(mixed->gnss.model.name, "pseudorange");
  EXPECT_EQ(mixed->imu.errors, "white_only");
  EXPECT_EQ(mixed->run.initial_attitude_error_deg, Eigen::Vector3d::Zero());
}

TEST(MissionFile, AFidelityOfOnesOwn) {
  const MissionFile file = parse("base = \"vicksburg\"\n[fidelity.mine.gnss]\nmode = \"single\"\n");
  EXPECT_EQ(file.resolve("mine")->gnss.mode.name, "single");
  EXPECT_EQ(file.resolve("nobody").error().str(),
            "my.toml: fidelity.nobody: unknown fidelity, expected one of high, high_aided, low, modern, paper, mine");
}

/// Keys whose values differ between two fidelities.
std::vector<std::string> differences(const MissionFile& file, const std::string& a, const std::string& b) {
  const auto fields = [&](const std::string& fidelity) {
    MissionConfig config = *file.resolve(fidelity);
    return documented_fields("", [&config](FieldVisitor& f) { visit(f, config); });
  };
  const auto of_a = fields(a), of_b = fields(b);
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < of_a.size(); ++i)
    if (of_a[i].default_value != of_b[i].default_value) keys.push_back(of_a[i].key);
  return keys;
}

TEST(MissionFile, AFidelityIsLaidOverItsBase) {
  const MissionFile file = parse(
      "base = \"vicksburg\"\n[fidelity.careful.fusion]\ngate_sigma = 3.0\n[fidelity.rough]\nbase = \"low\"\n"
      "gnss.rate_hz = 4.0\n[fidelity.rougher]\nbase = \"rough\"\nimu.rate_hz = 200.0\n");
  EXPECT_THAT(differences(file, "high", "careful"), ElementsAre("fusion.gate_sigma"));
  EXPECT_THAT(differences(file, "low", "rough"), ElementsAre("gnss.rate_hz"));
  EXPECT_THAT(differences(file, "low", "rougher"), ElementsAre("gnss.rate_hz", "imu.rate_hz"));
}

TEST(MissionFileMessages, BaseOfAFidelity) {
  EXPECT_EQ(message("base = \"vicksburg\"\n[fidelity.mine]\nbase = \"hihg\"\n"),
            "my.toml:3: fidelity.mine.base: string \"hihg\" is not a fidelity, expected one of high, high_aided, low, "
            "modern, "
            "paper, mine");
  EXPECT_EQ(message("base = \"vicksburg\"\n[fidelity.a]\nbase = \"b\"\n[fidelity.b]\nbase = \"a\"\n"),
            "my.toml:5: fidelity.b.base: \"a\" is based on this fidelity in turn, expected another one");
  EXPECT_EQ(message("base = \"vicksburg\"\n[fidelity.low]\nbase = \"high\"\n"),
            "my.toml:3: fidelity.low.base: \"low\" is built in, expected a base only for a fidelity of your own");
}

TEST(MissionFileMessages, UnknownKeyNamesTheNearest) {
  EXPECT_THAT(message("base = \"vicksburg\"\n[gnss]\nrate_hzz = 2.0\n"),
              ::testing::AllOf(HasSubstr("my.toml:3: gnss.rate_hzz: "), HasSubstr("\"rate_hz\"")));
}

TEST(MissionFileMessages, ValueOutOfRange) {
  EXPECT_THAT(message("base = \"vicksburg\"\n[gnss]\n\nmask_deg = 95.0\n"), HasSubstr("my.toml:4: gnss.mask_deg: "));
}

TEST(MissionFileMessages, MalformedToml) {
  EXPECT_THAT(message("[gnss\nrate_hz = 2.0\n"), HasSubstr("my.toml:1: "));
}

TEST(MissionFileMessages, UnknownBase) {
  EXPECT_EQ(message("base = \"atlantis\"\n"),
            "my.toml:1: base: string \"atlantis\" is not a built-in mission, expected one of first_corner, first_stop, "
            "vicksburg");
}

// 2026-11-22: each of these ran.
TEST(MissionFileMessages, KeysThatContradictOneAnother) {
  const auto told = [](const std::string& lines) { return message(std::string(kEmptyScene) + lines); };
  EXPECT_EQ(
      told("[vehicle]\nwheelbase_m = 6.0\nlength_m = 0.3\n"),
      "my.toml:5: vehicle.wheelbase_m: a wheelbase of 6 m under a body of 0.3 m, expected vehicle.wheelbase_m not "
      "above vehicle.length_m");
  EXPECT_EQ(told("[vehicle]\nwidth_m = 1.0\n"),
            "my.toml:5: vehicle.width_m: a track of 1.3 m under a body 1 m wide, expected vehicle.track_m not above "
            "vehicle.width_m");
  EXPECT_EQ(told("[vehicle]\nheight_m = 0.5\nground_clearance_m = 0.6\n"),
            "my.toml:6: vehicle.ground_clearance_m: a body 0.5 m high that begins 0.6 m above the ground, expected "
            "vehicle.ground_clearance_m not above vehicle.height_m");
  EXPECT_EQ(told("kerb_height_m = 0.25\n"),
            "my.toml:4: scene.kerb_height_m: kerbs of 0.25 m under a body that begins 0.2 m above the ground, expected "
            "scene.kerb_height_m not above vehicle.ground_clearance_m");
  EXPECT_EQ(told("[vehicle]\nmodel = \"dynamic_bicycle\"\ntyre_friction = 0.2\n"),
            "my.toml:6: vehicle.tyre_friction: the vehicle brakes with 3 m/s^2, its tyres hold 2.0 m/s^2, expected "
            "vehicle.max_deceleration_m_s2 not above vehicle.tyre_friction times gravity");
  EXPECT_EQ(told("[vehicle]\nmodel = \"dynamic_bicycle\"\ntyre_friction = 0.5\n[autonomy]\nlateral_m_s2 = 6.0\n"),
            "my.toml:8: autonomy.lateral_m_s2: the autonomy plans turns with 6 m/s^2, its tyres hold 4.9 m/s^2, "
            "expected autonomy.lateral_m_s2 not above vehicle.tyre_friction times gravity");
  EXPECT_EQ(told("[autonomy]\ncruise_m_s = 8.0\n"),
            "my.toml:5: autonomy.cruise_m_s: the autonomy plans with 8 m/s, the vehicle drives at most 6 m/s, expected "
            "autonomy.cruise_m_s not above vehicle.max_speed_m_s");
  EXPECT_EQ(told("[fusion]\nstates = [\"biases\", \"in_run_biases\"]\n"),
            "my.toml:5: fusion.states: \"biases\" already holds what \"turn_on_biases\" and \"in_run_biases\" hold, "
            "expected \"biases\", or the other two");
  EXPECT_EQ(told("[vehicle]\nmax_deceleration_m_s2 = 1.0\n"),
            "my.toml:5: vehicle.max_deceleration_m_s2: the autonomy plans with 1.2 m/s^2, the vehicle brakes with at "
            "most 1 m/s^2, expected autonomy.braking_m_s2 not above vehicle.max_deceleration_m_s2");
  EXPECT_EQ(told("[autonomy]\ncorner_radius_m = 2.0\n"),
            "my.toml:5: autonomy.corner_radius_m: the vehicle's tightest turn has a radius of 2.88 m, turns of 2.00 m "
            "are planned, expected autonomy.corner_radius_m of vehicle.wheelbase_m / tan(vehicle.max_steering_deg) or "
            "more");
  EXPECT_EQ(told("[autonomy]\nmodel = \"reference_2012\"\nclearance_m = 0.5\n"),
            "my.toml:6: autonomy.clearance_m: a vehicle 1.5 m wide does not pass an obstacle 0.5 m beside its axis, "
            "expected autonomy.clearance_m of half vehicle.width_m or more");
  EXPECT_EQ(told("[autonomy]\nmodel = \"reference_2012\"\n[autonomy.choice]\nhorizon_m = 30.0\n"),
            "my.toml:7: autonomy.choice.horizon_m: paths are checked 30 m ahead, the grid reaches 25 m, expected "
            "autonomy.choice.horizon_m not above autonomy.grid.half_size_m");
  EXPECT_EQ(
      told("[lidar]\nrate_hz = 1.0\n"),
      "my.toml:5: lidar.rate_hz: the autonomy takes itself for blind after 0.5 s, a scan comes every 1 s, expected "
      "autonomy.blind_after_s of 1 / lidar.rate_hz or more");
}

// 2026-11-30: each of these ran: as if it said "prior", without any middle of a street, with one of the two keys left
// out.
TEST(MissionFileMessages, AnAutonomyThatContradictsItself) {
  const auto told = [](const std::string& lines) { return message(std::string(kEmptyScene) + lines); };
  EXPECT_EQ(told("[autonomy]\nmap = \"registered\"\n[registration]\nmethod = \"none\"\n"),
            "my.toml:5: autonomy.map: the autonomy works with the registered pose, and with method \"none\" nothing is "
            "registered, expected another registration.method, or autonomy.map = \"prior\"");
  EXPECT_EQ(told("[autonomy]\nmap = \"registered\"\n"), "no mistake");
  EXPECT_EQ(told("[autonomy.lane]\nwidest_m = 4.0\n"),
            "my.toml:5: autonomy.lane.widest_m: no street is 5 m wide or more and 4 m or less, expected "
            "autonomy.lane.narrowest_m not above autonomy.lane.widest_m");
  EXPECT_EQ(told("[autonomy.lane]\nmodel = \"seen_kerbs\"\nnarrowest_m = 30.0\n"),
            "my.toml:6: autonomy.lane.narrowest_m: no street is 30 m wide or more and 25 m or less, expected "
            "autonomy.lane.narrowest_m not above autonomy.lane.widest_m");
  EXPECT_EQ(told("[autonomy.lane]\nwidest_m = 5.0\n"), "no mistake");
  EXPECT_EQ(told("[autonomy.lane]\nmodel = \"route\"\nwidest_m = 4.0\n"), "no mistake") << "nobody reads it";
  EXPECT_EQ(told("[autonomy.tracker]\nlookahead_min_m = 6.0\n"),
            "my.toml:5: autonomy.tracker.lookahead_min_m: it steers for a point no nearer than 6 m and no farther than "
            "5 m, expected autonomy.tracker.lookahead_min_m not above autonomy.tracker.lookahead_max_m");
  EXPECT_EQ(told("[autonomy.tracker]\nmodel = \"stanley\"\nlookahead_min_m = 6.0\n"), "no mistake");
  EXPECT_EQ(told("[autonomy.planner]\nclearance_m = 1.0\n"),
            "my.toml:5: autonomy.planner.clearance_m: nearer than 0.8 m costs, and no way is nearer than 1 m, expected "
            "autonomy.planner.clearance_m not above autonomy.planner.comfort_clearance_m");
  EXPECT_EQ(
      told("[autonomy.planner]\nmodel = \"hybrid_a_star\"\ncomfort_clearance_m = 0.2\n"),
      "my.toml:6: autonomy.planner.comfort_clearance_m: nearer than 0.2 m costs, and no way is nearer than 0.3 m, "
      "expected autonomy.planner.clearance_m not above autonomy.planner.comfort_clearance_m");
  const std::string of_2012 = "[autonomy]\nmodel = \"reference_2012\"\n[autonomy.choice]\n";
  EXPECT_EQ(
      told(of_2012 + "stop_margin_m = 19.0\n"),
      "my.toml:7: autonomy.choice.stop_margin_m: it halts 19 m before what it looks for only 18 m ahead, expected "
      "autonomy.choice.stop_margin_m not above autonomy.choice.horizon_m");
  EXPECT_EQ(told(of_2012 + "stop_margin_m = 18.0\n"), "no mistake");
  EXPECT_EQ(told("[autonomy.choice]\nstop_margin_m = 19.0\n"), "no mistake") << "who drives has no such key";
  // Of another autonomy than the one that drives.
  EXPECT_EQ(told(of_2012 + "[autonomy.lane]\nwidest_m = 4.0\n"), "no mistake");
}

// 2026-11-30: accepted, and results told neither from the other.
TEST(MissionFileMessages, TwoMovingThingsOfOneName) {
  const std::string bus = "[[scene.moving]]\nname = \"line 9\"\npath_m = [112.9, -187.9]\n";
  EXPECT_EQ(
      message(kEmptyScene + bus + bus),
      "my.toml:7: scene.moving[2].name: \"line 9\" is the name of scene.moving[1] too, expected a name of its own");
}

// Keys of earlier versions are told by name, with what took their place.
TEST(MissionFileMessages, AnOldKey) {
  EXPECT_EQ(message("base = \"vicksburg\"\n[imu]\nvibration_g = [0.0, 0.0, 1.0]\n"),
            "my.toml:3: imu.vibration_g: is a key of an earlier version, expected imu.vibration_m_s2, in m/s^2 (1 g = "
            "9.80665 m/s^2)");
}

// 2026-11-22: rates that were no multiples of one another were refused; now each sensor is due at its own ticks.
TEST(MissionFileMessages, RatesNeedNotBeMultiplesOfOneAnother) {
  EXPECT_EQ(message(std::string(kEmptyScene) + "[imu]\nrate_hz = 25.0\n[gnss]\nrate_hz = 3.0\n"), "no mistake");
}

// 2026-11-21: accepted, though the vehicle then drives on before the stop counts.
TEST(MissionFileMessages, AStopThatTheAutonomyDoesNotMake) {
  EXPECT_EQ(message(std::string(kEmptyScene) + "[success]\nstop_s = 6.5\n"),
            "my.toml:5: success.stop_s: a stop of 6.5 s is asked for, but the autonomy stops for 6 s, expected "
            "success.stop_s not above autonomy.hold_s");
  EXPECT_EQ(message(std::string(kEmptyScene) + "[autonomy]\nhold_s = 4.0\n"),
            "my.toml:5: autonomy.hold_s: a stop of 5 s is asked for, but the autonomy stops for 4 s, expected "
            "success.stop_s not above autonomy.hold_s");
  EXPECT_EQ(message(std::string(kEmptyScene) + "[success]\nstop_s = 6.0\n"), "no mistake");
}

// 2026-11-29: accepted. It halts up to 0.4 m before the waypoint, where the halt did not count.
TEST(MissionFileMessages, AStopThatDoesNotCountWhereItIsMade) {
  EXPECT_EQ(message(std::string(kEmptyScene) + "[success]\nwaypoint_radius_m = 0.3\n"),
            "my.toml:5: success.waypoint_radius_m: a stop counts within 0.3 m of its waypoint, and the autonomy halts "
            "up to 0.4 m before it, expected success.waypoint_radius_m of 0.4 or more");
}

// 2026-11-29: accepted, and ended as "stuck" before anything had been tried, or went on backing up for ever on the
// spot.
TEST(MissionFileMessages, AWayBackThatCannotBeDriven) {
  const auto told = [](const std::string& lines) { return message(std::string(kEmptyScene) + lines); };
  EXPECT_EQ(told("[success]\nstuck_after_s = 10.0\n[autonomy.recovery]\nwait_s = 20.0\n"),
            "my.toml:7: autonomy.recovery.wait_s: the autonomy stands for 20 s before it backs up, and counts as stuck "
            "after 10 s, expected autonomy.recovery.wait_s below success.stuck_after_s");
  EXPECT_EQ(told("[vehicle]\nmax_reverse_m_s = 0.0\n"),
            "my.toml:5: vehicle.max_reverse_m_s: the autonomy backs up where no way ahead is free, and the vehicle "
            "cannot, expected a vehicle.max_reverse_m_s above 0, or autonomy.recovery.model = \"wait\"");
  EXPECT_EQ(told("[vehicle]\nmax_reverse_m_s = 0.0\n[autonomy.recovery]\nmodel = \"wait\"\n"), "no mistake");
}

// 2026-11-21: "3.2999999999999998 Hz".
TEST(MissionFileMessages, NumbersAreShownAsTheyWereWritten) {
  EXPECT_EQ(message(std::string(kEmptyScene) + "[success]\nstop_s = 7.3\n"),
            "my.toml:5: success.stop_s: a stop of 7.3 s is asked for, but the autonomy stops for 6 s, expected "
            "success.stop_s not above autonomy.hold_s");
}

TEST(MissionFileMessages, BadStart) {
  EXPECT_THAT(message(std::string(kEmptyScene) + "[time]\nstart = \"yesterday\"\n"),
              HasSubstr("my.toml:5: time.start: "));
}

TEST(MissionFileMessages, MissingNavigationFile) {
  EXPECT_THAT(message(std::string(kEmptyScene) + "[gnss]\nnav_file = \"no/such.10n\"\n"), HasSubstr("no/such.10n"));
}

// 2026-11-21: such a waypoint was driven to at (0, 0).
TEST(MissionFileMessages, AWaypointWithoutAPlace) {
  EXPECT_EQ(message(std::string(kEmptyScene) + "[[autonomy.waypoint]]\nname = \"lost\"\n"),
            "my.toml:4: autonomy.waypoint[1].p_m: is missing, expected a list of 2 numbers");
}

TEST(MissionFileMessages, WhatAllRunsShareCannotDifferBetweenFidelities) {
  const std::string base = "base = \"vicksburg\"\n";
  EXPECT_EQ(
      message(base + "[fidelity.flat.scene]\nempty = true\n"),
      "my.toml:2: fidelity.flat.scene: is shared by all runs, expected it outside of [fidelity], for all of them");
  EXPECT_EQ(message(base + "[fidelity.late.time]\nlimit_s = 3\n"),
            "my.toml:2: fidelity.late.time: is shared by all runs, expected it outside of [fidelity], for all of them");
  EXPECT_EQ(message(base + "[fidelity.low.run]\n\nseed = 3\n"),
            "my.toml:4: fidelity.low.run.seed: is shared by all runs, expected it outside of [fidelity], for all of "
            "them");
  EXPECT_EQ(message(base + "[fidelity.low]\nvehicle.start_m = [0, 0]\n"),
            "my.toml:3: fidelity.low.vehicle.start_m: is shared by all runs, expected it outside of [fidelity], for "
            "all of them");
  EXPECT_EQ(message(base + "[fidelity.low.vehicle]\nmax_speed_m_s = 3\n[fidelity.low.run]\nmap_leaf_m = 0.5\n"),
            "no mistake");
}

TEST(MissionFileMessages, NamesThatWouldMakeBrokenPaths) {
  EXPECT_EQ(message("base = \"vicksburg\"\n[run]\nname = \"a/b c\"\n"),
            "my.toml:3: run.name: found \"a/b c\", expected a name of letters, digits, \"-\" and \"_\"");
  EXPECT_EQ(message("base = \"vicksburg\"\n[fidelity.\"../x\".gnss]\nrate_hz = 1\n"),
            "my.toml:2: fidelity: found the name \"../x\", expected a name of letters, digits, \"-\" and \"_\"");
  EXPECT_EQ(message("base = \"vicksburg\"\n[run]\nname = \"\"\n"),
            "my.toml:3: run.name: found \"\", expected a name of letters, digits, \"-\" and \"_\"");
}

TEST(MissionFileMessages, AFidelityThatIsNoTable) {
  EXPECT_EQ(message("base = \"vicksburg\"\n[fidelity]\nmine = 3\n"),
            "my.toml:3: fidelity.mine: found integer 3, expected a table");
  EXPECT_EQ(message("base = \"vicksburg\"\nfidelity = 3\n"), "my.toml:2: fidelity: found integer 3, expected a table");
}

TEST(MissionFileMessages, AMistakeInAFidelityThatIsNotUsed) {
  EXPECT_EQ(message("base = \"vicksburg\"\n[fidelity.later.gnss]\nmask_degg = 5.0\n"),
            "my.toml:3: fidelity.later.gnss.mask_degg: unknown key, expected one of the documented keys; nearest is "
            "\"mask_deg\"");
}

TEST(MissionFileMessages, FidelitiesThatAreAskedFor) {
  const MissionFile file = parse("base = \"vicksburg\"\n[fidelity.mine.gnss]\nrate_hz = 1.0\n");
  const auto told = [&](const std::vector<std::string>& names) {
    const auto status = file.check_fidelities(names, "--fidelities");
    return status ? "no mistake" : status.error().str();
  };
  EXPECT_EQ(told({"high", "low", "mine"}), "no mistake");
  EXPECT_EQ(told({"low", "high", "low"}), "--fidelities: \"low\" given twice, expected each fidelity once");
  EXPECT_EQ(told({"hihg"}),
            "--fidelities: \"hihg\" is unknown, expected one of high, high_aided, low, modern, paper, mine; nearest is "
            "\"high\"");
  EXPECT_EQ(told({""}), "--fidelities: \"\" is unknown, expected one of high, high_aided, low, modern, paper, mine");
}

TEST(MissionFileMessages, FilesThatCannotBeReadAreToldWhereTheyAreNamed) {
  const std::string base = "base = \"vicksburg\"\n[scene]\nempty = true\n";
  EXPECT_EQ(message(base + "[imu]\nsensor = \"mine/imu.toml\"\n"),
            "my.toml:5: imu.sensor: \"mine/imu.toml\" cannot be read (No such file or directory), expected a readable "
            "file");
  EXPECT_EQ(message(base + "[lidar]\nbeams = \"my.csv\"\n"),
            "my.toml:5: lidar.beams: \"my.csv\" cannot be read (No such file or directory), expected a readable file");
  EXPECT_EQ(message(base + "[gnss]\nnav_file = \"my.10n\"\n"),
            "my.toml:5: gnss.nav_file: \"my.10n\" cannot be read (No such file or directory), expected a readable "
            "file");
}

// 2026-11-30: of a receiver's file line and key were missing. Asked are all keys that say they take a path.
TEST(MissionFileMessages, EveryKeyThatNamesAFileThatCannotBeReadIsTold) {
  const std::string named = "a name, or a path that ends in ";
  MissionConfig config;
  int keys = 0;
  for (const FieldDoc& field : documented_fields("", [&config](FieldVisitor& f) { visit(f, config); })) {
    const bool is_list = field.range == "a list of paths", is_named = field.range.starts_with(named);
    if (field.range != "a path" && !is_list && !is_named) continue;
    ++keys;
    const std::string file = "\"mine/none" + (is_named ? field.range.substr(named.size()) : ".any") + "\"";
    EXPECT_EQ(message("base = \"vicksburg\"\n\n" + field.key + " = " + (is_list ? "[" + file + "]" : file) + "\n"),
              "my.toml:3: " + field.key + ": " + file +
                  " cannot be read (No such file or directory), expected a readable file");
  }
  EXPECT_EQ(keys, 18) << "scene 4, vehicle 1, gnss 8, imu 2, lidar, fusion and registration 1 each";
}

TEST(Prepare, TheShorterOfTheTwoLimitsHolds) {
  SceneCache scenes;
  const auto prepared = [&](const std::string& time) {
    return *prepare(*parse("base = \"vicksburg\"\n[scene]\nempty = true\n[time]\n" + time).resolve("low"), scenes);
  };
  const double nominal_s = prepared("").nominal_s;
  EXPECT_EQ(prepared("").time_limit_s, 1.5 * nominal_s);
  EXPECT_EQ(prepared("limit_s = 20").time_limit_s, 20.0);
  EXPECT_EQ(prepared("limit_s = 90000").time_limit_s, 1.5 * nominal_s);
  EXPECT_EQ(prepared("limit_s = 90000\n[success]\nlimit_factor = 2").time_limit_s, 2.0 * nominal_s);
}

TEST(Prepare, AMistakeOfAFidelityIsToldWhereItStands) {
  const std::string head = "base = \"vicksburg\"\n[scene]\nempty = true\n[gnss]\nrate_hz = 2.0\n";
  EXPECT_THAT(message(head + "[fidelity.mine]\nlidar.beams = \"vlp17\"\n", "mine"),
              HasSubstr("my.toml:7: fidelity.mine.lidar.beams: unknown beam table \"vlp17\""));
  EXPECT_EQ(
      message(head + "[fidelity.fast.autonomy]\nhold_s = 4.0\n", "fast"),
      "my.toml:7: fidelity.fast.autonomy.hold_s: a stop of 5 s is asked for, but the autonomy stops for 4 s, expected "
      "success.stop_s not above autonomy.hold_s");
  // Of a fidelity based on it, too; and what is set for all stays where it is.
  EXPECT_THAT(message(head + "[fidelity.mine]\nlidar.beams = \"vlp17\"\n[fidelity.next]\nbase = \"mine\"\n", "next"),
              HasSubstr("my.toml:7: fidelity.mine.lidar.beams: unknown"));
  EXPECT_THAT(message(head + "[lidar]\nbeams = \"vlp17\"\n[fidelity.mine.lidar]\nmodel = \"footprint\"\n", "mine"),
              HasSubstr("my.toml:7: lidar.beams: unknown"));
}

TEST(Prepare, OfAMixedRunTheImuIsLookedUpInItsOwnFidelity) {
  const MissionFile file = parse(
      "base = \"vicksburg\"\n[gnss]\nrate_hz = 7.0\n[imu]\nrate_hz = 70.0\n[fidelity.high.gnss]\nrate_hz = 10.0\n"
      "[fidelity.high.imu]\nrate_hz = 300.0\n");
  const Error mistake{.key = "gnss.rate_hz, imu.rate_hz", .what = "no multiple"};
  EXPECT_EQ(file.locate(mistake, "low", "high").str(), "my.toml:9: fidelity.high.imu.rate_hz: no multiple");
  EXPECT_EQ(file.locate(mistake, "high", "low").str(), "my.toml:7: fidelity.high.gnss.rate_hz: no multiple");
  EXPECT_EQ(file.locate(mistake, "low").str(), "my.toml:3: gnss.rate_hz: no multiple");
}

TEST(Prepare, FilesAreReadToTheEndAndTheirHashesKept) {
  const std::string path = canyon::testing::temporary_file("brdc.10n");
  ASSERT_TRUE(write_text_file(path, "abc").ok());  // the low fidelity's GNSS names it and needs no such file
  SceneCache scenes;
  const auto mission = prepare(
      *parse("base = \"vicksburg\"\n[scene]\nempty = true\n[gnss]\nnav_file = \"" + path + "\"\n").resolve("low"),
      scenes);
  ASSERT_TRUE(mission.ok()) << mission.error().str();
  ASSERT_EQ(mission->files.size(), 1U);
  EXPECT_EQ(mission->files[0].path, path);
  // FIPS 180-2, appendix B.1.
  EXPECT_EQ(mission->files[0].sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(MissionFileMessages, MissingMissionFile) {
  EXPECT_THAT(MissionFile::load("no/such.toml").error().str(), HasSubstr("no/such.toml"));
}

}  // namespace
}  // namespace canyon::mission
