#include <algorithm>
#include <cmath>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/mission/autonomy/planning/tracker.h"

namespace canyon::mission {
namespace {

struct StanleyParameters {
  double decay_s = 1.0;
  double softening_m_s = 1.0;
};
void visit(FieldVisitor& f, StanleyParameters& p) {
  f.number("decay_s", p.decay_s, {0.05, 20}, "stanley: within which what is left to the line falls to 1/e, at speed");
  f.number("softening_m_s", p.softening_m_s, {0.01, 10}, "stanley: added to the speed, so that it is calm when slow");
}

/// Steering angle = heading error + atan(e / (decay time (softening + v))) at the front axle (Hoffmann, Tomlin,
/// Montemerlo and Thrun 2007, equation 5, without its terms for yaw damping and steering lag).
class Stanley final : public Tracker {
 public:
  Stanley(const StanleyParameters& p, const KnownVehicle& vehicle) : p_(p), vehicle_(vehicle) {}

  double curvature_1_m(const PlanLine& line, std::size_t nearest, const PlanPose& body,
                       double speed_m_s) const override {
    const Eigen::Vector2d front = body.p_m + vehicle_.wheelbase_m * body.forward();
    const std::size_t i = line.nearest(front, nearest);
    const Eigen::Vector2d along = line.direction(i), aside = front - line.at(i);
    const double left_of_line = along.x() * aside.y() - along.y() * aside.x();
    const double heading = wrap_pi(std::atan2(along.y(), along.x()) - body.yaw_rad);
    const double steering =
        heading - std::atan(left_of_line / p_.decay_s / (p_.softening_m_s + std::max(0.0, speed_m_s)));
    constexpr double kMost_rad = 1.3;  // the tangent of more says nothing
    return std::tan(std::clamp(steering, -kMost_rad, kMost_rad)) / vehicle_.wheelbase_m;
  }

 private:
  StanleyParameters p_;
  KnownVehicle vehicle_;
};

}  // namespace

std::unique_ptr<Tracker> make_stanley(const ModelParameters& own, const KnownVehicle& vehicle) {
  return std::make_unique<Stanley>(own.get<StanleyParameters>(), vehicle);
}

void stanley_parameters(ModelParameters& section) {
  section.add<StanleyParameters>();
}

}  // namespace canyon::mission
