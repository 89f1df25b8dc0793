#include "canyon/gnss/single_point/receiver_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/files.h"
#include "canyon/gnss/nmea/nmea_writer.h"
#include "canyon/gnss/nmea/sentence.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::gnss {
namespace {

const GpsTime kStart = GpsTime::from_calendar(2010, 7, 1, 13, 0, 15.0);  // UTC is 15 s behind: 13:00:00
const Geodetic kPlace{0.6, 0.2, 100.0};

/// Ten fixes, one a second.
std::vector<GnssFix> fixes() {
  std::vector<GnssFix> out(10);
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].t = kStart + static_cast<double>(k);
    out[k].status = FixStatus::kSingle;
    out[k].p_A_E = ecef_from_geodetic(kPlace);
    out[k].satellites = 8;
  }
  return out;
}

Result<ReceiverComparison> compare(const std::vector<GnssFix>& fixes, const std::string& path) {
  CANYON_TRY(const ReceiverLog log, read_receiver_log(path, fixes.front().t));
  return compare_with_receiver(fixes, log);
}

class ReceiverComparisonTest : public ::testing::Test {
 protected:
  std::string path_ = canyon::testing::temporary_file("log.nmea");
  /// What a receiver says that is `off_enu_m` from where we are, its clock `late_s` off.
  void write_log(const std::vector<GnssFix>& of, const Eigen::Vector3d& off_enu_m, double late_s = 0.0) {
    std::string text;
    for (GnssFix fix : of) {
      fix.p_A_E += rotation_E_from_enu(kPlace) * off_enu_m;
      fix.t = fix.t + late_s;
      text += nmea_text({.fix = fix, .undulation_m = 30.0, .satellites = {}});
    }
    ASSERT_TRUE(write_text_file(path_, text).ok());
  }
};

// Seven decimals of a minute are 0.2 mm, the height is to 1 mm: 0.6 mm in any axis.
TEST_F(ReceiverComparisonTest, IsOursMinusItsOwn) {
  for (const double late_s : {0.0, 0.04, -0.04}) {
    write_log(fixes(), {3.0, -4.0, 1.5}, late_s);
    const auto c = compare(fixes(), path_);
    ASSERT_TRUE(c.ok()) << c.error().str();
    EXPECT_EQ(c->records, 10);
    EXPECT_EQ(c->difference.compared, 10);
    EXPECT_LT((c->difference.mean_enu_m - Eigen::Vector3d(-3.0, 4.0, -1.5)).cwiseAbs().maxCoeff(), 6e-4);
    EXPECT_LT(c->difference.std_enu_m.maxCoeff(), 6e-4);
    EXPECT_NEAR(c->difference.h50_m, 5.0, 6e-4);
    EXPECT_NEAR(c->difference.h95_m, 5.0, 6e-4);
  }
}

TEST_F(ReceiverComparisonTest, OnlyEpochsOfBothCount) {
  std::vector<GnssFix> ours = fixes(), theirs = fixes();
  ours[2].status = FixStatus::kNone;
  theirs[5].status = FixStatus::kNone;
  theirs.erase(theirs.begin() + 7);
  write_log(theirs, {1.0, 0.0, 0.0});
  const auto c = compare(ours, path_);
  ASSERT_TRUE(c.ok());
  EXPECT_EQ(c->records, 8);
  EXPECT_EQ(c->difference.epochs, 10);
  EXPECT_EQ(c->difference.solved, 9);
  EXPECT_EQ(c->difference.compared, 7);
}

// GGA alone carries no date: that of the observations counts, in UTC.
TEST_F(ReceiverComparisonTest, ALogWithoutADateIsOfTheDayOfTheObservations) {
  ASSERT_TRUE(
      write_text_file(path_, nmea_sentence("GPGGA,130003.00,3422.6480625,N,01127.5493542,E,1,08,1.0,70.0,M,30.0,M,,"))
          .ok());
  const auto c = compare(fixes(), path_);
  ASSERT_TRUE(c.ok()) << c.error().str();
  EXPECT_EQ(c->difference.compared, 1);
  EXPECT_LT(c->difference.rms_3d_m, 1e-3);  // the sentence is 0.6 rad north, 0.2 rad east, to 0.2 mm
}

TEST_F(ReceiverComparisonTest, MistakesWordForWord) {
  write_log(fixes(), Eigen::Vector3d::Zero(), 3600.0);
  EXPECT_EQ(compare(fixes(), path_).error().str(),
            path_ +
                ": covers 2010-07-01T14:00:15.000 to 2010-07-01T14:00:24.000 GPS time, expected epochs of the "
                "observations, 2010-07-01T13:00:15.000 to 2010-07-01T13:00:24.000");
  std::vector<GnssFix> none = fixes();
  for (GnssFix& fix : none) fix.status = FixStatus::kNone;
  write_log(none, Eigen::Vector3d::Zero());
  EXPECT_EQ(compare(fixes(), path_).error().str(), path_ + ": holds no GGA with a fix, expected a log with fixes");
  // RMC has a place too, but no height: it is not taken.
  ASSERT_TRUE(
      write_text_file(path_, nmea_sentence("GPRMC,130003.00,A,3422.6480625,N,01127.5493542,E,0.0,0.0,010710,,,A"))
          .ok());
  EXPECT_EQ(compare(fixes(), path_).error().str(), path_ + ": holds no GGA with a fix, expected a log with fixes");
  ASSERT_TRUE(write_text_file(path_, "something else\n").ok());
  EXPECT_EQ(compare(fixes(), path_).error().str(), path_ + ": no GGA or RMC sentence in it, expected an NMEA 0183 log");
  EXPECT_FALSE(compare(fixes(), "no_such.nmea").ok());
}

}  // namespace
}  // namespace canyon::gnss
