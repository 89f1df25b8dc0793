#include "canyon/scene/ground/ground_detail.h"

#include <algorithm>
#include <cmath>

namespace canyon::scene {
namespace {

GroundDetail::Square square_at(const Eigen::Vector2d& p) {
  return {static_cast<std::int32_t>(std::floor(p.x() / GroundDetail::kSquare_m)),
          static_cast<std::int32_t>(std::floor(p.y() / GroundDetail::kSquare_m))};
}

Eigen::Vector2d south_west(const GroundDetail::Square& square) {
  return GroundDetail::kSquare_m * Eigen::Vector2d(square.x, square.y);
}

}  // namespace

void GroundDetail::add(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  constexpr double kFarthest_m = 1e9;  // what an index holds; scenes end long before
  if (!(a.cwiseAbs().maxCoeff() < kFarthest_m) || !(b.cwiseAbs().maxCoeff() < kFarthest_m)) return;
  const int steps = static_cast<int>((b - a).cwiseAbs().maxCoeff() / (0.5 * kSquare_m)) + 1;
  for (int k = 0; k <= steps; ++k) {
    const Square square = square_at(a + (b - a) * k / steps);
    if (noted_.empty() || !(noted_.back() == square)) noted_.push_back(square);
  }
}

std::vector<GroundDetail::Square> GroundDetail::squares() const {
  std::vector<Square> out = noted_;
  std::sort(out.begin(), out.end(),
            [](const Square& a, const Square& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

double nearest_m(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const GroundDetail::Square& square) {
  const Eigen::Vector2d a = south_west(square), b = a.array() + GroundDetail::kSquare_m;
  return (a - high).cwiseMax(low - b).cwiseMax(0.0).norm();
}

double farthest_m(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const GroundDetail::Square& square) {
  const Eigen::Vector2d a = south_west(square), b = a.array() + GroundDetail::kSquare_m;
  return (a - low).cwiseMax(high - b).cwiseMax(0.0).norm();
}

}  // namespace canyon::scene
