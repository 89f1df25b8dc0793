#pragma once

#include <vector>

#include "canyon/scene/city/plan.h"

namespace canyon::scene::city {

/// One side of one street, with coordinates along it and across it (0 at the centre line, positive to its own side).
struct Kerb {
  Eigen::Vector2d start, along, across;
  double length_m;
  Zone zone;  ///< of the block behind it

  Eigen::Vector2d at(double along_m, double across_m) const { return start + along_m * along + across_m * across; }
};

/// Two kerbs per street; the entity of their random draws is their place in this list.
std::vector<Kerb> kerbs(const Plan& plan);

}  // namespace canyon::scene::city
