#include "canyon/inertial/errors/drifting_bias.h"

namespace canyon::inertial {
namespace {

/// Bias whose derivative is white with density K^2; zero when the run starts (the turn-on bias is a link of its own).
class RateRandomWalk : public DriftingBias {
 public:
  explicit RateRandomWalk(const TriadSetup& s)
      : DriftingBias(MarkovProcess::random_walk(s.unit.seed, s.name + ".rate_random_walk", 0,
                                                s.figures.rate_random_walk * s.unit.dt_s, s.unit.dt_s),
                     RandomStream(s.unit.seed, s.name + ".rate_random_walk.within")) {}
  static bool needed(const TriadFigures& f) { return f.rate_random_walk > 0.0; }
};

}  // namespace

std::unique_ptr<ErrorLink> make_rate_random_walk(const LinkSetup& setup) {
  return make_for_both_triads<RateRandomWalk>(setup);
}

}  // namespace canyon::inertial
