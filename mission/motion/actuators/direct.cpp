// Actuators without a lag.
#include <algorithm>

#include "canyon/mission/motion/actuators/actuator.h"

namespace canyon::mission {
namespace {

class RateLimit final : public Actuator {
 public:
  explicit RateLimit(double most_per_s) : most_per_s_(most_per_s) {}
  double after(double now, double wanted, double dt_s) const override {
    return now + std::clamp(wanted - now, -most_per_s_ * dt_s, most_per_s_ * dt_s);
  }

 private:
  double most_per_s_;
};

class DirectDrive final : public Actuator {
 public:
  double after(double, double wanted, double) const override { return wanted; }
};

}  // namespace

std::unique_ptr<Actuator> make_rate_limit(const ModelParameters&, double most_per_s) {
  return std::make_unique<RateLimit>(most_per_s);
}

std::unique_ptr<Actuator> make_direct_drive(const ModelParameters&, double) {
  return std::make_unique<DirectDrive>();
}

}  // namespace canyon::mission
