#pragma once

namespace canyon::lidar {

/// Information of a match between two surface elements, n the unit normal of the target's, m of the source's:
/// M = along I + nn n n^T + nm (n m^T + m n^T) + mm m m^T, in units of 1 / (variance along a surface).
struct MatchInformation {
  double along, nn, nm, mm;
};

/// How much thinner an element is across than along, squared: epsilon of Segal, Haehnel and Thrun 2009.
inline constexpr double kSurfaceThickness = 1e-3;
/// A residual across two parallel elements in metres, squared, is this times d^T M d.
inline constexpr double kAcrossScale = 2.0 * kSurfaceThickness;

/// `flat_n`, `flat_m`: 1 - (thickness of the element), 0 where no plane is known; `c` = n . m.
using MatchForm = MatchInformation(double flat_n, double flat_m, double c);

/// M = (C_n + C_m)^-1, C = I - flat n n^T, in closed form (Woodbury): generalized ICP.
inline MatchInformation plane_to_plane(double flat_n, double flat_m, double c) {
  const double a = 1.0 - 0.5 * flat_n, b = 1.0 - 0.5 * flat_m;
  const double quarter = 0.25 / (a * b - 0.25 * c * c * flat_n * flat_m);
  return {0.5, quarter * flat_n * b, quarter * 0.5 * c * flat_n * flat_m, quarter * flat_m * a};
}

/// What along a surface counts that a neighbour was found nearby: hardly anything, but the sums keep their rank.
inline constexpr double kNearby = 1e-3;
/// The distance across the target's plane only.
inline MatchInformation to_target_plane(double flat_n, double, double) {
  return {kNearby, flat_n > 0 ? 1.0 / kAcrossScale : 0.0, 0.0, 0.0};
}

}  // namespace canyon::lidar
