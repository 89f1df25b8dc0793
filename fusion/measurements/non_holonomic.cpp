#include "canyon/fusion/measurements/body_motion.h"

namespace canyon::fusion {
namespace {

struct NonHolonomicParameters {
  double non_holonomic_rate_hz = 10.0;
  double non_holonomic_sigma_m_s = 0.1;
  double non_holonomic_sideslip = 0.02;
};
void visit(FieldVisitor& f, NonHolonomicParameters& p) {
  f.number("non_holonomic_rate_hz", p.non_holonomic_rate_hz, {0.1, 1000}, "how often the constraint is used");
  f.number("non_holonomic_sigma_m_s", p.non_holonomic_sigma_m_s, {1e-4, 100},
           "1-sigma of the rear axle's velocity sideways and up");
  f.number("non_holonomic_sideslip", p.non_holonomic_sideslip, {0, 10},
           "1-sigma of the sideways velocity per m/s^2 of sideways acceleration, as a tyre slips, s");
}

/// The rear axle of a wheeled vehicle moves along B's x axis (Dissanayake et al. 2001, IEEE Trans. Robotics and
/// Automation 17(5)), but for what its tyres slip in a bend and its springs move.
class NonHolonomic final : public Copied<MeasurementModel, NonHolonomic> {
 public:
  explicit NonHolonomic(const NonHolonomicParameters& p) : p_(p) {}

  void start() override {
    elapsed_s_ = 0.0;
    used_ = 0;
  }

  std::optional<Measurement> stepped(const FilterView& filter, const Increments& in) override {
    elapsed_s_ += in.dt_s;
    // Of a grid of its own, so that it is used as often, and when, whether or not messages divide samples.
    const auto due = static_cast<std::int64_t>(elapsed_s_ * p_.non_holonomic_rate_hz + 1e-6);
    if (due <= used_) return {};
    used_ = due;
    const BodyVelocity axle = body_velocity(filter, Eigen::Vector3d::Zero());
    Measurement m(2, filter.state, ErrorIndex::kVelocity);
    m.residual = -axle.v_B.tail<2>();
    m.H = axle.H.bottomRows<2>();
    const double sideways = filter.w_EU_U.z() * axle.v_B.x();
    const double slip = p_.non_holonomic_sideslip * sideways;
    const double variance = p_.non_holonomic_sigma_m_s * p_.non_holonomic_sigma_m_s;
    m.R(0, 0) = variance + slip * slip;
    m.R(1, 1) = variance;
    return m;
  }

 private:
  NonHolonomicParameters p_;
  double elapsed_s_ = 0.0;
  std::int64_t used_ = 0;  // ticks
};

}  // namespace

std::unique_ptr<MeasurementModel> make_non_holonomic(const ModelParameters& own, const MeasurementSetup&) {
  return std::make_unique<NonHolonomic>(own.get<NonHolonomicParameters>());
}

void non_holonomic_parameters(ModelParameters& section) {
  section.add<NonHolonomicParameters>();
}

}  // namespace canyon::fusion
