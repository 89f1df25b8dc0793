#include "inertial/errors/block_noise.h"
#include "inertial/errors/error_link.h"
#include "inertial/errors/markov_process.h"
#include "inertial/errors/white_draws.h"

namespace canyon::inertial {
namespace {

/// Bias whose derivative is white with density K^2; zero when the run starts (the turn-on bias is a link of its own).
class RateRandomWalk {
 public:
  explicit RateRandomWalk(const TriadSetup& s)
      : process_(MarkovProcess::random_walk(s.unit.seed, s.name + ".rate_random_walk", 0,
                                            s.figures.rate_random_walk * s.unit.dt_s, s.unit.dt_s)),
        within_(s.unit.seed, s.name + ".rate_random_walk.within") {}
  static bool needed(const TriadFigures& f) { return f.rate_random_walk > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) {
    noise_.add_to(block, triad.output, [this](std::int64_t number, AxisArrays& errors) {
      process_.add_means(number, errors);
      add_white(within_, process_.within_sigma(), number, errors);
    });
  }

 private:
  MarkovProcess process_;  // of the increment: bias times interval
  RandomStream within_;
  BlockNoise noise_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_rate_random_walk(const LinkSetup& setup) {
  return make_for_both_triads<RateRandomWalk>(setup);
}

}  // namespace canyon::inertial
