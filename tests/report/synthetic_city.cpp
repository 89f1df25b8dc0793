#include "canyon/tests/report/synthetic_city.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/random/random.h"

namespace canyon::testing {
namespace {

using nlohmann::ordered_json;

ordered_json xy(const Eigen::Vector2d& p) {
  return {std::round(100 * p.x()) / 100, std::round(100 * p.y()) / 100};
}

}  // namespace

SyntheticCity::SyntheticCity(std::uint64_t seed) {
  const RandomStream random(seed, "synthetic.city");
  std::uint32_t n = 0;
  for (int i = -5; i < 5; ++i) {
    for (int j = -5; j < 5; ++j) {
      const Eigen::Vector2d corner = block_m * Eigen::Vector2d(i, j) + Eigen::Vector2d::Constant(0.5 * street_m + 3);
      const double inner_m = block_m - street_m - 6;
      const double centre_m = (corner + Eigen::Vector2d::Constant(0.5 * inner_m)).norm();
      for (int k = 0; k < 4; ++k, ++n) {
        if (random.uniform(n, 0) < 0.12) continue;  // a yard
        const Eigen::Vector2d cell = corner + 0.5 * inner_m * Eigen::Vector2d(k % 2, k / 2);
        const Eigen::Vector2d size =
            (0.5 * inner_m - 4) * Eigen::Vector2d(random.uniform(0.65, 1.0, n, 1), random.uniform(0.65, 1.0, n, 2));
        const double tall_m = 70 * std::exp(-centre_m * centre_m / (2 * 170 * 170));
        houses.push_back({cell, cell + size, random.uniform(4, 14, n, 3) + tall_m * random.uniform(0.4, 1.0, n, 4)});
      }
    }
  }
  for (const auto& [i, j] :
       {std::pair{-4, -3}, {-4, -1}, {-2, -1}, {-2, 1}, {1, 1}, {1, 3}, {3, 3}, {3, 0}, {1, 0}, {1, -3}, {3, -3}}) {
    route.push_back(block_m * Eigen::Vector2d(i, j));
  }
  const double length_m = route_length_m();
  for (int k = 1; k <= 11; ++k) waypoints.push_back({length_m * k / 11.0, k == 7 || k == 9 || k == 11});
}

double SyntheticCity::route_length_m() const {
  double length_m = 0;
  for (std::size_t i = 1; i < route.size(); ++i) length_m += (route[i] - route[i - 1]).norm();
  return length_m;
}

Eigen::Vector2d SyntheticCity::at(double along_m) const {
  for (std::size_t i = 1; i < route.size(); ++i) {
    const double length_m = (route[i] - route[i - 1]).norm();
    if (along_m <= length_m || i + 1 == route.size()) {
      return route[i - 1] + std::min(along_m / length_m, 1.0) * (route[i] - route[i - 1]);
    }
    along_m -= length_m;
  }
  return route.back();
}

double SyntheticCity::yaw_rad(double along_m) const {
  const Eigen::Vector2d d = at(along_m + 2) - at(std::max(0.0, along_m - 2));
  return std::atan2(d.y(), d.x());
}

double SyntheticCity::canyon_m(const Eigen::Vector2d& p) const {
  double height_m = 0;
  for (const House& h : houses) {
    const Eigen::Vector2d nearest = p.cwiseMax(h.min).cwiseMin(h.max);
    if ((nearest - p).norm() < 45) height_m = std::max(height_m, h.height_m);
  }
  return height_m;
}

ordered_json SyntheticCity::scene_json() const {
  ordered_json out;
  out["extent_m"] = {{"min", {-half_m, -half_m, -5.0}}, {"max", {half_m, half_m, 110.0}}};
  out["buildings"] = ordered_json::array();
  for (std::size_t i = 0; i < houses.size(); ++i) {
    const House& h = houses[i];
    out["buildings"].push_back(
        {{"name", "building " + std::to_string(i + 1)},
         {"base_m", 0.0},
         {"height_m", h.height_m},
         {"footprint", {xy(h.min), xy({h.max.x(), h.min.y()}), xy(h.max), xy({h.min.x(), h.max.y()})}}});
  }
  out["streets"] = ordered_json::array();
  for (int i = -5; i <= 5; ++i) {
    const double at_m = block_m * i;
    out["streets"].push_back({{"a", {at_m, -half_m}}, {"b", {at_m, half_m}}, {"width_m", street_m}});
    out["streets"].push_back({{"a", {-half_m, at_m}}, {"b", {half_m, at_m}}, {"width_m", street_m}});
  }
  const RandomStream random(7, "synthetic.trees");
  out["trees"] = ordered_json::array();
  out["vehicles"] = ordered_json::array();
  for (std::uint32_t i = 0; i < 260; ++i) {
    const double along_m = random.uniform(-half_m, half_m, i, 0);
    const double street = block_m * std::floor(random.uniform(-5, 6, i, 1)) + (i % 2 ? 1 : -1) * (0.5 * street_m + 1.5);
    const Eigen::Vector2d p = i % 4 < 2 ? Eigen::Vector2d(along_m, street) : Eigen::Vector2d(street, along_m);
    if (i % 3 == 0) {
      out["vehicles"].push_back(xy(p));
    } else {
      out["trees"].push_back({xy(p)[0], xy(p)[1], std::round(10 * random.uniform(1.5, 3.5, i, 2)) / 10});
    }
  }
  return out;
}

ordered_json SyntheticCity::mission_json() const {
  ordered_json out{{"name", "recon"},
                   {"seed", 42},
                   {"start", "2010-07-01T13:00:00.000"},
                   {"nominal_duration_s", route_length_m() / 4 + 60},
                   {"time_limit_s", 1.5 * (route_length_m() / 4 + 60)}};
  out["route"] = ordered_json::array();
  for (const Eigen::Vector2d& p : route) out["route"].push_back(xy(p));
  out["waypoints"] = ordered_json::array();
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const Eigen::Vector2d p = at(waypoints[i].at_m);
    ordered_json w{{"name", std::to_string(i + 1)},
                   {"x_m", p.x()},
                   {"y_m", p.y()},
                   {"mission", waypoints[i].mission},
                   {"building", nullptr}};
    if (waypoints[i].mission) {
      std::size_t nearest = 0;
      const auto distance = [&](std::size_t k) { return (0.5 * (houses[k].min + houses[k].max) - p).norm(); };
      for (std::size_t k = 1; k < houses.size(); ++k) {
        if (distance(k) < distance(nearest)) nearest = k;
      }
      w["building"] = "building " + std::to_string(nearest + 1);
    }
    out["waypoints"].push_back(w);
  }
  return out;
}

}  // namespace canyon::testing
