#include <algorithm>
#include <cmath>

#include "canyon/mission/autonomy/planning/tracker.h"

namespace canyon::mission {
namespace {

struct PurePursuitParameters {
  double lookahead_s = 0.8;
  double lookahead_min_m = 2.5;
  double lookahead_max_m = 5.0;
};
void visit(FieldVisitor& f, PurePursuitParameters& p) {
  f.number("lookahead_s", p.lookahead_s, {0.1, 5}, "pure_pursuit: it steers for the point so far ahead in time");
  f.number("lookahead_min_m", p.lookahead_min_m, {0.5, 20}, "pure_pursuit: but no nearer");
  f.number("lookahead_max_m", p.lookahead_max_m, {0.5, 50}, "pure_pursuit: and no farther");
}

/// The arc that is tangent to the rear axle's heading and leads to a point of the line (Coulter 1992).
class PurePursuit final : public Tracker {
 public:
  explicit PurePursuit(const PurePursuitParameters& p) : p_(p) {}

  double curvature_1_m(const PlanLine& line, std::size_t nearest, const PlanPose& body,
                       double speed_m_s) const override {
    const double least = std::min(p_.lookahead_min_m, p_.lookahead_max_m);
    const double ahead_m = std::clamp(p_.lookahead_s * speed_m_s, least, p_.lookahead_max_m);
    const Eigen::Vector2d d = line.at(nearest + points(ahead_m)) - body.p_m, u = body.forward();
    const double ahead = u.dot(d), left = u.x() * d.y() - u.y() * d.x(), distance2 = d.squaredNorm();
    if (distance2 < 0.25) return 0.0;
    if (ahead < 0.0) return left >= 0.0 ? kTurnAround_1_m : -kTurnAround_1_m;
    return 2.0 * left / distance2;
  }

 private:
  static constexpr double kTurnAround_1_m = 1.0;  // full lock where the line lies behind
  static std::size_t points(double way_m) {
    return static_cast<std::size_t>(std::lround(way_m / PlanLine::kSpacing_m));
  }

  PurePursuitParameters p_;
};

}  // namespace

std::unique_ptr<Tracker> make_pure_pursuit(const ModelParameters& own, const KnownVehicle&) {
  return std::make_unique<PurePursuit>(own.get<PurePursuitParameters>());
}

Lookahead pure_pursuit_lookahead(const ModelParameters& own) {
  const auto& p = own.get<PurePursuitParameters>();
  return {p.lookahead_min_m, p.lookahead_max_m};
}

void pure_pursuit_parameters(ModelParameters& section) {
  section.add<PurePursuitParameters>();
}

}  // namespace canyon::mission
