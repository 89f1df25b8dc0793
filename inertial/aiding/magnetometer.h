#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "canyon/core/config/config.h"
#include "canyon/core/messages.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/truth.h"

namespace canyon::inertial {

/// A three-axis magnetometer, fixed to U. The Earth's field is given, and is the same everywhere in a scene.
struct MagnetometerConfig {
  double rate_hz = 20.0;
  double declination_deg = 0.0;    ///< of the field's horizontal part from true north, east positive
  double inclination_deg = 60.0;   ///< below the horizon, positive
  double strength_ut = 50.0;       ///< microtesla
  double hard_iron_ut = 3.0;       ///< constant field of the vehicle in U, each axis, 1-sigma
  double soft_iron_percent = 2.0;  ///< distortion of the field by the vehicle's iron: each of the six independent terms
                                   ///< of a symmetric matrix, 1-sigma
  double noise_ut_per_sqrt_hz = 0.05;  ///< white, N of IEEE Std 952
  double resolution_ut = 0.0;          ///< step of the output; 0 = none
};
void visit(FieldVisitor& f, MagnetometerConfig& c);

class Magnetometer {
 public:
  Magnetometer(const MagnetometerConfig& config, std::uint64_t seed);

  struct Reading {
    MagnetometerSample message;
    MagnetometerTruth truth;
  };
  /// Sample k >= 0 at the attitude R_WU: (I + soft) R_UW field_W + hard + noise. Depends on (seed, k) and the attitude
  /// alone.
  Reading sample(std::int64_t k, GpsTime t, const Eigen::Quaterniond& R_WU) const;

  /// The Earth's field in W (east, north, up), tesla.
  const Eigen::Vector3d& field_W_t() const { return field_W_t_; }

  /// From the next sample on the white noise is another draw; the iron stays.
  void draw_anew(std::uint64_t noise_seed) { noise_ = RandomStream(noise_seed, "magnetometer.noise"); }

 private:
  MagnetometerConfig config_;
  Eigen::Vector3d field_W_t_;
  Eigen::Vector3d hard_iron_t_;
  Eigen::Matrix3d soft_iron_;  ///< with the identity
  RandomStream noise_;
};

}  // namespace canyon::inertial
