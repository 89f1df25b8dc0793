#include "canyon/core/output/failure_words.h"

#include <gtest/gtest.h>

namespace canyon {
namespace {

ToldFailure hit(const std::string& thing) {
  return {.kind = "collision", .detail = "hit " + thing};
}

// 2026-11-29: `compare --why` said "collision, hit vehicle 350".
TEST(FailureWords, ACollisionSaysWhatKindOfThingWasHitAndWhatTheLidarKnew) {
  ToldFailure failure = hit("vehicle 350");
  EXPECT_EQ(failure_line(failure), "hit a parked car (vehicle 350)") << "nobody knows what scans had shown";
  failure.in_scans_s = 1.4, failure.last_range_m = 4.2, failure.last_seen_s = 0.05;
  EXPECT_EQ(failure_line(failure),
            "hit a parked car (vehicle 350), seen by its LIDAR for the last 1.4 s, in the end 4.2 m off");
  failure.in_scans_s = 12.4, failure.last_range_m = 10.6;
  EXPECT_EQ(sighting_words(failure, "~"), ", seen by its LIDAR for the last 12~s, in the end 11~m off");
  failure.last_range_m = 2.0, failure.last_seen_s = 1.5;
  EXPECT_EQ(failure_line(failure), "hit a parked car (vehicle 350), last seen by its LIDAR 2.0 m off, 1.5 s before");
  failure.in_scans_s = 0.0, failure.last_seen_s = 0.1;
  EXPECT_EQ(failure_line(failure),
            "hit a parked car (vehicle 350), which its LIDAR saw in the last scan only, 2.0 m off");
  failure.last_range_m = failure.last_seen_s = std::nan("");
  EXPECT_EQ(failure_line(failure), "hit a parked car (vehicle 350), which no scan of its LIDAR had shown");
}

TEST(FailureWords, EachKindOfThingHasItsWord) {
  EXPECT_EQ(failure_words(hit("other vehicle bus 2")), "hit another vehicle (bus 2)");
  EXPECT_EQ(failure_words(hit("building 217")), "hit a building (building 217)");
  EXPECT_EQ(failure_words(hit("tree 3")), "hit a tree (tree 3)");
  EXPECT_EQ(failure_words(hit("wall 1")), "hit a wall (wall 1)");
  EXPECT_EQ(failure_words(hit("pole 8")), "hit a pole (pole 8)");
  EXPECT_EQ(failure_words(hit("person 1")), "hit a person (person 1)");
  EXPECT_EQ(failure_words(hit("terrain")), "hit the ground (terrain)");
  EXPECT_EQ(failure_words(hit("the fountain")), "hit \"the fountain\"");
}

TEST(FailureWords, OtherEndsHaveTheirDetailInBrackets) {
  EXPECT_EQ(failure_line({.kind = "stuck", .detail = "stood still for 30.0 s"}), "got stuck (stood still for 30.0 s)");
  EXPECT_EQ(failure_line({.kind = "timeout", .detail = ""}), "ran out of time");
  EXPECT_EQ(failure_line({.kind = "collision", .detail = "blocked for 20 s"}), "hit an obstacle (blocked for 20 s)")
      << "results of others: it is not said what was hit";
  EXPECT_EQ(outcome_words("fell_asleep"), "ended with \"fell asleep\"") << "results of a later version";
}

}  // namespace
}  // namespace canyon
