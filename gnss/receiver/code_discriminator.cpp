#include "gnss/receiver/code_discriminator.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/check.h"
#include "gnss/signal.h"

namespace canyon::gnss {
namespace {

double triangle(double x_chips) {
  return std::max(0.0, 1.0 - std::abs(x_chips));
}

struct Component {
  double delay_chips;
  double weight;
};

double discriminator(const std::vector<Component>& components, double t_chips, double half_chips) {
  double sum = 0.0;
  for (const auto& c : components)
    sum += c.weight * (triangle(t_chips - half_chips - c.delay_chips) - triangle(t_chips + half_chips - c.delay_chips));
  // Exact zeros come out as rounding noise.
  return std::abs(sum) < 1e-13 ? 0.0 : sum;
}

}  // namespace

std::optional<double> coherent_early_late_error_m(std::span<const EchoSignal> echoes, double spacing_chips) {
  CANYON_CHECK(spacing_chips > 0.0 && spacing_chips <= 1.0, "spacing_chips = ", spacing_chips);
  const double half = 0.5 * spacing_chips;
  std::vector<Component> components{{0.0, 1.0}};
  for (const auto& e : echoes) {
    if (e.delay_m / kCaChipM >= 1.0 + spacing_chips + 1.0)
      continue;  // its correlation does not reach the direct signal's
    components.push_back({e.delay_m / kCaChipM, e.amplitude * std::cos(e.phase_rad)});
  }
  if (components.size() == 1) return 0.0;

  std::vector<double> knots;
  for (const auto& c : components)
    for (const double corner : {-1.0, 0.0, 1.0})
      for (const double side : {-half, half}) knots.push_back(c.delay_chips + side + corner);
  std::sort(knots.begin(), knots.end());

  std::optional<double> best;
  double negative_at = 0.0, negative_value = 0.0;  // last knot with a value below zero
  double zero_from = 0.0, zero_to = 0.0;           // zeros since then
  bool armed = false, zeros = false;
  for (const double t : knots) {
    const double value = discriminator(components, t, half);
    if (value < 0.0) {
      armed = true;
      zeros = false;
      negative_at = t;
      negative_value = value;
    } else if (armed && value == 0.0) {
      if (!zeros) zero_from = t;
      zeros = true;
      zero_to = t;
    } else if (armed && value > 0.0) {
      const double root = zeros ? 0.5 * (zero_from + zero_to)
                                : negative_at - negative_value * (t - negative_at) / (value - negative_value);
      if (!best || std::abs(root) < std::abs(*best)) best = root;
      armed = zeros = false;
    }
  }
  if (best) *best *= kCaChipM;
  return best;
}

double composite_amplitude(std::span<const EchoSignal> echoes) {
  std::complex<double> sum = 1.0;
  for (const auto& e : echoes) sum += std::polar(e.amplitude * triangle(e.delay_m / kCaChipM), e.phase_rad);
  return std::abs(sum);
}

}  // namespace canyon::gnss
