#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "canyon/core/check.h"
#include "canyon/core/stress_case.h"
#include "canyon/core/stress_rows.h"

/// What the rooms stress/ of all floors write their cases with.
namespace canyon::stress {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What the grid points of one mechanism have in common.
inline StressCase mechanism(StressGroup group, std::string what, std::string why, std::string expected,
                            std::string unit) {
  StressCase shared;
  shared.group = group;
  shared.mechanism = std::move(what);
  shared.why = std::move(why);
  shared.expected = std::move(expected);
  shared.unit = std::move(unit);
  return shared;
}

/// One of them.
inline StressCase row(const StressCase& shared, std::string name, std::function<StressFigure()> run) {
  StressCase out = shared;
  out.name = std::move(name);
  out.run = std::move(run);
  return out;
}

/// "1e-6", "0.5", "5000": a number within a name.
inline std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", x);
  std::string out = buffer;
  const auto e = out.find('e');
  if (e == std::string::npos) return out;
  const std::string power = out.substr(e + 1);
  return out.substr(0, e) + "e" + std::to_string(std::stoi(power));
}

/// The worst of many looks, each against a bound of its own: the figure is a part of that bound. What is not a number
/// is as bad as can be, and so is a bound that is none: not above 0, or infinite.
class Worst {
 public:
  void look(double error, double bound) {
    const bool bounds = bound > 0.0 && bound < kInfinity;
    const double part = bounds ? std::abs(error) / bound : kInfinity;
    worst_ = part <= worst_ ? worst_ : (std::isnan(part) ? kInfinity : part);
  }
  StressFigure figure() const { return {worst_, 1.0}; }

 private:
  double worst_ = 0.0;
};

/// 1 where `act` is not refused with a ProgramError that says these words: of refusals, the figure counts what is let
/// through, or was found out by another check than the one that is meant.
template <class Act>
int not_refused(Act&& act, std::string_view words = "") {
  try {
    std::forward<Act>(act)();
  } catch (const ProgramError& error) {
    return std::string_view(error.what()).find(words) == std::string_view::npos ? 1 : 0;
  }
  return 1;
}

}  // namespace canyon::stress
