#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "canyon/core/config/config.h"
#include "canyon/core/messages.h"
#include "canyon/core/truth.h"
#include "canyon/inertial/errors/markov_process.h"

namespace canyon::inertial {

/// The encoder of an unsteered wheel.
struct OdometerConfig {
  double rate_hz = 50.0;
  Eigen::Vector3d wheel_m{0.0, 0.8, 0.0};  ///< the wheel's contact point in B
  double metres_per_tick = 0.02;           ///< of the nominal wheel
  double scale_percent = 0.5;              ///< error of the wheel's radius, 1-sigma, constant over a run
  double slip_percent = 0.2;               ///< slip at steady speed, stationary 1-sigma of a Gauss-Markov process
  double slip_tau_s = 5.0;                 ///< its correlation time
  double slip_percent_per_m_s2 = 0.5;      ///< slip that acceleration needs; braking makes it negative
};
void visit(FieldVisitor& f, OdometerConfig& c);

class Odometer {
 public:
  Odometer(const OdometerConfig& config, std::uint64_t seed);

  struct Reading {
    OdometerSample message;
    OdometerTruth truth;
  };
  /// Sample k over (nodes.front().t, nodes.back().t]: `nodes` are equally spaced states of the true motion, an odd
  /// number of at least 3 (Simpson's rule). Slip (until draw_anew) and scale depend on (seed, k) alone; the count goes
  /// on from the turning so far, so samples must be asked for in order.
  Reading sample(std::int64_t k, std::span<const KinematicState> nodes);

  /// From the next sample on the slip at steady speed, correlated as it is, is another draw, and jumps to it by 0.3 %
  /// or so (1-sigma); the wheel's radius stays.
  void draw_anew(std::uint64_t noise_seed);

 private:
  OdometerConfig config_;
  double scale_;
  MarkovProcess slip_;
  double turned_ticks_;  ///< since the encoder's last edge before the first sample
  std::int64_t next_ = 0;
};

}  // namespace canyon::inertial
