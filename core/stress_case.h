#pragma once

#include <functional>
#include <string>
#include <vector>

namespace canyon {

/// What a case came to: it holds where the figure is a number and no larger than the bound.
struct StressFigure {
  double figure = 0.0;
  double bound = 0.0;
};

enum class StressGroup { kStiff, kGeometry, kData, kLong };

/// One stiff or extreme case of a model: it stands in its folder's room stress/, beside the model, in that floor's
/// stress_cases(). `canyon stress` runs them, tests/study/stress/ makes a test of each, docs/stress.md lists them.
///
/// The bound is derived where the case is written (n eps scale, truncation, k sigma / sqrt(N) with its rate of false
/// alarms, a closed form), never tuned. A case that must refuse something has the number of what was not refused as its
/// figure, and 0 as its bound. `run` gives the same bits for any number of threads, and may throw: that is no pass.
struct StressCase {
  std::string name;  ///< "gauss_markov/tau_1e-6_s_at_5000_hz"; unique, no spaces
  StressGroup group = StressGroup::kStiff;
  std::string mechanism;  ///< what may break; grid points of one mechanism say the same
  std::string why;        ///< how a plausible implementation breaks there
  std::string expected;   ///< what is true there, and where the bound comes from
  std::string unit;       ///< of figure and bound; "" for a pure number or a count
  std::function<StressFigure()> run;
  bool long_running = false;  ///< over about a second: only in the long form
  std::string loose{};        ///< why the bound may be over 1000 times the figure; "": it may not
  std::string open{};         ///< which issue has to mend it; shown and counted apart. "": it must hold
};

}  // namespace canyon
