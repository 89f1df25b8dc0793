// What the registered pose tells the filter in a mission: of the motion between keyframes (map aiding), and of the
// place in a map that was there before.
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "canyon/tests/mission/short_mission.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::mission::testing {
namespace {

using ::testing::HasSubstr;

double rms_error_m(const RecordedRun& run) {
  double sum = 0.0;
  for (const NavRow& row : run.nav) sum += position_error_m(row) * position_error_m(row);
  return std::sqrt(sum / static_cast<double>(run.nav.size()));
}

double rms_registered_m(const RecordedRun& run) {
  double sum = 0.0;
  for (const KeyframeRow& row : run.keyframes) sum += (row.X_WL_registered.p - row.X_WL_true.p).squaredNorm();
  return std::sqrt(sum / static_cast<double>(run.keyframes.size()));
}

std::string refusal(const std::string& extra) {
  const auto mission = prepare(short_config("low", "low", extra), scenes());
  return mission.ok() ? "" : mission.error().str();
}

// Without a fix and without wheels, a unit that wanders: what is left to the filter are the surfaces. The two runs
// differ in nothing but that it is told of them.
TEST(MapAiding, TheMotionBetweenKeyframesHoldsAFilterThatHasNothingElse) {
  const std::string coasting =
      "[run]\nwithhold_fixes_after_s = 0.0\n[time]\nlimit_s = 30.0\n[registration]\nmethod = \"gicp\"\n"
      "[fusion]\nfilter = \"naive\"\n";
  const RecordedRun alone = drive(short_config("high", "high", coasting));
  const RecordedRun aided = drive(short_config("high", "high", coasting + "map_aiding = true\n"));
  ASSERT_GT(aided.keyframes.size(), 10U);
  // Unaided it is off by metres; scan to scan it wanders by centimetres a keyframe.
  EXPECT_LT(rms_error_m(aided), 0.3 * rms_error_m(alone)) << rms_error_m(alone);
}

class PriorMap : public ::testing::Test {
 protected:
  PriorMap() {
    const std::vector<lidar::MapPoint>& points = map_points();
    std::ofstream out(map(), std::ios::binary);
    out << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << points.size()
        << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << points.size() << "\nDATA binary\n";
    for (const lidar::MapPoint& point : points)
      out.write(reinterpret_cast<const char*>(point.p_W.data()), 3 * sizeof(float));
  }
  std::string map() const { return folder_.file("map.pcd"); }
  static std::string registered() { return "[time]\nlimit_s = 30.0\n[registration]\nmethod = \"gicp\"\n"; }
  std::string onto_map() const { return registered() + "prior_map = \"" + map() + "\"\n"; }

  canyon::testing::TemporaryFolder folder_;

 private:
  /// Of a run whose pose is the truth.
  static const std::vector<lidar::MapPoint>& map_points() {
    static const std::vector<lidar::MapPoint> points =
        drive(short_config("low", "low", "[run]\ntruth_as_pose = true\n[time]\nlimit_s = 40.0\n")).prior_map;
    return points;
  }
};

TEST_F(PriorMap, KeyframesAreWhereTheMapHasThem) {
  const std::string vehicle = "[fusion]\nfilter = \"vehicle\"\n";
  const RecordedRun without = drive(short_config("high", "high", registered() + vehicle));
  const RecordedRun with = drive(short_config("high", "high", onto_map() + vehicle));
  ASSERT_GT(with.keyframes.size(), 10U);
  std::size_t found = 0;
  for (const KeyframeRow& row : with.keyframes) found += row.map_status == lidar::RegistrationStatus::kConverged;
  EXPECT_EQ(static_cast<std::int64_t>(found), with.counters.at("keyframes_in_prior_map"));
  EXPECT_EQ(without.counters.at("keyframes_in_prior_map"), 0);
  EXPECT_GE(found, with.keyframes.size() * 9 / 10);
  EXPECT_LT(rms_registered_m(with), 0.1);
  EXPECT_GT(rms_registered_m(without), 2.0 * rms_registered_m(with));
  // Nobody is told of it: the filter's own estimate is the same to the bit.
  ASSERT_EQ(with.nav.size(), without.nav.size());
  EXPECT_EQ(with.nav.back().estimate.X_WB.p, without.nav.back().estimate.X_WB.p);
}

TEST_F(PriorMap, AFilterThatIsToldKeepsWithinDecimetres) {
  const std::string measures =
      "[fusion]\nfilter = \"vehicle\"\nmeasurements = [\"position\", \"odometer\", \"non_holonomic\"";
  const RecordedRun alone = drive(short_config("high", "high", registered() + measures + "]\n"));
  const RecordedRun told = drive(short_config("high", "high", onto_map() + measures + ", \"map_pose\"]\n"));
  EXPECT_LT(rms_error_m(told), 0.2);
  EXPECT_GT(rms_error_m(alone), 2.0 * rms_error_m(told));
}

TEST_F(PriorMap, WhatContradictsItself) {
  EXPECT_THAT(refusal("[registration]\nprior_map = \"" + map() + "\"\n"),
              HasSubstr("registration.prior_map: with method \"none\" nothing is registered onto a map, expected "
                        "another registration.method"));
  EXPECT_THAT(refusal("[registration]\nmethod = \"gicp\"\n[fusion]\nmeasurements = [\"position\", \"map_pose\"]\n"),
              HasSubstr("fusion.measurements: \"map_pose\" is the pose in a map that was there before, and there is "
                        "none, expected a registration.prior_map"));
  EXPECT_THAT(refusal("[registration]\nmethod = \"gicp\"\nprior_map = \"none.pcd\"\n"),
              HasSubstr("registration.prior_map: \"none.pcd\" cannot be read (No such file or directory)"));
  EXPECT_THAT(refusal(onto_map() + "[autonomy]\nmap = \"registered\"\n[fusion]\nmeasurements = [\"position\", "
                                   "\"map_pose\"]\n"),
              HasSubstr("autonomy.map, fusion.measurements: the filter has \"map_pose\", and the registered map would "
                        "move its estimate once more, expected autonomy.map = \"prior\", or measurements without it"));
  const std::string broken = folder_.file("broken.pcd");
  std::ofstream(broken) << "VERSION 0.7\n";
  EXPECT_THAT(refusal("[registration]\nmethod = \"gicp\"\nprior_map = \"" + broken + "\"\n"),
              HasSubstr("registration.prior_map: \"" + broken + "\" "));
}

}  // namespace
}  // namespace canyon::mission::testing
