#pragma once

#include <string>
#include <vector>

namespace canyon::report {

/// Deviation of one axis over averaging time, all vectors of one length.
struct DeviationCurve {
  std::string name;
  std::vector<double> tau_s, deviation, low, high;
  std::vector<double> fit;  ///< of a model at the same times; empty: none
};

struct DeviationPanel {
  std::string title, unit;
  std::vector<DeviationCurve> curves;
};

/// One SVG picture: panels side by side, both axes logarithmic; measured points with their band, the model as a line.
std::string deviation_plot_svg(const std::string& title, const std::string& subtitle,
                               const std::vector<DeviationPanel>& panels);

}  // namespace canyon::report
