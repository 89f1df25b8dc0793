#include "canyon/inertial/errors/flicker.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/inertial/errors/block_noise.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/errors/markov_process.h"
#include "canyon/inertial/errors/white_draws.h"

namespace canyon::inertial {
namespace {

class Flicker {
 public:
  explicit Flicker(const TriadSetup& s) : within_(s.unit.seed, s.name + ".flicker.within") {
    const TriadFigures& f = s.figures;
    double within_variance = 0.0;
    for (const FlickerPart& part : flicker_parts(f.bias_instability, f.flicker_low_hz, f.flicker_high_hz)) {
      const auto n = static_cast<std::uint32_t>(parts_.size());
      parts_.push_back(MarkovProcess::gauss_markov(s.unit.seed, s.name + ".flicker", n, part.sigma * s.unit.dt_s,
                                                   part.tau_s, s.unit.dt_s));
      within_variance += parts_.back().within_sigma() * parts_.back().within_sigma();
    }
    within_sigma_ = std::sqrt(within_variance);
  }
  static bool needed(const TriadFigures& f) { return f.bias_instability > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) {
    noise_.add_to(block, triad.output, [this](std::int64_t number, AxisArrays& errors) {
      for (MarkovProcess& part : parts_) part.add_means(number, errors);
      if (within_sigma_ > 0.0) add_white(within_, within_sigma_, number, errors);
    });
  }

 private:
  std::vector<MarkovProcess> parts_;
  RandomStream within_;
  double within_sigma_ = 0.0;
  BlockNoise noise_;
};

}  // namespace

std::vector<FlickerPart> flicker_parts(double bias_instability, double low_hz, double high_hz) {
  CANYON_CHECK(0.0 < low_hz && low_hz < high_hz, "low_hz = ", low_hz, ", high_hz = ", high_hz);
  const double b2 = bias_instability * bias_instability * kPi / (2.0 * std::log(2.0));
  const double nepers = std::log(high_hz / low_hz);
  const int count = static_cast<int>(std::ceil(nepers / std::log(4.0) - 1e-9));
  std::vector<FlickerPart> parts;
  for (int i = 0; i < count; ++i) {
    const double corner_hz = high_hz * std::exp(-nepers * (i + 0.5) / count);
    parts.push_back({.sigma = std::sqrt(b2 / kPi * nepers / count), .tau_s = 1.0 / (2.0 * kPi * corner_hz)});
  }
  return parts;
}

std::unique_ptr<ErrorLink> make_flicker(const LinkSetup& setup) {
  return make_for_both_triads<Flicker>(setup);
}

}  // namespace canyon::inertial
