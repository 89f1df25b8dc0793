#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/stress_case.h"

namespace canyon {

/// What the cases of one mechanism have in common.
struct StressMechanism {
  StressGroup group = StressGroup::kStiff;
  std::string mechanism, why, expected, unit;
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
                     .run = std::move(run)});
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

}  // namespace canyon
