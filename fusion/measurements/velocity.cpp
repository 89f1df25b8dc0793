#include "canyon/fusion/measurements/body_velocity.h"

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

/// The antenna's velocity as the Doppler shifts give it.
class Velocity final : public MeasurementModel {
 public:
  explicit Velocity(const VelocityParameters& p) : p_(p) {}

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message) override {
    const GnssFix* fix = std::get_if<GnssFix>(&message);
    if (fix == nullptr || fix->status == FixStatus::kNone || !fix->v_A_E.allFinite()) return {};
    const PointVelocity antenna = point_velocity(filter, filter.lever_A_B);
    Measurement m(3, filter.state);
    m.residual = fix->v_A_E - antenna.v_E;
    m.H = antenna.H;
    const double scale = p_.fix_velocity_scale * p_.fix_velocity_scale,
                 floor = p_.fix_velocity_floor_m_s * p_.fix_velocity_floor_m_s;
    if (fix->velocity_covariance_E.allFinite())
      m.R = scale * 0.5 * (fix->velocity_covariance_E + fix->velocity_covariance_E.transpose());
    m.R.diagonal() = m.R.diagonal().cwiseMax(floor);
    return m;
  }

 private:
  VelocityParameters p_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_velocity(const ModelParameters& own, const MeasurementSetup&) {
  return std::make_unique<Velocity>(own.get<VelocityParameters>());
}

void velocity_parameters(ModelParameters& section) {
  section.add<VelocityParameters>();
}

}  // namespace canyon::fusion
