#include "canyon/report/maps/map_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/report/draw/axis.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

/// Lower limits of the classes of building height, m: storeys of about 3 m - houses, low blocks, blocks, towers.
constexpr std::array<double, 5> kHeightEdges_m{8, 15, 25, 40, 60};

std::size_t height_class(double height_m) {
  return static_cast<std::size_t>(std::upper_bound(kHeightEdges_m.begin(), kHeightEdges_m.end(), height_m) -
                                  kHeightEdges_m.begin());
}

}  // namespace

std::string MapDrawing::point(const Eigen::Vector2d& p_W, int decimals) const {
  return fixed(p_W.x() - scene_.min_W.x(), decimals) + " " + fixed(scene_.max_W.y() - p_W.y(), decimals);
}

std::string MapDrawing::path(std::span<const Eigen::Vector2d> points_W, int decimals) const {
  std::string out;
  for (const Eigen::Vector2d& p : points_W) {
    if (p.allFinite()) out += (out.empty() ? "M" : " ") + point(p, decimals);
  }
  return out;
}

std::string MapDrawing::definitions(const std::vector<std::string>& of_interest) const {
  // One path per class of street width, of height and of tree size: few nodes, however large the city.
  std::string streets, trees, vehicles, outlines, interest;
  std::array<std::string, kHeightEdges_m.size() + 1> heights;
  for (const Street& s : scene_.streets) {
    streets += "<path d=\"M" + point(s.a_W) + " " + point(s.b_W) + "\" stroke-width=\"" +
               fixed(std::max(s.width_m, 0.0), 1) + "\"/>";
  }
  for (const Building& b : scene_.buildings) {
    if (b.footprint_W.size() < 3) continue;
    const std::string outline = path(b.footprint_W) + "Z";
    heights[height_class(b.height_m)] += outline;
    outlines += outline;
    if (!b.name.empty() && std::find(of_interest.begin(), of_interest.end(), b.name) != of_interest.end())
      interest += outline;
  }
  for (const Tree& t : scene_.trees) {
    const std::string r = fixed(std::max(t.radius_m, 0.1), 1), d = fixed(2 * std::max(t.radius_m, 0.1), 1);
    trees += "M" + point(t.p_W - Eigen::Vector2d(t.radius_m, 0)) + "a" + r + " " + r + " 0 1 0 " + d + " 0a" + r + " " +
             r + " 0 1 0 -" + d + " 0";
  }
  for (const Eigen::Vector2d& v : scene_.vehicles) vehicles += "M" + point(v) + "h0";

  std::string out =
      "<svg class=\"defs\" width=\"0\" height=\"0\" aria-hidden=\"true\" focusable=\"false\"><defs>\n<g "
      "id=\"scene\"><g class=\"streets\">" +
      streets + "</g>";
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (!heights[i].empty()) out += "<path class=\"building h" + std::to_string(i) + "\" d=\"" + heights[i] + "\"/>";
  }
  if (!interest.empty()) out += "<path class=\"interest\" d=\"" + interest + "\"/>";
  if (!trees.empty()) out += "<path class=\"trees\" d=\"" + trees + "\"/>";
  if (!vehicles.empty()) out += "<path class=\"vehicles\" d=\"" + vehicles + "\"/>";
  return out + "</g>\n<path id=\"outlines\" class=\"outlines\" d=\"" + outlines + "\"/>\n</defs></svg>\n";
}

std::string MapDrawing::window(const MapWindow& window, std::string_view ground, std::string_view id,
                               std::string_view title, std::string_view description, const std::string& svg,
                               const std::string& html) const {
  const Eigen::Vector2d size_m = window.size_m();
  const Eigen::Vector2d corner(window.min_W.x(), window.max_W.y());
  const std::string name(id);
  return "<div class=\"map\" id=\"" + name + "\" style=\"aspect-ratio:" + fixed(size_m.x(), 2) + "/" +
         fixed(size_m.y(), 2) + "\">\n<svg viewBox=\"" + point(corner, 2) + " " + fixed(size_m.x(), 2) + " " +
         fixed(size_m.y(), 2) + "\" role=\"img\" aria-labelledby=\"" + name + "-t " + name + "-d\"><title id=\"" +
         name + "-t\">" + escape_html(title) + "</title><desc id=\"" + name + "-d\">" + escape_html(description) +
         "</desc>\n<use href=\"#" + std::string(ground) + "\"/>\n" + svg + "</svg>\n" + html + scale_and_north(window) +
         "</div>\n";
}

std::string MapDrawing::place(const MapWindow& window, const Eigen::Vector2d& p_W) {
  const Eigen::Vector2d size_m = window.size_m();
  return "left:" + fixed(100 * (p_W.x() - window.min_W.x()) / size_m.x(), 2) +
         "%;top:" + fixed(100 * (window.max_W.y() - p_W.y()) / size_m.y(), 2) + "%";
}

std::string MapDrawing::height_legend() const {
  std::string out = "<p class=\"legend\"><span class=\"legend-title\">building height, m</span>";
  for (std::size_t i = 0; i <= kHeightEdges_m.size(); ++i) {
    const std::string text = i == 0 ? "below " + fixed(kHeightEdges_m[0], 0)
                             : i == kHeightEdges_m.size()
                                 ? "from " + fixed(kHeightEdges_m.back(), 0)
                                 : fixed(kHeightEdges_m[i - 1], 0) + "\xE2\x80\x93" + fixed(kHeightEdges_m[i], 0);
    out +=
        "<span class=\"key\"><svg class=\"chip\" viewBox=\"0 0 12 12\" aria-hidden=\"true\"><path class=\"building h" +
        std::to_string(i) + "\" d=\"M0 0H12V12H0Z\"/></svg>" + text + "</span>";
  }
  return out + "</p>\n";
}

std::string scale_and_north(const MapWindow& window) {
  const double length_m = nice_step(window.size_m().x() / 4, 1);
  const double shown_m = length_m > 0.3 * window.size_m().x() ? length_m / 2 : length_m;
  return "<div class=\"scalebar\" aria-hidden=\"true\" style=\"width:" + fixed(100 * shown_m / window.size_m().x(), 2) +
         "%\"><span>" + fixed(shown_m, 3) + "\xC2\xA0m" +
         "</span></div>\n<svg class=\"north\" viewBox=\"0 0 20 34\" aria-label=\"north is up\" role=\"img\"><path "
         "d=\"M10 1L17 20 10 15 3 20Z\"/>"
         "<path class=\"letter\" d=\"M6 33V24L14 33V24\"/></svg>\n";
}

}  // namespace canyon::report
