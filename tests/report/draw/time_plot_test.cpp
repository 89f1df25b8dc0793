#include "canyon/report/draw/time_plot.h"

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
  const std::string begin = "<path d=\"", colour = "\" stroke=\"#";
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
    const std::size_t from = at + begin.size(), to = svg.find('"', from);
    if (svg.compare(to, colour.size(), colour) != 0) continue;
    const std::size_t digits = to + colour.size();  // the grids' have small letters
    if (svg.find_first_not_of("0123456789ABCDEF", digits) == digits + 6) out.push_back(svg.substr(from, to - from));
  }
  return out;
}

// The plot is 780 wide from x = 96 and each panel 180 high, the first from y = 56: 0 to 10 s over 0 to 100.
TEST(TimePlot, DrawsAtTheRightPlaces) {
  const std::string svg = time_plot_svg("mine", {{"speed", "m/s", {{"x", {0, 5, 10}, {0, 100, 50}}}}});
  const auto curves = curves_of(svg);
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_EQ(curves[0], "M96 236L486 56L876 146");
  EXPECT_THAT(svg, HasSubstr("speed, m/s"));
  EXPECT_THAT(svg, HasSubstr("<title>mine</title>"));
}

TEST(TimePlot, PanelsShareTheTimeAxis) {
  const std::string svg = time_plot_svg(
      "two", {{"a", "", {{"x", {0, 10}, {0, 1}}}}, {"b", "", {{"x", {5, 10}, {0, 1}}, {"y", {0, 10}, {1, 1}}}}});
  const auto curves = curves_of(svg);
  ASSERT_EQ(curves.size(), 3U);
  // Drawn from the last curve of a panel on, so that the legend is laid out from the right.
  EXPECT_THAT(curves[2], ::testing::StartsWith("M486 ")) << "half way: the second panel begins at 5 of 10 s";
}

TEST(TimePlot, NanCutsTheLine) {
  const auto curves = curves_of(time_plot_svg("cut", {{"a", "", {{"x", {0, 1, 2, 3, 4}, {0, 1, NAN, 1, 0}}}}}));
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_EQ(std::count(curves[0].begin(), curves[0].end(), 'M'), 2);
  EXPECT_THAT(curves[0], Not(HasSubstr("nan")));
}

// A spike of one sample in a hundred thousand is still there after thinning out.
TEST(TimePlot, LongSeriesKeepTheirExtremes) {
  std::vector<double> t(100000), y(t.size(), 0.0);
  for (std::size_t k = 0; k < t.size(); ++k) t[k] = 0.01 * static_cast<double>(k);
  y[77777] = 100.0;
  const std::string svg = time_plot_svg("long", {{"a", "", {{"x", t, y}}}});
  const auto curves = curves_of(svg);
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_LT(curves[0].size(), 100000U);
  EXPECT_THAT(curves[0], HasSubstr("L702.7 56L")) << "the top of the panel";
}

TEST(TimePlot, NothingToDrawIsAnEmptyPlot) {
  for (const auto& panels : {std::vector<TimePanel>{}, {{"empty", "", {}}}, {{"empty", "m", {{"x", {}, {}}}}}}) {
    const std::string svg = time_plot_svg("a < b & c", panels);
    EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, ::testing::EndsWith("</svg>\n"));
  }
}

}  // namespace
}  // namespace canyon::report
