#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/constant_draws.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// Error s x, with s constant over a run, normal with the figure `scale`.
class ScaleFactor {
 public:
  explicit ScaleFactor(const TriadSetup& s)
      : gain_(Eigen::Vector3d(s.figures.scale * RandomStream(s.unit.seed, s.name + ".scale").normal3(0)).asDiagonal()) {
  }
  static bool needed(const TriadFigures& f) { return f.scale > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    add_product(gain_, triad.truth, block.count, triad.output);
  }

 private:
  Eigen::Matrix3d gain_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_scale_factor(const LinkSetup& setup) {
  return make_for_both_triads<ScaleFactor>(setup);
}

}  // namespace canyon::inertial
