#include "canyon/inertial/errors/constant_draws.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// Even-order response turns vibration too fast for the samples into a bias: on an axis of the accelerometer +- VRE
/// times the mean square along that axis, on one of the gyroscope +- VRE times the whole mean square; signs drawn.
class VibrationRectification {
 public:
  explicit VibrationRectification(const TriadSetup& s) {
    const Eigen::Vector3d square = s.unit.environment.vibration_rms_m_s2.cwiseAbs2();
    const bool gyro = s.name == "imu.gyro";
    const Eigen::Vector3d acting = gyro ? Eigen::Vector3d::Constant(square.sum()) : square;
    increment_ = s.figures.vibration_rectification * s.unit.dt_s *
                 sign_draws(s.unit.seed, s.name + ".vibration_rectification").cwiseProduct(acting);
  }
  static bool needed(const TriadFigures& f) { return f.vibration_rectification > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const { add_constant(increment_, block.count, triad.output); }

 private:
  Eigen::Vector3d increment_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_vibration_rectification(const LinkSetup& setup) {
  if (setup.environment.vibration_rms_m_s2.isZero(0.0)) return nullptr;
  return make_for_both_triads<VibrationRectification>(setup);
}

}  // namespace canyon::inertial
