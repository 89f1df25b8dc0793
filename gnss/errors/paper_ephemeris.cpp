#include <cmath>

#include "canyon/core/units.h"
#include "canyon/gnss/errors/ephemeris_error.h"

namespace canyon::gnss {
namespace {

/// Durst & Goodin (2012), dR_SV: sqrt((1 + sin(lat)/2) 10^x + c^2 10^-18 + k), lat of the satellite above the Earth's
/// equator, R0 its orbit radius, Rref = 26550 km. As printed x = 2 Rref / R0 and k = 0.918: 10 m, always positive.
/// Their table 1 says 1.14 m, which x = 2 (Rref / R0 - 1) and k = 0.0918 give (an inference).
class PaperEphemeris final : public EphemerisError {
 public:
  PaperEphemeris(double exponent_offset, double constant_m2)
      : exponent_offset_(exponent_offset), constant_m2_(constant_m2) {}

  double range_m(SatelliteId, const SatelliteState& satellite, const Eigen::Vector3d&, GpsTime) const override {
    const Eigen::Vector3d& satellite_E = satellite.p_E;
    constexpr double kReferenceRadiusM = 26550e3;
    const double radius_m = satellite_E.norm();
    const double sin_lat = satellite_E.z() / radius_m;
    const double clock_m2 = kSpeedOfLight * kSpeedOfLight * 1e-18;
    return std::sqrt((1.0 + 0.5 * sin_lat) * std::pow(10.0, 2.0 * (kReferenceRadiusM / radius_m - exponent_offset_)) +
                     clock_m2 + constant_m2_);
  }

 private:
  double exponent_offset_, constant_m2_;
};

}  // namespace

std::unique_ptr<EphemerisError> make_paper_printed_ephemeris() {
  return std::make_unique<PaperEphemeris>(0.0, 0.918);
}
std::unique_ptr<EphemerisError> make_paper_corrected_ephemeris() {
  return std::make_unique<PaperEphemeris>(1.0, 0.0918);
}

}  // namespace canyon::gnss
