#include "canyon/report/draw/picture.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace canyon::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The d attributes of the curves, without the grids'.
std::vector<std::string> curves_of(const std::string& svg) {
  std::vector<std::string> out;
  // By hand: std::regex takes a stack as deep as the curve is long.
  const std::string begin = "<path class=\"line\"", d = " d=\"";
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
    const std::size_t from = svg.find(d, at) + d.size();
    out.push_back(svg.substr(from, svg.find('"', from) - from));
  }
  return out;
}

Line line(std::string name, std::vector<double> x, std::vector<double> y) {
  return {.name = std::move(name), .x = std::move(x), .y = std::move(y)};
}

std::string time_svg(const std::string& title, std::vector<Panel> panels) {
  return picture_svg(time_picture(title, std::move(panels)));
}

// The plot is 780 wide from x = 96 and each panel 180 high, the first from y = 56: 0 to 10 s over 0 to 100.
TEST(Picture, DrawsAtTheRightPlaces) {
  const std::string svg =
      time_svg("mine", {{.title = "speed", .unit = "m/s", .lines = {line("x", {0, 5, 10}, {0, 100, 50})}}});
  const auto curves = curves_of(svg);
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_EQ(curves[0], "M96 236 486 56 876 146");
  EXPECT_THAT(svg, HasSubstr("speed, m/s"));
  EXPECT_THAT(svg, HasSubstr("<title>mine</title>"));
}

TEST(Picture, PanelsShareTheTimeAxis) {
  const std::string svg =
      time_svg("two", {{.title = "a", .lines = {line("x", {0, 10}, {0, 1})}},
                       {.title = "b", .lines = {line("x", {5, 10}, {0, 1}), line("y", {0, 10}, {1, 1})}}});
  const auto curves = curves_of(svg);
  ASSERT_EQ(curves.size(), 3U);
  // Drawn from the last curve of a panel on, so that the legend is laid out from the right.
  EXPECT_THAT(curves[2], ::testing::StartsWith("M486 ")) << "half way: the second panel begins at 5 of 10 s";
}

TEST(Picture, NanCutsTheLine) {
  const auto curves =
      curves_of(time_svg("cut", {{.title = "a", .lines = {line("x", {0, 1, 2, 3, 4}, {0, 1, NAN, 1, 0})}}}));
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_EQ(std::count(curves[0].begin(), curves[0].end(), 'M'), 2);
  EXPECT_THAT(curves[0], Not(HasSubstr("nan")));
}

// A spike of one sample in a hundred thousand is still there after thinning out.
TEST(Picture, LongSeriesKeepTheirExtremes) {
  std::vector<double> t(100000), y(t.size(), 0.0);
  for (std::size_t k = 0; k < t.size(); ++k) t[k] = 0.01 * static_cast<double>(k);
  y[77777] = 100.0;
  const std::string svg = time_svg("long", {{.title = "a", .lines = {line("x", t, y)}}});
  const auto curves = curves_of(svg);
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_LT(curves[0].size(), 100000U);
  EXPECT_THAT(curves[0], HasSubstr(" 702.7 56 ")) << "the top of the panel";
}

TEST(Picture, NothingToDrawIsAnEmptyPlot) {
  for (const auto& panels :
       {std::vector<Panel>{}, {{.title = "empty"}}, {{.title = "empty", .lines = {line("x", {}, {})}}}}) {
    const std::string svg = time_svg("a < b & c", panels);
    EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, ::testing::EndsWith("</svg>\n"));
  }
}

// Side by side the panels are 480 wide and 400 high from (96, 84), with a subtitle; both axes go over two decades: 1 to
// 100 s, 0.1 to 10.
TEST(Picture, DeviationsOverWholeDecades) {
  Panel panel{.title = "Gyroscope", .unit = "x"};
  panel.lines = {line("gx", {1, 10, 100}, {10, 1, 0.5}), line("", {1, 100}, {10, 0.5})};
  panel.lines[0].style = Line::Style::kPoints;
  panel.bands = {{.x = {1, 100}, .low = {9, 0.1}, .high = {10, 10}}};
  const std::string svg = picture_svg(deviation_picture("mine", "of all", {panel}));
  const auto curves = curves_of(svg);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[1], "M96 84h0 M336 284h0 M576 344.21h0");  // log10(0.5) = -0.30103
  EXPECT_EQ(curves[0], "M96 84 576 344.21");
  EXPECT_THAT(svg, HasSubstr("M96 84 576 84 576 484 96 93.2 Z"));  // log10(9) = 0.9542
  EXPECT_THAT(svg, HasSubstr("10⁻¹"));
  EXPECT_THAT(svg, HasSubstr(">of all<"));
}

}  // namespace
}  // namespace canyon::report
