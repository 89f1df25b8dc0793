#include "canyon/mission/autonomy/perception/street_weight.h"

#include <algorithm>
#include <cmath>

namespace canyon::mission {
namespace {

constexpr double kStraight_1_m = 0.01;  // of the route
constexpr double kDoubt = 3.0;  // sigma beyond which the estimate is no longer believed to be as good as it says

}  // namespace

void visit(FieldVisitor& f, StreetSidesParameters& p) {
  f.number("narrowest_m", p.narrowest_m, {1, 50},
           "seen_street, seen_kerbs: sides that are nearer to one another are not the whole street's");
  f.number("widest_m", p.widest_m, {2, 120}, "seen_street, seen_kerbs: sides that are farther apart are no street's");
  f.number("window_m", p.window_m, {4, 60}, "seen_street, seen_kerbs: how far ahead it looks for both sides");
  f.number("slew_m_s", p.slew_m_s, {0.01, 10}, "seen_street, seen_kerbs: how fast it moves the lane");
  f.number("doubt_s", p.doubt_s, {0, 600},
           "seen_street, seen_kerbs: after so long with a street where the estimate's own sigma cannot have it, the "
           "street is right");
}

double StreetWeight::middle_m(const std::optional<double>& seen_m, const LaneTask& task) {
  const double wanted = seen_m ? weight(*seen_m, task.sigma_m, task.dt_s) * *seen_m : 0.0;
  const double most = p_.slew_m_s * task.dt_s;
  middle_ += std::clamp(wanted - middle_, -most, most);
  return middle_;
}

double StreetWeight::weight(double seen_m, double sigma_m, double dt_s) {
  const double own2 = sigma_m_ * sigma_m_;
  double estimate2 = sigma_m * sigma_m;
  const double expected2 = kDoubt * kDoubt * (own2 + estimate2);
  doubted_s_ = seen_m * seen_m > expected2 ? doubted_s_ + dt_s : 0.0;
  if (doubted_s_ > p_.doubt_s) estimate2 += seen_m * seen_m - expected2;
  return estimate2 / (estimate2 + own2);
}

std::optional<double> StreetWeight::between(double left_m, double right_m) const {
  const double width_m = left_m - right_m;
  if (width_m < p_.narrowest_m || width_m > p_.widest_m) return std::nullopt;
  return 0.5 * (left_m + right_m);
}

bool StreetWeight::is_straight(const LaneTask& task) const {
  for (double x = 0.0; x <= p_.window_m; x += 2.0)
    if (std::abs(task.route.curvature(task.s_m + x)) > kStraight_1_m) return false;
  const Eigen::Vector2d u = task.route.direction(task.s_m);
  return u.dot(task.body.forward()) > 0.9;
}

}  // namespace canyon::mission
