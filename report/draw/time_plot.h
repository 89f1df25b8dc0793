#pragma once

#include <string>
#include <vector>

namespace canyon::report {

/// One line of a panel, in the panel's unit; NaN cuts it.
struct TimeCurve {
  std::string name;
  std::vector<double> t_s, y;
};

struct TimePanel {
  std::string title, unit;
  std::vector<TimeCurve> curves;
};

/// One SVG picture: panels over one another with one time axis, linear; long series lose nothing that can be seen.
std::string time_plot_svg(const std::string& title, const std::vector<TimePanel>& panels);

}  // namespace canyon::report
