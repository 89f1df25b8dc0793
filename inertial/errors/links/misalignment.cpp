#include "canyon/inertial/errors/constant_draws.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// Each sensitive axis is tilted by itself (small angles, first order): error M x with M zero on the diagonal and six
/// independent normal terms. Its symmetric part is the non-orthogonality, its skew part a rotation.
class Misalignment {
 public:
  explicit Misalignment(const TriadSetup& s)
      : tilt_(s.figures.misalignment_rad * off_diagonal_draws(s.unit.seed, s.name + ".misalignment")) {}
  static bool needed(const TriadFigures& f) { return f.misalignment_rad > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    add_product(tilt_, triad.truth, block.count, triad.output);
  }

 private:
  Eigen::Matrix3d tilt_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_misalignment(const LinkSetup& setup) {
  return make_for_both_triads<Misalignment>(setup);
}

}  // namespace canyon::inertial
