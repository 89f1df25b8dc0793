#pragma once

#include <deque>
#include <functional>
#include <span>

#include "canyon/core/truth.h"

namespace canyon {

/// The true motion of B in W, dense: nodes of exact kinematics, and between two of them the motion that meets position,
/// velocity and acceleration of both ends, so that everything that is asked of it fits together exactly.
///
/// Position is a polynomial of fifth degree in time. Attitude is R(t) = R_0 Exp(phi(t)), phi a polynomial of fifth
/// degree that meets rate and angular acceleration of both ends; rate w = Jr(phi) phi' and angular acceleration
/// Jr(phi) phi'' + Jr(phi)' phi' are its exact derivatives (Jr: right Jacobian of SO(3)). Twice continuously
/// differentiable. A run's vehicle, a recorded tape and a trajectory file all are such nodes, so that a sensor cannot
/// tell them apart, and no sensor's rate has any part in the motion.
class TrueMotion {
 public:
  /// Times must increase strictly, and between two nodes the body must turn by less than 1 rad; throws otherwise.
  void append(const KinematicState& node);
  /// Forgets what lies before t, but keeps the node at or just before it.
  void forget_before(GpsTime t);

  bool empty() const { return nodes_.empty(); }
  GpsTime first() const { return nodes_.front().t; }
  GpsTime last() const { return nodes_.back().t; }
  const KinematicState& last_node() const { return nodes_.back(); }

  /// Kinematics at t within [first, last]; throws outside. At a node: that node, to the bit.
  KinematicState at(GpsTime t) const;

  /// Points of a quadrature over one piece.
  static constexpr int kPoints = 5;
  using Piece = std::array<KinematicState, kPoints>;
  /// Calls `body` for (from, to], cut at the nodes within, in order of time, each piece as kPoints equally spaced
  /// states, both ends included: within a piece the motion is smooth. Stamps are rounded to 1 ns, the states are not.
  void for_each_piece(GpsTime from, GpsTime to, const std::function<void(const Piece&)>& body) const;

 private:
  /// Polynomials of s in [0, 1] over (t of node i, t of node i + 1], coefficients by ascending power.
  struct Segment {
    double duration_s;
    Eigen::Matrix<double, 3, 6> position, rotation;
  };
  static Segment segment(const KinematicState& a, const KinematicState& b);
  static KinematicState evaluate(const KinematicState& a, const Segment& segment, GpsTime t, double s);
  std::size_t segment_before(GpsTime t) const;

  std::deque<KinematicState> nodes_;
  std::deque<Segment> segments_;  ///< segments_[i] joins nodes_[i] and nodes_[i + 1]
};

}  // namespace canyon
