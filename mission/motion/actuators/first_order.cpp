// Actuators that answer like a first-order lag with a largest rate.
#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/mission/motion/actuators/actuator.h"

namespace canyon::mission {
namespace {

struct LaggedSteeringParameters {
  double steering_lag_s = 0.1;
};
void visit(FieldVisitor& f, LaggedSteeringParameters& c) {
  f.number("steering_lag_s", c.steering_lag_s, {0, 2}, "steering first_order: time constant");
}

struct LaggedDriveParameters {
  double drive_lag_s = 0.3;
  double max_jerk_m_s3 = 10.0;
};
void visit(FieldVisitor& f, LaggedDriveParameters& c) {
  f.number("drive_lag_s", c.drive_lag_s, {0, 2}, "drive first_order: time constant of acceleration and brakes");
  f.number("max_jerk_m_s3", c.max_jerk_m_s3, {0.1, 1000}, "drive first_order: largest rate of the acceleration");
}

class FirstOrder final : public Actuator {
 public:
  FirstOrder(double lag_s, double most_per_s) : lag_s_(lag_s), most_per_s_(most_per_s) {}
  double after(double now, double wanted, double dt_s) const override {
    return first_order_after(now, wanted, dt_s, lag_s_, most_per_s_);
  }
  double lag_s() const override { return lag_s_; }

 private:
  double lag_s_, most_per_s_;
};

}  // namespace

double first_order_after(double now, double wanted, double dt_s, double lag_s, double most_per_s) {
  CANYON_CHECK(dt_s > 0.0 && lag_s >= 0.0 && most_per_s > 0.0, "dt_s = ", dt_s, ", lag_s = ", lag_s,
               ", most_per_s = ", most_per_s);
  const double missing = wanted - now, slow = most_per_s * lag_s;  // less than `slow` is missing: no limit any more
  const double at_limit_s = std::max(0.0, (std::abs(missing) - slow) / most_per_s);
  if (at_limit_s >= dt_s) return now + std::copysign(most_per_s * dt_s, missing);
  if (lag_s == 0.0) return wanted;
  const double left = at_limit_s > 0.0 ? std::copysign(slow, missing) : missing;
  return wanted - left * std::exp(-(dt_s - at_limit_s) / lag_s);
}

std::unique_ptr<Actuator> make_lagged_steering(const ModelParameters& own, double most_per_s) {
  return std::make_unique<FirstOrder>(own.get<LaggedSteeringParameters>().steering_lag_s, most_per_s);
}

std::unique_ptr<Actuator> make_lagged_drive(const ModelParameters& own, double) {
  const auto& p = own.get<LaggedDriveParameters>();
  return std::make_unique<FirstOrder>(p.drive_lag_s, p.max_jerk_m_s3);
}

void lagged_steering_parameters(ModelParameters& section) {
  section.add<LaggedSteeringParameters>();
}

void lagged_drive_parameters(ModelParameters& section) {
  section.add<LaggedDriveParameters>();
}

}  // namespace canyon::mission
