#include "canyon/report/draw/deviation_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/report/draw/format.h"

namespace canyon::report {
namespace {

constexpr double kPanelWidth = 480, kPanelHeight = 400, kLeft = 76, kTop = 106, kGap = 96;
// Okabe & Ito (2008).
constexpr std::array<const char*, 3> kColours = {"#0072B2", "#D55E00", "#009E73"};

/// "10⁻³".
std::string power_of_ten(int exponent) {
  static const std::array<const char*, 10> kDigits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) out += kDigits[static_cast<std::size_t>(digit - '0')];
  return out;
}

/// Whole decades around the finite values above zero.
struct Decades {
  int first = 0, last = 1;
  double place(double value) const { return (std::log10(value) - first) / (last - first); }
};
Decades decades_of(const std::vector<const std::vector<double>*>& all) {
  double least = 1e300, most = 0.0;
  for (const auto* values : all)
    for (const double v : *values)
      if (std::isfinite(v) && v > 0.0) least = std::min(least, v), most = std::max(most, v);
  if (most == 0.0) return {};
  Decades d{static_cast<int>(std::floor(std::log10(least))), static_cast<int>(std::ceil(std::log10(most)))};
  if (d.last == d.first) ++d.last;
  return d;
}

class PanelWriter {
 public:
  PanelWriter(const DeviationPanel& panel, double left) : panel_(panel), left_(left) {
    std::vector<const std::vector<double>*> x, y;
    for (const DeviationCurve& c : panel.curves) {
      x.push_back(&c.tau_s);
      for (const auto* values : {&c.deviation, &c.low, &c.high}) y.push_back(values);
    }
    x_ = decades_of(x);
    y_ = decades_of(y);
  }

  std::string write() {
    frame();
    for (std::size_t i = 0; i < panel_.curves.size(); ++i) curve(panel_.curves[i], kColours[i % kColours.size()]);
    legend();
    return out_;
  }

 private:
  std::string x_px(double v) const { return fixed(left_ + kPanelWidth * x_.place(v), 1); }
  std::string y_px(double v) const { return fixed(kTop + kPanelHeight * (1.0 - std::clamp(y_.place(v), 0.0, 1.0)), 1); }

  void frame() {
    const std::string right = fixed(left_ + kPanelWidth, 1), bottom = fixed(kTop + kPanelHeight, 1);
    out_ += "<text x=\"" + fixed(left_, 1) + "\" y=\"" + fixed(kTop - 14, 1) + "\" class=\"h\">" +
            escape_html(panel_.title) + "<tspan class=\"u\">, " + escape_html(panel_.unit) + "</tspan></text>\n";
    for (int d = x_.first; d <= x_.last; ++d) {
      for (int k = 1; k < 10 && (k == 1 || d < x_.last); ++k) {
        const std::string x = x_px(k * std::pow(10.0, d));
        out_ += "<path class=\"" + std::string(k == 1 ? "g" : "m") + "\" d=\"M" + x + " " + fixed(kTop, 1) + "V" +
                bottom + "\"/>";
      }
      out_ += "<text x=\"" + x_px(std::pow(10.0, d)) + "\" y=\"" + fixed(kTop + kPanelHeight + 20, 1) +
              "\" text-anchor=\"middle\">" + power_of_ten(d) + "</text>\n";
    }
    for (int d = y_.first; d <= y_.last; ++d) {
      for (int k = 1; k < 10 && (k == 1 || d < y_.last); ++k) {
        const std::string y = y_px(k * std::pow(10.0, d));
        out_ += "<path class=\"" + std::string(k == 1 ? "g" : "m") + "\" d=\"M" + fixed(left_, 1) + " " + y + "H" +
                right + "\"/>";
      }
      out_ += "<text x=\"" + fixed(left_ - 8, 1) + "\" y=\"" + y_px(std::pow(10.0, d)) +
              "\" dy=\"5\" text-anchor=\"end\">" + power_of_ten(d) + "</text>\n";
    }
    out_ += "<text x=\"" + fixed(left_ + kPanelWidth / 2, 1) + "\" y=\"" + fixed(kTop + kPanelHeight + 42, 1) +
            "\" text-anchor=\"middle\" class=\"u\">averaging time, s</text>\n";
  }

  void curve(const DeviationCurve& c, const char* colour) {
    std::string forth, back, dots, line;
    for (std::size_t i = 0; i < c.tau_s.size(); ++i) {
      if (!(c.deviation[i] > 0.0)) continue;
      const std::string x = x_px(c.tau_s[i]);
      forth += x + " " + y_px(c.high[i]) + " ";
      back.insert(0, x + " " + y_px(c.low[i]) + " ");
      dots += "<circle cx=\"" + x + "\" cy=\"" + y_px(c.deviation[i]) + "\" r=\"2.6\"/>";
      if (!c.fit.empty() && c.fit[i] > 0.0) line += (line.empty() ? "M" : "L") + x + " " + y_px(c.fit[i]);
    }
    out_ += "<g fill=\"" + std::string(colour) + "\"><title>" + escape_html(c.name) + "</title><path d=\"M" + forth +
            back + "Z\" opacity=\"0.2\"/>" + dots + "<path d=\"" + line + "\" fill=\"none\" stroke=\"" + colour +
            "\" stroke-width=\"1.3\"/></g>\n";
  }

  void legend() {
    for (std::size_t i = 0; i < panel_.curves.size(); ++i)
      out_ += "<text x=\"" + fixed(left_ + kPanelWidth - 14, 1) + "\" y=\"" +
              fixed(kTop + 26 + 20 * static_cast<double>(i), 1) +
              "\" text-anchor=\"end\" class=\"k\" style=\"fill:" + kColours[i % kColours.size()] + "\">● " +
              escape_html(panel_.curves[i].name) + "</text>\n";
  }

  const DeviationPanel& panel_;
  double left_;
  Decades x_, y_;
  std::string out_;
};

}  // namespace

std::string deviation_plot_svg(const std::string& title, const std::string& subtitle,
                               const std::vector<DeviationPanel>& panels) {
  const double width = kLeft + static_cast<double>(panels.size()) * (kPanelWidth + kGap) - kGap + 24;
  const double height = kTop + kPanelHeight + 60;
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + fixed(width, 0) + " " +
                    fixed(height, 0) + "\" width=\"" + fixed(width, 0) + "\" height=\"" + fixed(height, 0) + "\">\n";
  out +=
      "<style>text{font:14px system-ui,sans-serif;fill:#333}.t{font-size:19px;font-weight:600;fill:#111}.h{font-size:"
      "16px;font-weight:600;fill:#111}.u{fill:#666;font-weight:400}.k{font-weight:600}"
      ".g{stroke:#c8c8c8}.m{stroke:#eee}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  out += "<text x=\"24\" y=\"32\" class=\"t\">" + escape_html(title) + "</text>\n<text x=\"24\" y=\"54\" class=\"u\">" +
         escape_html(subtitle) + "</text>\n";
  for (std::size_t i = 0; i < panels.size(); ++i)
    out += PanelWriter(panels[i], kLeft + static_cast<double>(i) * (kPanelWidth + kGap)).write();
  return out + "</svg>\n";
}

}  // namespace canyon::report
