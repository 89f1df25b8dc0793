#include "canyon/mission/recorder/epoch_files.h"

#include <gtest/gtest.h>

namespace canyon::mission {
namespace {

/// The last three columns of epochs/RUN_gnss.csv: accepted, nis, reason.
std::string filter_columns(const GnssRow& row) {
  CsvWriter csv(kGnssColumns);
  const GpsTime start = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
  write(csv, row, {.frame = LocalFrame(Geodetic{0.56, -1.58, 60.0}), .start = start});
  const std::string text = csv.text().substr(0, csv.text().size() - 1);
  return text.substr(text.rfind(',', text.rfind(',', text.rfind(',') - 1) - 1) + 1);
}

/// A fix, and what the filter made of it.
GnssRow fix_with(bool accepted, double nis, int dimension) {
  GnssRow row;
  row.fix.status = FixStatus::kSingle;
  row.fix.p_A_E = {6.4e6, 0.0, 0.0};
  row.fix.covariance_E.setIdentity();
  row.update.accepted = accepted;
  row.update.nis = nis;
  row.update.dimension = dimension;
  return row;
}

// 2026-11-23: a fix that restarted the filter had no NIS, and nothing in its row said why.
TEST(EpochFiles, AnEmptyNisHasItsReason) {
  EXPECT_EQ(filter_columns(fix_with(true, 2.5, 3)), "1,2.5000,");
  EXPECT_EQ(filter_columns(fix_with(false, 99.0, 3)), "0,99.0000,");
  EXPECT_EQ(filter_columns(fix_with(true, 0.0, 0)), "1,,filter restarted");
  GnssRow withheld = fix_with(false, 0.0, 0);
  withheld.withheld = true;
  EXPECT_EQ(filter_columns(withheld), "0,,withheld");
  GnssRow none;
  none.fix.reason = "3 satellites, needed 4";
  EXPECT_EQ(filter_columns(none), "0,,3 satellites; needed 4");
}

}  // namespace
}  // namespace canyon::mission
