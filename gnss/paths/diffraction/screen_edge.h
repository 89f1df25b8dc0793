#pragma once

#include <algorithm>
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

  double most() const { return most_; }  ///< |field()| is no more
  /// Fades out where an endless edge, on a way as long as the shortest over this piece, would make from twice the
  /// weakest down to it: pieces of one edge, and the sides of a small figure, which cancel out, go together. What is
  /// faint in itself fades from 6e-3 to 3e-3. In a microsecond, continuous.
  std::complex<double> field(double weakest) const;
  /// Nothing is left of field() there.
  bool is_faded(double weakest) const { return most_ <= kLeast || strength_ <= weakest; }
  /// The weakest to follow where `least` matters. At a shadow's border an edge makes a half, which may not have faded.
  static double followed(double least) { return std::clamp(least, kLeast, 0.25); }
  /// Where the way over the edge is shortest, from its first end on; held within it. Of use where most() > 0.
  double at_m() const { return at_m_; }

 private:
  static constexpr double kLeast = 3e-3;
  double nu_ = 0.0, u1_ = 0.0, u2_ = 0.0, most_ = 0.0, at_m_ = 0.0;
  double strength_ = 0.0;  ///< what that endless edge makes at most
};

}  // namespace canyon::gnss
