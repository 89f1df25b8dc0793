#pragma once

#include <complex>

#include <Eigen/Core>

namespace canyon::gnss {

inline constexpr double kFarEdgeField = 0.2251;  ///< |knife_edge_field(nu)| is no more than this over nu, nor than 1/2

/// How a plane wave passes a straight edge of a thin screen on its way to `to_W`, the image of an antenna or itself,
/// and what that piece of edge makes there: finite_edge_field, relative to the wave. Nothing of one that is not ahead
/// or that the wave runs along. Places in W, m; `towards_W` unit, to where the wave comes from.
class ScreenEdge {
 public:
  ScreenEdge(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const Eigen::Vector3d& to_W,
             const Eigen::Vector3d& towards_W, double wavelength_m);

  static constexpr double kLeast = 3e-3;  ///< field() fades out from twice that down to it
  double most() const { return most_; }   ///< |field()| is no more
  std::complex<double> field() const;     ///< in a microsecond; continuous
  /// Where the way over the edge is shortest, from its first end on; held within it. Of use where most() > 0.
  double at_m() const { return at_m_; }

 private:
  double nu_ = 0.0, u1_ = 0.0, u2_ = 0.0, most_ = 0.0, at_m_ = 0.0;
};

}  // namespace canyon::gnss
