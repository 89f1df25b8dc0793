#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// Colours. Runs have the hues of Okabe & Ito (2008), darkened or lightened for contrast with the page; errors the
/// viridis scale of van der Walt & Smith (2015), always with more error standing out more from the page. Both survive
/// colour blindness; lines also differ by their dashes, classes of error by a legend.
namespace canyon::report {

struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
};

/// Class of the elements of run i: "r0".
std::string run_class(std::size_t run);

/// CSS custom properties for both schemes, and the rules that give each run its colour and dash and let its check box
/// hide it.
std::string theme_css(std::size_t runs);

/// Classes of error, in metres: class 0 lies below edges[0], class i in [edges[i - 1], edges[i]), the last above.
struct ErrorClasses {
  std::vector<double> edges_m;
  std::vector<std::string> labels;  ///< one more than edges: "< 0.05", "0.05 – 0.1", ..., "≥ 2"
  std::size_t of(double error_m) const;
};
/// For maps (8 classes, 2 cm to 2 m) and for multipath (6 classes, 10 cm to 30 m).
const ErrorClasses& map_error_classes();
const ErrorClasses& multipath_classes();

/// CSS variable of class k of n: "var(--e3)".
std::string error_colour(std::size_t k, std::size_t n);
/// Palette of a map's PNG: index 0 transparent, index k + 1 class k.
std::vector<Rgba> map_palette(bool dark);

}  // namespace canyon::report
