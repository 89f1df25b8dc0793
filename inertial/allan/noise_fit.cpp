#include "canyon/inertial/allan/noise_fit.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/inertial/allan/noise_terms.h"
#include "canyon/inertial/ceres_part.h"

namespace canyon::inertial {

std::vector<std::string> noise_process_names() {
  std::vector<std::string> names(std::begin(kNoiseTermNames), std::end(kNoiseTermNames));
  names.emplace_back("band_limit");
  return names;
}

const FittedTerm& NoiseFit::term(const std::string& name) const {
  for (const FittedTerm& t : terms)
    if (t.name == name) return t;
  CANYON_CHECK(false, "no noise process of that name: ", name);
  return terms.front();
}

double NoiseFit::deviation_at(double tau_s) const {
  double variance = 0.0;
  for (int k = 0; k < kNoiseTerms; ++k) {
    const FittedTerm& t = terms.at(static_cast<std::size_t>(k));
    const double second = k == kWhite ? t.second / (1.0 + 2.0 * t.second) : t.second;
    if (t.value > 0.0) variance += allan_variance(k, t.value, second, tau_s, interval_s);
  }
  return std::sqrt(variance);
}

#ifdef CANYON_WITH_CERES

bool can_fit_noise() {
  return true;
}

Result<NoiseFit> fit_noise(std::span<const DeviationPoint> points, int points_per_octave,
                           const std::vector<std::string>& allowed) {
  return ceres_part().fit_noise(points, points_per_octave, allowed);
}

#else

bool can_fit_noise() {
  return false;
}

Result<NoiseFit> fit_noise(std::span<const DeviationPoint>, int, const std::vector<std::string>&) {
  return Error{"", 0, "", kNoNoiseFit, "a build with CANYON_WITH_CERES=ON"};
}

#endif

}  // namespace canyon::inertial
