#include "canyon/core/files/ascii_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/units.h"

namespace canyon {
namespace {

TEST(AsciiGrid, NorthernRowFirstAndNoDataForNaN) {
  Grid grid;
  grid.columns = 3;
  grid.rows = 2;
  grid.cell_m = 2.5;
  grid.west_m = -500.0;
  grid.south_m = 100.0;
  grid.values = {1, 2, 3, 4, std::nan(""), 6.125};
  EXPECT_EQ(ascii_grid_text(grid, 2),
            "ncols 3\nnrows 2\nxllcorner -500.000000\nyllcorner 100.000000\ncellsize 2.500000\nNODATA_value -9999\n"
            "4.00 -9999 6.12\n1.00 2.00 3.00\n");
}

TEST(AsciiGrid, ProjectionIsCentredAtTheOrigin) {
  const LocalFrame frame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
  EXPECT_THAT(projection_text(frame), ::testing::HasSubstr("PARAMETER[\"Longitude_Of_Center\",-90.880000000],"
                                                           "PARAMETER[\"Latitude_Of_Center\",32.350000000]"));
}

}  // namespace
}  // namespace canyon
