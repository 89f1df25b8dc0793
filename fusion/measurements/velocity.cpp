#include "canyon/fusion/measurements/body_motion.h"
#include "canyon/fusion/measurements/fix_age.h"
#include "canyon/fusion/states/velocity_error.h"

namespace canyon::fusion {
namespace {

struct VelocityParameters {
  double fix_velocity_scale = 1.0;
  double fix_velocity_floor_m_s = 0.05;
};
void visit(FieldVisitor& f, VelocityParameters& p) {
  f.number("fix_velocity_scale", p.fix_velocity_scale, {0.01, 100},
           "factor on the 1-sigma that a fix states of its velocity");
  f.number("fix_velocity_floor_m_s", p.fix_velocity_floor_m_s, {1e-4, 100},
           "lower bound on a fix's 1-sigma of velocity per axis");
}

/// The antenna's velocity as the Doppler shifts give it, where the receiver says how good it is.
class Velocity final : public Copied<MeasurementModel, Velocity> {
 public:
  Velocity(const VelocityParameters& p, const VelocityErrorParameters& lasting, const ErrorState& state)
      : p_(p), lasting_(lasting), age_(state), velocity_error_(state.offset("velocity_error")) {}

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int) override {
    const GnssFix* fix = std::get_if<GnssFix>(&message);
    if (fix == nullptr || fix->status == FixStatus::kNone || !fix->v_A_E.allFinite() ||
        !fix->velocity_covariance_E.allFinite())
      return {};
    const PointVelocity antenna = antenna_velocity(filter);
    Measurement m(3, filter.state, ErrorIndex::kVelocity);
    m.residual = fix->v_A_E - antenna.v_E;
    m.H = antenna.H;
    if (age_.estimated()) carry(filter, *fix, m);
    const double scale = p_.fix_velocity_scale * p_.fix_velocity_scale,
                 floor = p_.fix_velocity_floor_m_s * p_.fix_velocity_floor_m_s;
    m.R = scale * 0.5 * (fix->velocity_covariance_E + fix->velocity_covariance_E.transpose());
    m.R.diagonal() = m.R.diagonal().cwiseMax(floor);
    if (velocity_error_ >= 0) {
      const Eigen::Vector3d up_E = rotation_E_from_enu(geodetic_from_ecef(fix->p_A_E)).col(2);
      const Eigen::Matrix3d share = lasting_.share(fix->velocity_covariance_E, up_E);
      m.residual -= share * filter.state.values(velocity_error_, 3);
      m.H.middleCols<3>(velocity_error_) = share;
    }
    return m;
  }

 private:
  /// To the time of the fix, with the acceleration of the IMU: what the antenna's lever arm adds while a turn begins is
  /// left out.
  void carry(const FilterView& filter, const GnssFix& fix, Measurement& m) const {
    const PointAcceleration moving = acceleration(filter);
    const double age_s = age_.of(filter, fix.t);
    m.residual -= age_s * moving.a_E;
    m.H += age_s * moving.H;
    age_.set_column(m.H, moving.a_E);
  }

  VelocityParameters p_;
  VelocityErrorParameters lasting_;
  FixAge age_;
  int velocity_error_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_velocity(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<Velocity>(own.get<VelocityParameters>(), own.get<VelocityErrorParameters>(), at.state);
}

void velocity_parameters(ModelParameters& section) {
  section.add<VelocityParameters>();
}

}  // namespace canyon::fusion
