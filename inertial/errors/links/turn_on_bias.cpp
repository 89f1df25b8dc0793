#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/constant_draws.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// Drawn once when the unit is switched on.
class TurnOnBias {
 public:
  explicit TurnOnBias(const TriadSetup& s)
      : increment_(s.figures.turn_on_bias * s.unit.dt_s * RandomStream(s.unit.seed, s.name + ".turn_on").normal3(0)) {}
  static bool needed(const TriadFigures& f) { return f.turn_on_bias > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const { add_constant(increment_, block.count, triad.output); }

 private:
  Eigen::Vector3d increment_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_turn_on_bias(const LinkSetup& setup) {
  return make_for_both_triads<TurnOnBias>(setup);
}

}  // namespace canyon::inertial
