#include "canyon/inertial/errors/constant_draws.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// Bias +- R t from the first sample on, the sign drawn for each axis.
class Ramp {
 public:
  explicit Ramp(const TriadSetup& s)
      : dt_s_(s.unit.dt_s), slope_(s.figures.ramp * sign_draws(s.unit.seed, s.name + ".ramp")) {}
  static bool needed(const TriadFigures& f) { return f.ramp > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double per_sample = slope_[static_cast<Eigen::Index>(axis)] * dt_s_ * dt_s_;
      for (std::size_t i = 0; i < block.count; ++i) {
        const double middle = static_cast<double>(block.first) + (static_cast<double>(i) + 0.5);
        triad.output[axis][i] += per_sample * middle;
      }
    }
  }

 private:
  double dt_s_;
  Eigen::Vector3d slope_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_ramp(const LinkSetup& setup) {
  return make_for_both_triads<Ramp>(setup);
}

}  // namespace canyon::inertial
