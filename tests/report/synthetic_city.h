#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace canyon::testing {

/// A made-up city of square blocks, one kilometre wide, tall towards its middle, and a drive through it: what a
/// synthetic results directory plays in. Everything follows from the seed.
struct SyntheticCity {
  struct House {
    Eigen::Vector2d min, max;
    double height_m;
  };
  explicit SyntheticCity(std::uint64_t seed);

  double half_m = 500;
  double block_m = 90;
  double street_m = 12;
  std::vector<House> houses;
  std::vector<Eigen::Vector2d> route;

  struct Stop {
    double at_m;  ///< along the route
    bool mission;
  };
  std::vector<Stop> waypoints;

  double route_length_m() const;
  Eigen::Vector2d at(double along_m) const;
  /// Direction of travel, rad from east.
  double yaw_rad(double along_m) const;
  /// Greatest height of a house within 45 m: how deep the street canyon is.
  double canyon_m(const Eigen::Vector2d& p) const;

  nlohmann::ordered_json scene_json() const;
  nlohmann::ordered_json mission_json() const;
};

}  // namespace canyon::testing
