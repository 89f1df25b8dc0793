#include "canyon/inertial/errors/constant_draws.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// Channels leak into one another after the elements: output += C output, noise and biases included; C is zero on the
/// diagonal, with six independent normal terms.
class CrossTalk {
 public:
  explicit CrossTalk(const TriadSetup& s)
      : leak_(s.figures.cross_talk * off_diagonal_draws(s.unit.seed, s.name + ".cross_talk")) {}
  static bool needed(const TriadFigures& f) { return f.cross_talk > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::copy_n(triad.output[axis].begin(), block.count, before_[axis].begin());
    }
    add_product(leak_, before_, block.count, triad.output);
  }

 private:
  Eigen::Matrix3d leak_;
  AxisArrays before_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_cross_talk(const LinkSetup& setup) {
  return make_for_both_triads<CrossTalk>(setup);
}

}  // namespace canyon::inertial
