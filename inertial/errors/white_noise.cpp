#include <cmath>

#include "inertial/errors/block_noise.h"
#include "inertial/errors/error_link.h"
#include "inertial/errors/white_draws.h"

namespace canyon::inertial {
namespace {

/// Defined per root hertz: the increment over dt has variance N^2 dt, at any sample rate.
class WhiteNoise {
 public:
  explicit WhiteNoise(const TriadSetup& s)
      : stream_(s.unit.seed, s.name + ".white"),
        sigma_increment_(s.figures.white_per_sqrt_hz * std::sqrt(s.unit.dt_s)) {}
  static bool needed(const TriadFigures& f) { return f.white_per_sqrt_hz > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) {
    noise_.add_to(block, triad.output, [this](std::int64_t number, AxisArrays& errors) {
      add_white(stream_, sigma_increment_, number, errors);
    });
  }

 private:
  RandomStream stream_;
  double sigma_increment_;
  BlockNoise noise_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_white_noise(const LinkSetup& setup) {
  return make_for_both_triads<WhiteNoise>(setup);
}

}  // namespace canyon::inertial
