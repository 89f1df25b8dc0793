#pragma once

#include <string>
#include <vector>

namespace canyon::report {

struct Tick {
  double value = 0.0;
  std::string label;  ///< empty: a minor tick, grid line only
};

/// A linear or logarithmic axis: from values to places in [0, 1], and its ticks.
class Axis {
 public:
  /// [min, max] as given, for time axes and the like; widened if empty. Ticks at multiples of 1, 2 or 5 times a power
  /// of ten.
  static Axis linear(double min, double max, int target_ticks = 5);
  /// [min, max] widened to whole ticks, so that the extreme values do not touch the frame.
  static Axis linear_rounded(double min, double max, int target_ticks = 5);
  /// Seconds: ticks at 1, 2, 5, 10, 15, 30 s, 1, 2, 5, 10, 15, 30 min, 1, 2, ... h; labels in seconds.
  static Axis seconds(double min, double max, int target_ticks = 9);
  /// 0 < min <= max; widened to ticks at 1, 2 and 5 times the powers of ten (1, 1.5, 2, 3, 4, 5 and 7 times
  /// within one decade); labels at the powers of ten alone if there are more than three.
  static Axis logarithmic(double min, double max);
  /// 0 < min <= max; widened to whole decades, each with its nine ticks; labels at the powers of ten, as such: "10⁻³".
  static Axis decades(double min, double max);

  double min() const { return min_; }
  double max() const { return max_; }
  bool is_logarithmic() const { return logarithmic_; }
  const std::vector<Tick>& ticks() const { return ticks_; }

  /// 0 at min, 1 at max; outside values give places outside. On a logarithmic axis anything not above zero gives -1.
  double place(double value) const;
  double value_at(double place) const;

 private:
  void add_linear_ticks(double step);
  double min_ = 0.0, max_ = 1.0;
  bool logarithmic_ = false;
  std::vector<Tick> ticks_;
};

/// The smallest of 1, 2, 5 times a power of ten with which at most `target` steps span `range` > 0.
double nice_step(double range, int target);

}  // namespace canyon::report
