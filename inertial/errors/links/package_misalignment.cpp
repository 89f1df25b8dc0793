#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/constant_draws.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// The orthogonal triad is turned as a whole against the frame of the housing, by a rotation vector of three
/// independent normal terms: what mounting adds, and data sheets call axis-to-frame misalignment.
class PackageMisalignment {
 public:
  explicit PackageMisalignment(const TriadSetup& s) {
    const Eigen::Vector3d turn = s.figures.package_rad * RandomStream(s.unit.seed, s.name + ".package").normal3(0);
    turn_ = so3_exp(turn).toRotationMatrix() - Eigen::Matrix3d::Identity();
  }
  static bool needed(const TriadFigures& f) { return f.package_rad > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    add_product(turn_, triad.truth, block.count, triad.output);
  }

 private:
  Eigen::Matrix3d turn_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_package_misalignment(const LinkSetup& setup) {
  return make_for_both_triads<PackageMisalignment>(setup);
}

}  // namespace canyon::inertial
