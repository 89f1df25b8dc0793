#pragma once

#include <functional>
#include <string>
#include <vector>

namespace canyon::report {

/// How a satellite is received.
enum class SkyState { kDirect, kDirectAndReflected, kReflectedOnly, kNotTracked };

struct SkyPoint {
  double azimuth_deg = 0.0;  ///< from true north, clockwise
  double elevation_deg = 0.0;
  SkyState state = SkyState::kDirect;
};

/// The way of one satellite over the sky; the name stands at its first point.
struct SkyTrack {
  std::string name;
  std::vector<SkyPoint> points;
};

struct SkyPlot {
  std::string title, subtitle;
  double mask_deg = 0.0;  ///< drawn as a dashed circle
  std::vector<SkyTrack> tracks;
  /// Whether the scene hides the square degree that begins at (azimuth, elevation); empty: open sky.
  std::function<bool(int azimuth_deg, int elevation_deg)> blocked;
};

/// One SVG picture, north up, east to the right, the zenith in the middle, equal steps of elevation.
std::string sky_plot_svg(const SkyPlot& plot);

}  // namespace canyon::report
