#include "canyon/report/draw/sky_plot.h"

#include <array>
#include <cmath>

#include "canyon/report/format.h"

namespace canyon::report {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kCentre = 320.0, kRadius = 270.0, kTop = 56.0;

struct StateLook {
  SkyState state;
  const char* colour;
  const char* word;
};
// Okabe & Ito (2008); not tracked is hollow besides.
constexpr std::array<StateLook, 4> kLooks = {
    {{SkyState::kDirect, "#0072B2", "direct"},
     {SkyState::kDirectAndReflected, "#009E73", "direct and reflected"},
     {SkyState::kReflectedOnly, "#D55E00", "by reflection or diffraction only"},
     {SkyState::kNotTracked, "#8a8a8a", "not tracked"}}};

const StateLook& look(SkyState state) {
  return kLooks[static_cast<std::size_t>(state)];
}

struct Xy {
  double x, y;
};

Xy place(double azimuth_deg, double elevation_deg) {
  const double r = kRadius * (90.0 - elevation_deg) / 90.0, a = azimuth_deg * kPi / 180.0;
  return {kCentre + r * std::sin(a), kTop + kCentre - 40.0 - r * std::cos(a)};
}

std::string xy(double azimuth_deg, double elevation_deg) {
  const Xy p = place(azimuth_deg, elevation_deg);
  return fixed(p.x, 1) + " " + fixed(p.y, 1);
}

/// Hidden cells, merged along each degree of azimuth.
std::string hidden(const SkyPlot& plot) {
  if (!plot.blocked) return {};
  std::string path;
  for (int azimuth = 0; azimuth < 360; ++azimuth) {
    for (int low = 0; low < 90;) {
      if (!plot.blocked(azimuth, low)) {
        ++low;
        continue;
      }
      int high = low;
      while (high < 90 && plot.blocked(azimuth, high)) ++high;
      // A little over the edge, so that no hairline shows between neighbours.
      path += "M" + xy(azimuth, low) + "L" + xy(azimuth + 1.15, low) + "L" + xy(azimuth + 1.15, high) + "L" +
              xy(azimuth, high) + "Z";
      low = high;
    }
  }
  return "<path d=\"" + path + "\" fill=\"#c9c4bb\"/>\n";
}

std::string grid(const SkyPlot& plot) {
  const Xy centre = place(0, 90);
  std::string out;
  const auto circle = [&](double elevation, const char* style) {
    out += "<circle cx=\"" + fixed(centre.x, 1) + "\" cy=\"" + fixed(centre.y, 1) + "\" r=\"" +
           fixed(kRadius * (90.0 - elevation) / 90.0, 1) + "\" fill=\"none\" " + style + "/>\n";
  };
  for (const int elevation : {0, 30, 60}) circle(elevation, "stroke=\"#777\" stroke-width=\"0.7\"");
  if (plot.mask_deg > 0.0) circle(plot.mask_deg, "stroke=\"#777\" stroke-width=\"1\" stroke-dasharray=\"3 4\"");
  for (int azimuth = 0; azimuth < 180; azimuth += 30)
    out += "<path d=\"M" + xy(azimuth, 0) + "L" + xy(azimuth + 180.0, 0) +
           "\" stroke=\"#777\" stroke-width=\"0.4\" fill=\"none\"/>\n";
  const char* names[] = {"N", "30°", "60°", "E", "120°", "150°", "S", "210°", "240°", "W", "300°", "330°"};
  for (int k = 0; k < 12; ++k) {
    const Xy p = place(30.0 * k, -5.0);
    out += "<text x=\"" + fixed(p.x, 1) + "\" y=\"" + fixed(p.y + 4.5, 1) + "\" text-anchor=\"middle\"" +
           (k % 3 == 0 ? " font-weight=\"600\"" : " fill=\"#555\" font-size=\"11\"") + ">" + names[k] + "</text>\n";
  }
  for (const int elevation : {30, 60}) {
    const Xy p = place(8.0, elevation);
    out += "<text x=\"" + fixed(p.x, 1) + "\" y=\"" + fixed(p.y - 3.0, 1) + "\" fill=\"#555\" font-size=\"11\">" +
           std::to_string(elevation) + "°</text>\n";
  }
  return out;
}

std::string track(const SkyTrack& t) {
  if (t.points.empty()) return {};
  std::string out;
  // One stroke per stretch of equal state.
  for (std::size_t begin = 0; begin + 1 < t.points.size();) {
    std::size_t end = begin + 1;
    while (end + 1 < t.points.size() && t.points[end].state == t.points[begin].state) ++end;
    std::string path;
    for (std::size_t i = begin; i <= end; ++i)
      path += (i == begin ? "M" : "L") + xy(t.points[i].azimuth_deg, t.points[i].elevation_deg);
    out += "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + look(t.points[begin].state).colour +
           "\" stroke-width=\"2.2\" stroke-linejoin=\"round\"/>\n";
    begin = end;
  }
  const SkyPoint& first = t.points.front();
  const Xy p = place(first.azimuth_deg, first.elevation_deg);
  const bool hollow = first.state == SkyState::kNotTracked;
  out += "<circle cx=\"" + fixed(p.x, 1) + "\" cy=\"" + fixed(p.y, 1) + "\" r=\"6\" fill=\"" +
         (hollow ? "#fff" : look(first.state).colour) + "\" stroke=\"" + look(first.state).colour +
         "\" stroke-width=\"2\"/>\n";
  const bool left = p.x > kCentre + 0.8 * kRadius;
  out += "<text x=\"" + fixed(p.x + (left ? -10.0 : 10.0), 1) + "\" y=\"" + fixed(p.y + 4.0, 1) +
         "\" font-size=\"12\" paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"3\" text-anchor=\"" +
         (left ? "end" : "start") + "\">" + escape_html(t.name) + "</text>\n";
  return out;
}

std::string legend() {
  std::string out;
  double x = 22.0;
  for (const StateLook& l : kLooks) {
    out += "<circle cx=\"" + fixed(x, 0) + "\" cy=\"656\" r=\"5\" fill=\"" +
           (l.state == SkyState::kNotTracked ? "#fff" : l.colour) + "\" stroke=\"" + l.colour +
           "\" stroke-width=\"2\"/><text x=\"" + fixed(x + 10.0, 0) + "\" y=\"660\" font-size=\"12\">" + l.word +
           "</text>\n";
    x += 26.0 + 5.9 * static_cast<double>(std::string(l.word).size());
  }
  out += "<rect x=\"" + fixed(x - 6.0, 0) + "\" y=\"650\" width=\"12\" height=\"12\" fill=\"#c9c4bb\"/><text x=\"" +
         fixed(x + 12.0, 0) + "\" y=\"660\" font-size=\"12\">hidden</text>\n";
  return out;
}

}  // namespace

std::string sky_plot_svg(const SkyPlot& plot) {
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 676\" width=\"640\" height=\"676\" "
      "font-family=\"system-ui, sans-serif\" font-size=\"14\" role=\"img\">\n<title>" +
      escape_html(plot.title) + "</title>\n<rect width=\"640\" height=\"676\" fill=\"#fff\"/>\n";
  out += "<text x=\"20\" y=\"24\" font-size=\"16\" font-weight=\"600\">" + escape_html(plot.title) +
         "</text>\n<text x=\"20\" y=\"42\" fill=\"#444\" font-size=\"12\">" + escape_html(plot.subtitle) + "</text>\n";
  out += hidden(plot) + grid(plot);
  for (const SkyTrack& t : plot.tracks) out += track(t);
  return out + legend() + "</svg>\n";
}

}  // namespace canyon::report
