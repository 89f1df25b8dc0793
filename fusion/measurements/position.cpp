#include <algorithm>

#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/measurements/body_velocity.h"

namespace canyon::fusion {
namespace {

struct PositionParameters {
  double fix_sigma_floor_m = 0.0;
};
void visit(FieldVisitor& f, PositionParameters& p) {
  f.number("fix_sigma_floor_m", p.fix_sigma_floor_m, {0, 1e3}, "lower bound on a fix's 1-sigma per axis");
}

/// The antenna's place, carried to the time of the fix with the estimated velocity, and an error of the fixes that
/// lasts where the states have one.
class Position final : public MeasurementModel {
 public:
  Position(const PositionParameters& p, const ErrorState& state)
      : floor_m2_(p.fix_sigma_floor_m * p.fix_sigma_floor_m), fix_error_(state.offset("fix_error")) {}

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message) override {
    const GnssFix* fix = std::get_if<GnssFix>(&message);
    if (fix == nullptr || fix->status == FixStatus::kNone) return {};
    const NavState& nav = filter.state.nav;
    const Eigen::Matrix3d R_EU = nav.R_EU.toRotationMatrix();
    const Eigen::Vector3d arm_U = filter.lever_A_B - filter.lever_U_B;
    const PointVelocity antenna = point_velocity(filter, filter.lever_A_B);
    const double age_s = fix->t - nav.t;
    Measurement m(3, filter.state);
    m.residual = fix->p_A_E - (nav.p_EU_E + R_EU * arm_U + age_s * antenna.v_E);
    m.H = age_s * antenna.H;
    m.H.leftCols<3>() -= R_EU * skew(arm_U);
    m.H.middleCols<3>(ErrorIndex::kPosition) += Eigen::Matrix3d::Identity();
    m.R = 0.5 * (fix->covariance_E + fix->covariance_E.transpose());
    m.R.diagonal() = m.R.diagonal().cwiseMax(floor_m2_);  // which keeps it positive definite
    if (fix_error_ >= 0) {
      m.residual -= filter.state.values(fix_error_, 3);
      m.H.middleCols<3>(fix_error_).setIdentity();
    }
    return m;
  }

 private:
  double floor_m2_;
  int fix_error_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_position(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<Position>(own.get<PositionParameters>(), at.state);
}

void position_parameters(ModelParameters& section) {
  section.add<PositionParameters>();
}

}  // namespace canyon::fusion
