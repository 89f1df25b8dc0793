#include <algorithm>
#include <cmath>

#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// What is left against the best straight line: with r = x / range and the figure d (a part of the range),
///   error = range d / sqrt(2) (n2 2 r^2 + n3 (4 r^3 - 3 r)),   n2, n3 unit normals per axis.
/// Second order K2 and third order K3 of the accelerometer model of IEEE Std 1293; the cubic is Chebyshev's, which
/// leaves its straight line by the same amount at its extremes and at the ends of the range, as best-fit figures are
/// meant. Beyond the range it stays at the value of the end.
class Nonlinearity {
 public:
  explicit Nonlinearity(const TriadSetup& s) : range_increment_(s.figures.range * s.unit.dt_s) {
    const RandomStream stream(s.unit.seed, s.name + ".nonlinearity");
    const double size = range_increment_ * s.figures.nonlinearity / std::sqrt(2.0);
    second_ = size * stream.normal3(0, 0);
    third_ = size * stream.normal3(0, 1);
  }
  static bool needed(const TriadFigures& f) { return f.nonlinearity > 0.0 && f.range > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double n2 = second_[static_cast<Eigen::Index>(axis)], n3 = third_[static_cast<Eigen::Index>(axis)];
      for (std::size_t i = 0; i < block.count; ++i) {
        const double r = std::clamp(triad.truth[axis][i] / range_increment_, -1.0, 1.0);
        triad.output[axis][i] += n2 * 2.0 * r * r + n3 * r * (4.0 * r * r - 3.0);
      }
    }
  }

 private:
  double range_increment_;
  Eigen::Vector3d second_, third_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_nonlinearity(const LinkSetup& setup) {
  return make_for_both_triads<Nonlinearity>(setup);
}

}  // namespace canyon::inertial
