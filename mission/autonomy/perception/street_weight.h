#pragma once

#include <optional>

#include "canyon/mission/autonomy/perception/lane_reference.h"

namespace canyon::mission {

/// What both sides of a street must be to have a middle, and how that moves the lane: shared by what sees them.
struct StreetSidesParameters {
  double narrowest_m = 5.0;
  double widest_m = 25.0;
  double window_m = 20.0;
  double slew_m_s = 0.5;
  double doubt_s = 3.0;
};
void visit(FieldVisitor& f, StreetSidesParameters& p);

/// How a middle of the street that is seen moves the lane: it is weighed against the estimate by their variances. A
/// middle that the estimate's own sigma cannot explain counts as that much estimate's error: filters that follow
/// reflected signals are surer than right.
class StreetWeight {
 public:
  /// `sigma_m`: 1-sigma of what is seen.
  StreetWeight(const StreetSidesParameters& p, double sigma_m) : p_(p), sigma_m_(sigma_m) {}

  /// Does the route go straight on through the window, and the vehicle along it? Only there has the street a middle.
  bool is_straight(const LaneTask& task) const;
  /// The middle between two sides, left of the route; none where they are too near or too far apart.
  std::optional<double> between(double left_m, double right_m) const;
  /// The lane's middle, left of the route; where nothing is seen it goes back to the route.
  double middle_m(const std::optional<double>& seen_m, const LaneTask& task);

 private:
  double weight(double seen_m, double sigma_m, double dt_s);

  StreetSidesParameters p_;
  double sigma_m_;
  double middle_ = 0.0, doubted_s_ = 0.0;
};

}  // namespace canyon::mission
