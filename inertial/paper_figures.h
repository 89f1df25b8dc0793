#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "canyon/core/result.h"
#include "canyon/inertial/catalogue.h"

namespace canyon::inertial {

/// One figure of Durst & Goodin 2012 on inertial sensors, with one of the parameter sets that the paper prints.
struct PaperFigure {
  const char* name;  ///< "figure_3"
  const char* doc;
  double seconds;
  CatalogueEntry (*entry)();  ///< the unit, its [paper] table as that set says
};
/// Figures 2 and 3 (rates and heading of the high-grade unit, 20 minutes) and 7 (the hobby unit, ten minutes at 125 Hz)
/// with the set beside the figure and with the one earlier in section 3.
std::span<const PaperFigure> paper_figures();

/// A resting unit without gravity and Earth rate, dead reckoned by plain integration, as the paper does.
struct PaperDrift {
  std::vector<double> t_s;
  std::array<std::vector<double>, 3> rate_deg_s, angle_deg, position_m;
};
/// `chain`: "paper" or "paper_as_printed"; 125 samples per second.
Result<PaperDrift> paper_drift(const PaperFigure& figure, const std::string& chain, std::uint64_t seed);

}  // namespace canyon::inertial
