#pragma once

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/core/stress_case.h"

namespace canyon {

/// What the cases of one mechanism have in common.
struct StressMechanism {
  StressGroup group = StressGroup::kStiff;
  std::string mechanism, why, expected, unit;
  std::string loose{};  ///< as of StressCase
  bool long_running = false;
};

/// Collects cases: a mechanism, then its grid points.
class StressRows {
 public:
  StressRows& of(StressMechanism shared) {
    shared_ = std::move(shared);
    return *this;
  }
  StressRows& add(std::string name, std::function<StressFigure()> run) {
    rows_.push_back({.name = std::move(name),
                     .group = shared_.group,
                     .mechanism = shared_.mechanism,
                     .why = shared_.why,
                     .expected = shared_.expected,
                     .unit = shared_.unit,
                     .run = std::move(run),
                     .long_running = shared_.long_running,
                     .loose = shared_.loose});
    return *this;
  }
  /// Of the case added last.
  StressRows& long_running() {
    rows_.back().long_running = true;
    return *this;
  }
  StressRows& loose(std::string why) {
    rows_.back().loose = std::move(why);
    return *this;
  }
  StressRows& open(std::string issue) {
    rows_.back().open = std::move(issue);
    return *this;
  }
  std::vector<StressCase> take() { return std::move(rows_); }

 private:
  StressMechanism shared_;
  std::vector<StressCase> rows_;
};

/// The larger of two, and NaN if either is NaN, which std::max would swallow.
template <class Number>
Number worse(Number a, Number b) {
  return a >= b ? a : b > a ? b : std::numeric_limits<Number>::quiet_NaN();
}

/// How far x lies beyond what is allowed: 0 up to there, and NaN for NaN.
inline double beyond(double x, double allowed) {
  return x <= allowed ? 0.0 : x - allowed;
}

/// The larger share of a bound, for figures that are errors in units of what each of them may be: no more than 1.
inline void take_worst(StressFigure& figure, double error) {
  figure.figure = worse(figure.figure, error);
}

/// What cases are written with.
namespace stress {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kHalfUlp = 0x1p-24;  ///< of single precision, relative

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

}  // namespace stress

}  // namespace canyon
