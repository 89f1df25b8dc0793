#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/constant_draws.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// The gyroscope sees specific force: error G f with nine independent normal terms.
class GSensitivity final : public ErrorLink {
 public:
  explicit GSensitivity(const LinkSetup& setup) {
    const RandomStream stream(setup.seed, "imu.gyro.g_sensitivity");
    for (std::uint32_t column = 0; column < 3; ++column) g_.col(column) = stream.normal3(0, column);
    g_ *= setup.figures.gyro.g_sensitivity;
  }
  void apply(ImuBlock& block) override { add_product(g_, block.triads[1].truth, block.count, block.triads[0].output); }

 private:
  Eigen::Matrix3d g_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_g_sensitivity(const LinkSetup& setup) {
  if (setup.figures.gyro.g_sensitivity == 0.0) return nullptr;
  return std::make_unique<GSensitivity>(setup);
}

}  // namespace canyon::inertial
