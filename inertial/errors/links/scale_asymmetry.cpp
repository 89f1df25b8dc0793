#include <cmath>

#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// The gain for positive input differs from that for negative input by 2 a: error a |x|, a normal with the figure
/// `scale_asymmetry`.
class ScaleAsymmetry {
 public:
  explicit ScaleAsymmetry(const TriadSetup& s)
      : a_(s.figures.scale_asymmetry * RandomStream(s.unit.seed, s.name + ".scale_asymmetry").normal3(0)) {}
  static bool needed(const TriadFigures& f) { return f.scale_asymmetry > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double a = a_[static_cast<Eigen::Index>(axis)];
      for (std::size_t i = 0; i < block.count; ++i) triad.output[axis][i] += a * std::abs(triad.truth[axis][i]);
    }
  }

 private:
  Eigen::Vector3d a_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_scale_asymmetry(const LinkSetup& setup) {
  return make_for_both_triads<ScaleAsymmetry>(setup);
}

}  // namespace canyon::inertial
