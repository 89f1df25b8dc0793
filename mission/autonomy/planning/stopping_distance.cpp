#include <algorithm>
#include <cmath>

#include "canyon/mission/autonomy/planning/speed_rule.h"

namespace canyon::mission {
namespace {

struct StoppingDistanceParameters {
  double reaction_s = 0.3;
  double stop_margin_m = 0.5;
  double assumed_seen_m = 8.0;
};
void visit(FieldVisitor& f, StoppingDistanceParameters& p) {
  f.number("reaction_s", p.reaction_s, {0, 5},
           "stopping_distance: from a thing's standing there to braking: two scans");
  f.number("stop_margin_m", p.stop_margin_m, {0, 20}, "stopping_distance: way kept free beside the clearance");
  f.number("assumed_seen_m", p.assumed_seen_m, {0, 100},
           "stopping_distance: so far ahead it takes the ground, which the lowest beam passes over, for seen");
}

/// v with v tau + v^2 / (2 b) = d: it reacts, then brakes.
class StoppingDistance final : public SpeedRule {
 public:
  explicit StoppingDistance(const StoppingDistanceParameters& p) : p_(p) {}

  double allowed_m_s(const SpeedTask& task) const override {
    constexpr double kCrawl_m_s = 0.1;  // slower is standing
    double v = task.route_m_s;
    if (!task.free_to_end) v = std::min(v, halting_within_m_s(task.free_m - p_.stop_margin_m, task.braking_m_s2));
    v = std::min(v, halting_within_m_s(std::max(task.seen_m, p_.assumed_seen_m), task.braking_m_s2));
    for (std::size_t i = 0; i < task.curvature_1_m.size(); ++i) {
      const double kappa = std::abs(static_cast<double>(task.curvature_1_m[i]));
      if (kappa < 1e-4) continue;
      const double way_m = static_cast<double>(i) * task.step_m;
      const double turning_m_s = std::max(kCrawl_m_s, task.max_yaw_rate_rad_s / kappa);
      const double in_bend2 = std::min(task.lateral_m_s2 / kappa, turning_m_s * turning_m_s);
      v = std::min(v, std::sqrt(in_bend2 + 2.0 * task.braking_m_s2 * way_m));
    }
    return v < kCrawl_m_s ? 0.0 : v;
  }

 private:
  double halting_within_m_s(double distance_m, double braking_m_s2) const {
    if (distance_m <= 0.0) return 0.0;
    const double lost = braking_m_s2 * p_.reaction_s;
    return std::sqrt(lost * lost + 2.0 * braking_m_s2 * distance_m) - lost;
  }

  StoppingDistanceParameters p_;
};

}  // namespace

std::unique_ptr<SpeedRule> make_stopping_distance(const ModelParameters& own) {
  return std::make_unique<StoppingDistance>(own.get<StoppingDistanceParameters>());
}

void stopping_distance_parameters(ModelParameters& section) {
  section.add<StoppingDistanceParameters>();
}

}  // namespace canyon::mission
