#include "canyon/report/draw/theme.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "canyon/report/format.h"

namespace canyon::report {
namespace {

struct RunColour {
  const char* light;
  const char* dark;
  const char* dashes;  ///< SVG stroke-dasharray
};

/// The first two runs are the pair compared, the third usually the paper's, the rest the mixed runs of the 2 x 2.
constexpr std::array<RunColour, 6> kRuns{{{"#0067a6", "#5ab8ee", "none"},
                                          {"#cc5200", "#ff9252", "none"},
                                          {"#00805d", "#38d0a2", "6 3"},
                                          {"#9a4a86", "#dd9fca", "2 2.5"},
                                          {"#7a6a00", "#e0cf4f", "8 3 2 3"},
                                          {"#555555", "#b5b5b5", "1 3"}}};

/// Viridis at eight places: from pale to dark on a light page, from muted to bright on a dark one.
constexpr std::size_t kErrorColours = 8;
constexpr std::array<std::uint32_t, kErrorColours> kErrorLight{0xc4d296, 0x9dcb76, 0x58b97a, 0x259e86,
                                                               0x247f8e, 0x375a8c, 0x453781, 0x42023f};
constexpr std::array<std::uint32_t, kErrorColours> kErrorDark{0x433f6e, 0x3d5588, 0x2e6f8e, 0x23888e,
                                                              0x22a785, 0x5ec962, 0xaedc30, 0xfff15c};

std::string hex(std::uint32_t rgb) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out = "#";
  for (int shift = 20; shift >= 0; shift -= 4) out += kDigits[(rgb >> shift) & 15u];
  return out;
}

std::string properties(bool dark) {
  std::string css;
  for (std::size_t i = 0; i < kRuns.size(); ++i) {
    css += "--run" + std::to_string(i) + ":" + (dark ? kRuns[i].dark : kRuns[i].light) + ";";
  }
  for (std::size_t i = 0; i < kErrorColours; ++i) {
    css += "--e" + std::to_string(i) + ":" + hex((dark ? kErrorDark : kErrorLight)[i]) + ";";
  }
  return css;
}

ErrorClasses make_classes(std::vector<double> edges_m) {
  ErrorClasses classes{std::move(edges_m), {}};
  const std::vector<double>& e = classes.edges_m;
  const auto text = [](double v) { return fixed(v, 2); };
  classes.labels.push_back("below " + text(e.front()));
  for (std::size_t i = 1; i < e.size(); ++i) classes.labels.push_back(text(e[i - 1]) + "\xE2\x80\x93" + text(e[i]));
  classes.labels.push_back("from " + text(e.back()));
  return classes;
}

}  // namespace

std::string run_class(std::size_t run) {
  return "r" + std::to_string(run);
}

std::string theme_css(std::size_t runs) {
  std::string css = ":root{" + properties(false) + "}\n@media screen and (prefers-color-scheme:dark){:root{" +
                    properties(true) + "}}\n";
  for (std::size_t i = 0; i < runs; ++i) {
    const std::string k = std::to_string(std::min(i, kRuns.size() - 1));
    const std::string c = run_class(i);
    css += "." + c + "{--c:var(--run" + k + ");--dash:" + kRuns[std::min(i, kRuns.size() - 1)].dashes + "}\n";
    css += "#show-" + c + ":not(:checked)~main ." + c + ":not(.keep){display:none}\n";
    css += "#show-" + c + ":not(:checked)~.runbar ." + c + "{opacity:.45}#show-" + c + ":not(:checked)~.runbar ." + c +
           " .swatch{visibility:hidden}\n";
    css += "#show-" + c + ":focus-visible~.runbar ." + c + "{outline:2px solid currentColor;outline-offset:2px}\n";
  }
  return css;
}

std::size_t ErrorClasses::of(double error_m) const {
  return static_cast<std::size_t>(std::upper_bound(edges_m.begin(), edges_m.end(), error_m) - edges_m.begin());
}

const ErrorClasses& map_error_classes() {
  static const ErrorClasses classes = make_classes({0.02, 0.05, 0.1, 0.2, 0.5, 1, 2});
  return classes;
}

const ErrorClasses& multipath_classes() {
  static const ErrorClasses classes = make_classes({0.1, 0.3, 1, 3, 10, 30});
  return classes;
}

std::string error_colour(std::size_t k, std::size_t n) {
  // Spread over the scale; of a short scale the ends are what must stay.
  const std::size_t i = n < 2 ? 0 : (k * (kErrorColours - 1) + (n - 1) / 2) / (n - 1);
  return "var(--e" + std::to_string(std::min(i, kErrorColours - 1)) + ")";
}

std::vector<Rgba> map_palette(bool dark) {
  std::vector<Rgba> palette{{0, 0, 0, 0}};
  for (const std::uint32_t c : dark ? kErrorDark : kErrorLight) {
    palette.push_back(
        {static_cast<std::uint8_t>(c >> 16), static_cast<std::uint8_t>(c >> 8), static_cast<std::uint8_t>(c), 255});
  }
  return palette;
}

}  // namespace canyon::report
