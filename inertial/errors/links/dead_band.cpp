#include <cmath>

#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// An output whose magnitude (mean over the interval) is below the dead band is zero.
class DeadBand {
 public:
  explicit DeadBand(const TriadSetup& s) : increment_(s.figures.dead_band * s.unit.dt_s) {}
  static bool needed(const TriadFigures& f) { return f.dead_band > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    for (auto& axis : triad.output) {
      for (std::size_t i = 0; i < block.count; ++i) axis[i] = std::abs(axis[i]) < increment_ ? 0.0 : axis[i];
    }
  }

 private:
  double increment_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_dead_band(const LinkSetup& setup) {
  return make_for_both_triads<DeadBand>(setup);
}

}  // namespace canyon::inertial
