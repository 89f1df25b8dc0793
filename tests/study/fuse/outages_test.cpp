#include "canyon/study/fuse/outages.h"

#include <cmath>

#include <gtest/gtest.h>

namespace canyon::study {
namespace {

const GpsTime kDriveBegin = GpsTime::from_week_sow(2200, 457000.0);

TEST(Outages, WindowsThatFitBetweenTheEnds) {
  for (const double first_s : {150.0, 457150.0}) {
    const Outages outages({30.0, 75.0, first_s}, kDriveBegin, kDriveBegin + 600.0);
    ASSERT_EQ(outages.windows().size(), 6U);  // 150, 225, ... 525
    EXPECT_EQ(outages.windows().front().begin, kDriveBegin + 150.0);
    EXPECT_EQ(outages.windows().back().end, kDriveBegin + 555.0);
  }
  EXPECT_TRUE(Outages({30.0, 75.0, 580.0}, kDriveBegin, kDriveBegin + 600.0).windows().empty());
}

TEST(Outages, TheFixAtTheBeginningIsTheLastOne) {
  const Outages outages({30.0, 75.0, 150.0}, kDriveBegin, kDriveBegin + 600.0);
  for (const double t_s : {0.0, 150.0, 180.25, 224.0, 225.0, 600.0})
    EXPECT_FALSE(outages.withholds(kDriveBegin + t_s)) << t_s;
  for (const double t_s : {150.25, 151.0, 180.0, 226.0, 555.0})
    EXPECT_TRUE(outages.withholds(kDriveBegin + t_s)) << t_s;
}

TEST(Outages, ScoreIsTheRootMeanSquareOfTheLargestErrors) {
  Outages outages({10.0, 20.0, 0.0}, kDriveBegin, kDriveBegin + 60.0);
  ASSERT_EQ(outages.windows().size(), 3U);
  outages.add(kDriveBegin + 5.0, 3.0, 1.0);
  outages.add(kDriveBegin + 6.0, 2.0, 0.5);
  outages.add(kDriveBegin + 15.0, 100.0, 100.0);  // between two
  outages.add(kDriveBegin + 25.0, 4.0, 7.0);
  const OutageScore score = outage_score(outages.windows());
  EXPECT_EQ(score.count, 2U);  // the third has no truth in it
  EXPECT_DOUBLE_EQ(score.horizontal_rms_of_max_m, std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(score.vertical_rms_of_max_m, 5.0);
  EXPECT_DOUBLE_EQ(score.horizontal_mean_of_max_m, 3.5);
  EXPECT_TRUE(std::isnan(outage_score({}).horizontal_rms_of_max_m));
}

TEST(Outages, TextsThatAreNoPlan) {
  EXPECT_TRUE(parse_outage_plan("30,75,150", "--outage").ok());
  for (const char* text : {"30,75", "30,75,150,1", "0,75,150", "75,30,0", "30,75,-1", "a,b,c", "nan,1,1"})
    EXPECT_EQ(parse_outage_plan(text, "--outage").error().str(),
              std::string("--outage: \"") + text + "\", expected LENGTH,EVERY,FIRST in seconds, EVERY at least LENGTH");
}

}  // namespace
}  // namespace canyon::study
