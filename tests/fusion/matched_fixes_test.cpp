// Fixes whose errors last over a way, and grow with what the fixes say of themselves, and velocities whose errors last
// too: the filter is as far off as it says.
#include <cmath>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/states/fix_error.h"
#include "canyon/fusion/states/velocity_error.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/driven_truth.h"
#include "canyon/tests/fusion/nees_bands.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using testing::DrivenTruth;

constexpr int kFixRuns = 100, kFixEpochs = 20;
constexpr double kFixEpoch_s = 5.0, kFixInterval_s = 0.5;
const char* const kFixKeys = R"(
states = ["turn_on_biases", "fix_error", "velocity_error"]
measurements = ["position", "velocity"]
acceptance = "accept_all"
initial_attitude_sigma_deg_roll_pitch = 0.2
initial_attitude_sigma_deg_heading = 0.5
initial_position_sigma_m = 1.0
initial_velocity_sigma_m_s = 0.2
fix_error_sigma_m = 0.5
fix_error_scale = 2.0
fix_error_tau_s = 40.0
fix_error_way_m = 50.0
velocity_error_scale = 2.0
velocity_error_up_scale = 3.0
velocity_error_tau_s = 5.0
fix_velocity_floor_m_s = 1e-3
)";

ImuNoise unit_beside_fixes() {
  ImuNoise n;
  n.gyro = {.white_per_sqrt_hz = 5e-5, .turn_on_bias_sigma = 5e-5};
  n.accel = {.white_per_sqrt_hz = 1e-3, .turn_on_bias_sigma = 5e-3};
  return n;
}

/// A receiver whose fixes err as kFixKeys says, and state a covariance that comes and goes, long in one direction.
class FixWorld {
 public:
  explicit FixWorld(std::uint64_t seed)
      : stream_(seed, "test.lasting_fixes"),
        truth_(seed, 0.3 + 0.05 * static_cast<double>(seed)),
        lasting_(configured(kFixKeys).own.get<FixErrorParameters>()),
        fast_(configured(kFixKeys).own.get<VelocityErrorParameters>()) {
    truth_.gyro_per_sqrt_hz = unit_beside_fixes().gyro.white_per_sqrt_hz;
    truth_.accel_per_sqrt_hz = unit_beside_fixes().accel.white_per_sqrt_hz;
    for (int i = 0; i < 3; ++i) {
      gyro_bias_[i] = unit_beside_fixes().gyro.turn_on_bias_sigma * draw();
      accel_bias_[i] = unit_beside_fixes().accel.turn_on_bias_sigma * draw();
    }
    error_ = vector(lasting_.fix_error_sigma_m);
    fast_error_ = vector(1.0);
  }

  ErrorStateFilter filter() {
    ErrorStateFilter out(configured(kFixKeys), unit_beside_fixes(), DrivenTruth::frame(), Vector3d::Zero(), lever());
    Pose X = truth_.X_WB();
    X.R = so3_exp(Vector3d(0.2 * kDegree * draw(), 0.2 * kDegree * draw(), 0.5 * kDegree * draw())) * X.R;
    X.p += vector(1.0);
    out.initialize(truth_.state().t, X, truth_.v_W() + vector(0.2));
    return out;
  }

  void step(ErrorStateFilter& filter) {
    ImuSample s = truth_.step();
    s.dtheta_U += gyro_bias_ * s.dt_s;
    s.dv_U += accel_bias_ * s.dt_s;
    filter.predict(s);
    if (++k_ % static_cast<int>(100 * kFixInterval_s) == 0) receive(filter);
  }

  std::map<std::string, Eigen::VectorXd> errors(const ErrorStateFilter& filter) const {
    const NavState& n = filter.nav_state();
    const NavState& t = truth_.state();
    const int bias = filter.offset("turn_on_biases"), lasting = filter.offset("fix_error"),
              fast = filter.offset("velocity_error");
    Eigen::VectorXd of_bias(6), of_lasting(3), of_fast(3);
    for (int i = 0; i < 6; ++i) of_bias[i] = (i < 3 ? gyro_bias_[i] : accel_bias_[i - 3]) - filter.value(bias + i);
    for (int i = 0; i < 3; ++i) {
      of_lasting[i] = error_[i] - filter.value(lasting + i);
      of_fast[i] = fast_error_[i] - filter.value(fast + i);
    }
    return {{"theta", so3_log(n.R_EU.conjugate() * t.R_EU)},
            {"p", t.p_EU_E - n.p_EU_E},
            {"v", t.v_EU_E - n.v_EU_E},
            {"turn_on_biases", of_bias},
            {"fix_error", of_lasting},
            {"velocity_error", of_fast}};
  }
  /// Where a block's errors begin.
  static int at(const ErrorStateFilter& filter, const std::string& block) {
    if (block == "theta") return ErrorIndex::kTheta;
    if (block == "p") return ErrorIndex::kPosition;
    return block == "v" ? static_cast<int>(ErrorIndex::kVelocity) : filter.offset(block);
  }

 private:
  static Vector3d lever() { return {-0.4, 0.3, 1.5}; }
  double draw() { return stream_.normal(0, n_++); }
  Vector3d vector(double sigma) { return sigma * Vector3d(draw(), draw(), draw()); }

  void receive(ErrorStateFilter& filter) {
    const NavState& t = truth_.state();
    const double way_m = kFixInterval_s * t.v_EU_E.norm();
    const double kept = std::exp(-kFixInterval_s / lasting_.fix_error_tau_s - way_m / lasting_.fix_error_way_m);
    error_ = kept * error_ + vector(lasting_.fix_error_sigma_m * std::sqrt(1.0 - kept * kept));
    const double elapsed_s = truth_.elapsed_s(), small = 0.3, large = 0.3 + 1.2 * (1.0 + std::sin(0.15 * elapsed_s));
    const Eigen::Matrix3d turned =
        (Eigen::AngleAxisd(0.05 * elapsed_s, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.7, Vector3d::UnitX()))
            .toRotationMatrix();
    const Eigen::Matrix3d root = turned * Vector3d(small, large, small).asDiagonal() * turned.transpose();
    const Vector3d w = DrivenTruth::winding(elapsed_s - 0.01).w_EU_U;
    GnssFix fix;
    fix.t = t.t;
    fix.status = FixStatus::kSingle;
    fix.covariance_E = root * root;
    fix.p_A_E = t.p_EU_E + t.R_EU * lever() + lasting_.share(fix.covariance_E) * error_ + root * vector(1.0);
    const double fast_kept = std::exp(-kFixInterval_s / fast_.velocity_error_tau_s);
    fast_error_ = fast_kept * fast_error_ + vector(std::sqrt(1.0 - fast_kept * fast_kept));
    const Eigen::Matrix3d fast_root = 0.4 * root;
    fix.velocity_covariance_E = fast_root * fast_root;
    const Vector3d up_E = rotation_E_from_enu(geodetic_from_ecef(fix.p_A_E)).col(2);
    fix.v_A_E = t.v_EU_E + t.R_EU * w.cross(lever()) + fast_root * vector(1.0) +
                fast_.share(fix.velocity_covariance_E, up_E) * fast_error_;
    filter.update(fix);
  }

  RandomStream stream_;
  std::uint64_t n_ = 0;
  DrivenTruth truth_;
  FixErrorParameters lasting_;
  VelocityErrorParameters fast_;
  Vector3d gyro_bias_, accel_bias_, error_, fast_error_;
  int k_ = 0;
};

TEST(MatchedFixes, EveryBlockIsAsFarOffAsItSays) {
  testing::BlockNees nees(kFixEpochs);
  for (int run = 0; run < kFixRuns; ++run) {
    FixWorld world(static_cast<std::uint64_t>(run) + 1);
    ErrorStateFilter filter = world.filter();
    for (int epoch = 0; epoch < kFixEpochs; ++epoch) {
      for (int k = 0; k < static_cast<int>(100 * kFixEpoch_s); ++k) world.step(filter);
      const Eigen::MatrixXd P = filter.covariance();
      for (const auto& [name, error] : world.errors(filter)) {
        const int from = FixWorld::at(filter, name), size = static_cast<int>(error.size());
        nees.add(name, epoch, normalized_squared(error, P.block(from, from, size, size)), size);
      }
    }
  }
  nees.expect_in_bands(kFixRuns);
}

TEST(FixErrorParameters, AreARootOfTheCovariance) {
  FixErrorParameters p{.fix_error_sigma_m = 0.7, .fix_error_scale = 3.0, .fix_error_power = 1.0};
  const Eigen::Matrix3d turned = rotation_from({.yaw_rad = 0.4, .pitch_rad = 0.9, .roll_rad = -1.1}).toRotationMatrix();
  const Eigen::Matrix3d stated = turned * Vector3d(0.01, 4.0, 25.0).asDiagonal() * turned.transpose();
  const Eigen::Matrix3d root = p.share(stated), C = p.covariance(stated);
  const double rounding = 20.0 * 2.2e-16 * C.norm();
  EXPECT_LT((0.49 * root * root.transpose() - C).norm(), rounding);
  EXPECT_LT((root - root.transpose()).norm(), rounding);
  EXPECT_LT((C - 0.49 * Eigen::Matrix3d::Identity() - 9.0 * stated).norm(), rounding);
  p.fix_error_scale = 0.0;  // then a fix's own words do not matter
  EXPECT_EQ(p.share(stated), Eigen::Matrix3d::Identity());
}

// Along the axes of what is stated, each by itself; a power of 1 is what there was before it, to the bit.
TEST(FixErrorParameters, GrowAsAPowerOfWhatIsStated) {
  const Eigen::Matrix3d R = so3_exp(Vector3d(0.3, -0.5, 0.7)).toRotationMatrix();
  const Eigen::Matrix3d stated = R * Vector3d(0.25, 1.0, 16.0).asDiagonal() * R.transpose();
  FixErrorParameters p{.fix_error_sigma_m = 0.5, .fix_error_scale = 2.0, .fix_error_power = 1.0};
  const Eigen::Matrix3d linear = p.covariance(stated);
  p.fix_error_power = 1.5;
  // 1-sigmas of 0.5, 1 and 4 m make 2 times 0.5^1.5, 1 and 8 m; roundings of 256 m^2.
  const Vector3d variances = Vector3d(4.0 * 0.125, 4.0, 4.0 * 64.0).array() + 0.25;
  const Eigen::Matrix3d expected = R * variances.asDiagonal() * R.transpose();
  EXPECT_LT((p.covariance(stated) - expected).norm(), 64.0 * 2.2e-16 * 256.0);
  const Eigen::Matrix3d root = p.share(stated);
  EXPECT_LT((0.25 * root * root.transpose() - expected).norm(), 64.0 * 2.2e-16 * 256.0);
  EXPECT_EQ(linear, Eigen::Matrix3d(0.25 * Eigen::Matrix3d::Identity() + 4.0 * 0.5 * (stated + stated.transpose())));
}

// Stretched along the vertical alone, what is said across it stays.
TEST(VelocityErrorParameters, AreARootOfWhatIsStatedAndStretched) {
  const VelocityErrorParameters p{.velocity_error_scale = 2.0, .velocity_error_up_scale = 3.0};
  const Vector3d up = Vector3d(0.1, -0.8, 0.5).normalized(), across = up.unitOrthogonal();
  const Eigen::Matrix3d turned = rotation_from({.yaw_rad = 0.4, .pitch_rad = 0.9, .roll_rad = -1.1}).toRotationMatrix();
  const Eigen::Matrix3d stated = turned * Vector3d(0.01, 0.04, 0.25).asDiagonal() * turned.transpose();
  const Eigen::Matrix3d root = p.share(stated, up), C = root * root.transpose();
  const double rounding = 20.0 * 2.2e-16 * C.norm();
  EXPECT_NEAR(up.dot(C * up), 36.0 * up.dot(stated * up), rounding);
  EXPECT_NEAR(across.dot(C * across), 4.0 * across.dot(stated * across), rounding);
  EXPECT_NEAR(across.dot(C * up), 12.0 * across.dot(stated * up), rounding);
  EXPECT_LT((root - root.transpose()).norm(), rounding);
}

}  // namespace
}  // namespace canyon::fusion
