#include <cmath>

#include "canyon/fusion/measurements/body_motion.h"

namespace canyon::fusion {
namespace {

struct OdometerParameters {
  Eigen::Vector3d odometer_wheel_m{0.0, 0.8, 0.0};
  double odometer_interval_s = 0.2;
  double odometer_tick_m = 0.02;
  double odometer_slip_percent = 0.3;
};
void visit(FieldVisitor& f, OdometerParameters& p) {
  f.vector3("odometer_wheel_m", p.odometer_wheel_m, {-100, 100}, "contact point of the wheel in B");
  f.number("odometer_interval_s", p.odometer_interval_s, {0.001, 60}, "over which ticks are counted for one speed");
  f.number("odometer_tick_m", p.odometer_tick_m, {1e-6, 10}, "metres per tick of the nominal wheel");
  f.number("odometer_slip_percent", p.odometer_slip_percent, {0, 100},
           "1-sigma of slip, and of the wheel's radius where it is not estimated");
}

/// Forward speed of the wheel's contact point, as the mean over some samples of the encoder: a tick in twenty
/// milliseconds is a metre per second. The speed is taken as linear in time over it.
class OdometerSpeed final : public Copied<MeasurementModel, OdometerSpeed> {
 public:
  OdometerSpeed(const OdometerParameters& p, const ErrorState& state) : p_(p), scale_(state.offset("wheel_scale")) {}

  void start() override { begin(); }

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int) override {
    const OdometerSample* sample = std::get_if<OdometerSample>(&message);
    if (sample == nullptr) return {};
    counted_s_ += sample->dt_s;
    distance_m_ += sample->speed_m_s * sample->dt_s;
    if (counted_s_ < (1.0 - 1e-9) * p_.odometer_interval_s) return {};
    const double measured = distance_m_ / counted_s_, over_s = counted_s_;
    begin();

    const BodyVelocity wheel = body_velocity(filter, p_.odometer_wheel_m);
    const BodyAcceleration since = body_acceleration(filter);
    Measurement m(1, filter.state, ErrorIndex::kVelocity);
    double seen = wheel.v_B.x() - 0.5 * over_s * since.a_B.x();
    m.H = wheel.H.topRows<1>() - 0.5 * over_s * since.H.topRows<1>();
    if (scale_ >= 0) {
      // The wheel shows (1 + scale) of the true speed.
      m.H *= 1.0 + filter.state.values(scale_, 1)[0];
      m.H(0, scale_) = seen;
      seen *= 1.0 + filter.state.values(scale_, 1)[0];
    }
    m.residual[0] = measured - seen;
    // An edge is anywhere within a tick, at both ends of the interval.
    const double edges = p_.odometer_tick_m / over_s / std::sqrt(6.0);
    m.R(0, 0) = edges * edges + std::pow(0.01 * p_.odometer_slip_percent * measured, 2);
    return m;
  }

 private:
  void begin() { counted_s_ = distance_m_ = 0.0; }

  OdometerParameters p_;
  int scale_;
  double counted_s_ = 0.0, distance_m_ = 0.0;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_odometer(const ModelParameters& own, const MeasurementSetup& at) {
  return std::make_unique<OdometerSpeed>(own.get<OdometerParameters>(), at.state);
}

void odometer_parameters(ModelParameters& section) {
  section.add<OdometerParameters>();
}

}  // namespace canyon::fusion
