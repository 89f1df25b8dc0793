#include "canyon/report/draw/axis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

/// The label of a tick: exact decimals of its step, with a real minus.
std::string tick_label(double value, double step) {
  // One decimal more than the step's own, for ticks such as 1.5; fixed() drops it where it is zero.
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::string text = fixed(value, decimals);
  if (text[0] == '-') text.replace(0, 1, "\xE2\x88\x92");
  return text;
}

/// "10⁻³".
std::string power_of_ten(int exponent) {
  static constexpr std::array<const char*, 10> kDigits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) out += kDigits[static_cast<std::size_t>(digit - '0')];
  return out;
}

}  // namespace

double nice_step(double range, int target) {
  CANYON_CHECK(range > 0 && std::isfinite(range) && target > 0, "range = ", range, ", target = ", target);
  const double raw = range / target;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

void Axis::add_linear_ticks(double step) {
  // Ticks are integers times the step, so that 0.30000000000000004 cannot occur twice or be missed.
  const auto first = static_cast<long long>(std::ceil(min_ / step - 1e-9));
  const auto last = static_cast<long long>(std::floor(max_ / step + 1e-9));
  for (long long k = first; k <= last; ++k) {
    const double value = static_cast<double>(k) * step;
    ticks_.push_back({value, tick_label(value, step)});
  }
}

Axis Axis::linear(double min, double max, int target_ticks) {
  CANYON_CHECK(std::isfinite(min) && std::isfinite(max) && min <= max, "min = ", min, ", max = ", max);
  if (max - min <= 1e-12 * std::max(std::abs(min), std::abs(max)) || max == min) {
    const double half = min == 0 ? 1.0 : 0.5 * std::abs(min);
    min -= half, max += half;
  }
  Axis axis;
  axis.min_ = min;
  axis.max_ = max;
  axis.add_linear_ticks(nice_step(max - min, target_ticks));
  return axis;
}

Axis Axis::linear_rounded(double min, double max, int target_ticks) {
  const Axis tight = linear(min, max, target_ticks);
  const double step = nice_step(tight.max_ - tight.min_, target_ticks);
  Axis axis;
  axis.min_ = step * std::floor(tight.min_ / step + 1e-9);
  axis.max_ = step * std::ceil(tight.max_ / step - 1e-9);
  axis.add_linear_ticks(step);
  return axis;
}

Axis Axis::seconds(double min, double max, int target_ticks) {
  Axis axis = linear(min, max, target_ticks);
  constexpr std::array<double, 16> kSteps{1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 28800};
  const double raw = (axis.max_ - axis.min_) / target_ticks;
  if (raw <= 1 || raw > kSteps.back()) return axis;
  const double step = *std::find_if(kSteps.begin(), kSteps.end(), [raw](double s) { return s >= raw * (1 - 1e-9); });
  axis.ticks_.clear();
  axis.add_linear_ticks(step);
  return axis;
}

Axis Axis::logarithmic(double min, double max) {
  CANYON_CHECK(min > 0 && max >= min && std::isfinite(max), "min = ", min, ", max = ", max);
  // All ticks are a factor times a whole power of ten, never built by repeated multiplication.
  static const std::vector<double> kFew{1, 2, 5}, kMany{1, 1.5, 2, 3, 4, 5, 7};
  const std::vector<double>& factors = max < 10 * min ? kMany : kFew;
  const int per_decade = static_cast<int>(factors.size());
  const auto tick = [&](int i) {
    const int decade = static_cast<int>(std::floor(static_cast<double>(i) / per_decade));
    return factors[static_cast<std::size_t>(i - per_decade * decade)] * std::pow(10.0, decade);
  };
  int first = per_decade * (static_cast<int>(std::floor(std::log10(min))) + 1);
  while (tick(first) > min * (1 + 1e-9)) --first;
  int last = per_decade * static_cast<int>(std::floor(std::log10(max))) - 1;
  while (tick(last) < max * (1 - 1e-9)) ++last;
  if (last == first) ++last;
  Axis axis;
  axis.logarithmic_ = true;
  axis.min_ = tick(first);
  axis.max_ = tick(last);
  const bool decades_only = last - first > 3 * per_decade;
  for (int i = first; i <= last; ++i) {
    const bool labelled = !decades_only || i % per_decade == 0;
    axis.ticks_.push_back({tick(i), labelled ? tick_label(tick(i), tick(i)) : std::string()});
  }
  return axis;
}

Axis Axis::decades(double min, double max) {
  CANYON_CHECK(min > 0 && max >= min && std::isfinite(max), "min = ", min, ", max = ", max);
  const int first = static_cast<int>(std::floor(std::log10(min)));
  const int last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(max))));
  Axis axis;
  axis.logarithmic_ = true;
  axis.min_ = std::pow(10.0, first);
  axis.max_ = std::pow(10.0, last);
  for (int decade = first; decade <= last; ++decade)
    for (int k = 1; k < 10 && (k == 1 || decade < last); ++k)
      axis.ticks_.push_back({k * std::pow(10.0, decade), k == 1 ? power_of_ten(decade) : std::string()});
  return axis;
}

double Axis::place(double value) const {
  if (!logarithmic_) return (value - min_) / (max_ - min_);
  return value > 0 ? std::log(value / min_) / std::log(max_ / min_) : -1.0;
}

double Axis::value_at(double place) const {
  return logarithmic_ ? min_ * std::pow(max_ / min_, place) : min_ + place * (max_ - min_);
}

}  // namespace canyon::report
