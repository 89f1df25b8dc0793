#include "canyon/report/maps/raster_map.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/report/draw/sky_plot.h"

namespace canyon::report {
namespace {

using ::testing::HasSubstr;

Grid small_grid() {
  Grid grid;
  grid.columns = 2;
  grid.rows = 2;
  grid.cell_m = 50.0;
  grid.values = {0.1, 0.5, 3.0, std::nan("")};
  return grid;
}

TEST(RasterMap, LegendNamesEveryClassAndTheUnit) {
  const Grid grid = small_grid();
  const std::string svg = raster_svg({"Error <b>", "when & where", "m", &grid, {0.5, 2}, false});
  EXPECT_THAT(svg, HasSubstr("below 0.5 m"));
  EXPECT_THAT(svg, HasSubstr("0.5 to 2 m"));
  EXPECT_THAT(svg, HasSubstr("2 m and more"));
  EXPECT_THAT(svg, HasSubstr("Error &lt;b&gt;"));
  EXPECT_THAT(svg, HasSubstr("when &amp; where"));
  EXPECT_THAT(svg, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(svg, HasSubstr("20"));  // a fifth of 100 m
}

TEST(RasterMap, PictureHasOnePixelACell) {
  const Grid grid = small_grid();
  const std::string png = raster_png({"t", "s", "", &grid, {0.5, 2}, false});
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\0\2\0\0\0\2", 8));
}

TEST(SkyPlot, ShowsSatellitesAndWhatIsHidden) {
  SkyPlot plot;
  plot.title = "Sky";
  plot.mask_deg = 10.0;
  plot.tracks = {{"G07", {{0.0, 90.0, SkyState::kDirect}, {90.0, 0.0, SkyState::kReflectedOnly}}}};
  const std::string open = sky_plot_svg(plot);
  EXPECT_THAT(open, HasSubstr(">G07</text>"));
  EXPECT_THAT(open, HasSubstr("M320 336L590 336"));  // from the zenith to the horizon in the east
  EXPECT_THAT(open, HasSubstr("stroke-dasharray"));
  plot.blocked = [](int azimuth, int elevation) { return azimuth == 90 && elevation < 30; };
  const std::string hidden = sky_plot_svg(plot);
  EXPECT_GT(hidden.size(), open.size());
  // One wedge for the one hidden column, from the horizon at 270 px to 180 px at 30 degrees.
  EXPECT_THAT(hidden, HasSubstr("M590 336L"));
  EXPECT_THAT(hidden, HasSubstr("L500 336Z"));
}

}  // namespace
}  // namespace canyon::report
