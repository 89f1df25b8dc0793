#include "canyon/mission/recorder/csv_writer.h"

#include <limits>

#include <gtest/gtest.h>

namespace canyon::mission {
namespace {

std::string row_of(double value) {
  CsvWriter csv("x");
  csv.number(value, 3);
  return csv.text().substr(2);
}

TEST(CsvWriter, NumbersHaveTheirDecimals) {
  EXPECT_EQ(row_of(-0.0625), "-0.062");  // exactly between two: to even
  EXPECT_EQ(row_of(1e9), "1000000000.000");
  EXPECT_EQ(row_of(std::numeric_limits<double>::infinity()), "");
}

// 2026-11-22: bytes that nobody had written stood in the file.
TEST(CsvWriter, AHugeNumberHasAPowerOfTen) {
  EXPECT_EQ(row_of(-1e100), "-1e+100");
  EXPECT_EQ(row_of(std::numeric_limits<double>::max()), "1.7976931348623157e+308");
}

}  // namespace
}  // namespace canyon::mission
