#include "canyon/inertial/aiding/magnetometer.h"

#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::inertial {
namespace {

constexpr double kMicrotesla = 1e-6;

Eigen::Matrix3d symmetric_draws(const RandomStream& stream) {
  const Eigen::Vector3d diagonal = stream.normal3(0, 0), beside = stream.normal3(0, 1);
  Eigen::Matrix3d m = diagonal.asDiagonal();
  m(0, 1) = m(1, 0) = beside.x();
  m(0, 2) = m(2, 0) = beside.y();
  m(1, 2) = m(2, 1) = beside.z();
  return m;
}

}  // namespace

void visit(FieldVisitor& f, MagnetometerConfig& c) {
  f.number("rate_hz", c.rate_hz, {0.1, 1000}, "samples per second");
  f.number("declination_deg", c.declination_deg, {-180, 180}, "of the Earth's field from true north, east positive");
  f.number("inclination_deg", c.inclination_deg, {-90, 90}, "of the Earth's field below the horizon");
  f.number("strength_ut", c.strength_ut, {0, 100}, "of the Earth's field, microtesla");
  f.number("hard_iron_ut", c.hard_iron_ut, {0, 1000}, "field of the vehicle, each axis, 1-sigma");
  f.number("soft_iron_percent", c.soft_iron_percent, {0, 50}, "distortion, each term, 1-sigma");
  f.number("noise_ut_per_sqrt_hz", c.noise_ut_per_sqrt_hz, {0, 100},
           "white noise: N of IEEE Std 952, a sheet's one-sided density over sqrt(2)");
  f.number("resolution_ut", c.resolution_ut, {0, 100}, "step of the output; 0 = none");
}

Magnetometer::Magnetometer(const MagnetometerConfig& config, std::uint64_t seed)
    : config_(config), noise_(seed, "magnetometer.noise") {
  const double declination_rad = config.declination_deg * kDegree, inclination_rad = config.inclination_deg * kDegree;
  field_W_t_ = config.strength_ut * kMicrotesla *
               Eigen::Vector3d(std::cos(inclination_rad) * std::sin(declination_rad),
                               std::cos(inclination_rad) * std::cos(declination_rad), -std::sin(inclination_rad));
  hard_iron_t_ = config.hard_iron_ut * kMicrotesla * RandomStream(seed, "magnetometer.hard_iron").normal3(0);
  soft_iron_ = Eigen::Matrix3d::Identity() +
               0.01 * config.soft_iron_percent * symmetric_draws(RandomStream(seed, "magnetometer.soft_iron"));
}

Magnetometer::Reading Magnetometer::sample(std::int64_t k, GpsTime t, const Eigen::Quaterniond& R_WU) const {
  CANYON_CHECK(k >= 0, "sample number = ", k);
  Reading r;
  r.truth = {.t = t, .field_U_t = R_WU.conjugate() * field_W_t_};
  const double sigma_t = config_.noise_ut_per_sqrt_hz * kMicrotesla * std::sqrt(config_.rate_hz);
  r.message.t = t;
  r.message.field_U_t =
      soft_iron_ * r.truth.field_U_t + hard_iron_t_ + sigma_t * noise_.normal3(static_cast<std::uint64_t>(k));
  if (config_.resolution_ut > 0.0) {
    const double step_t = config_.resolution_ut * kMicrotesla;
    for (double& x : r.message.field_U_t) x = step_t * std::round(x / step_t);
  }
  return r;
}

}  // namespace canyon::inertial
