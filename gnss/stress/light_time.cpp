// Light time, the turning of the Earth while the signal travels, and the range's rate.
#include <cmath>
#include <limits>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/solver/velocity.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;
const GpsTime kReceived = GpsTime::from_week_sow(1617, 388800.0);
const SatelliteId kSv{GnssSystem::kGps, 1};
const Eigen::Vector3d kAntenna(-0.8e6, -5.3e6, 3.4e6);

using Vector3L = Eigen::Matrix<long double, 3, 1>;

/// One satellite that flies straight on in the frame that does not turn and coincides with E at kReceived, so that the
/// light time is the root of a quadratic.
class Straight final : public Constellation {
 public:
  Straight(const Eigen::Vector3d& p, const Eigen::Vector3d& v, double clock_s = 0.0)
      : p_(p), v_(v), clock_s_(clock_s) {}
  const std::vector<SatelliteId>& satellites() const override { return satellites_; }
  std::optional<SatelliteState> state(SatelliteId, GpsTime t) const override {
    const double s = t - kReceived;
    const Eigen::Vector3d p = p_ + s * v_;
    SatelliteState out;
    out.p_E = turned(p, s);
    out.v_E = turned(v_, s) + kGpsEarthRate * Eigen::Vector3d(out.p_E.y(), -out.p_E.x(), 0.0);
    out.clock_s = clock_s_;
    return out;
  }
  /// From the frame at rest to E, s after kReceived.
  static Eigen::Vector3d turned(const Eigen::Vector3d& p, double s) {
    const double c = std::cos(kGpsEarthRate * s), d = std::sin(kGpsEarthRate * s);
    return {c * p.x() + d * p.y(), -d * p.x() + c * p.y(), p.z()};
  }
  /// Travel time of the signal that meets, s after kReceived, a receiver that stands still in E at r:
  /// |p + v (s - tau) - R(s) r| = c tau.
  long double travel_s(const Eigen::Vector3d& r_E, long double s = 0.0L) const {
    const long double a = kGpsEarthRate * s, c = cosl(a), d = sinl(a);
    const Vector3L r(c * r_E.x() - d * r_E.y(), d * r_E.x() + c * r_E.y(), r_E.z());
    const Vector3L v = v_.cast<long double>(), w = p_.cast<long double>() + s * v - r;
    const long double light = kSpeedOfLight, A = light * light - v.squaredNorm(), B = w.dot(v);
    return (-B + sqrtl(B * B + A * w.squaredNorm())) / A;
  }

 private:
  Eigen::Vector3d p_, v_;
  double clock_s_;
  std::vector<SatelliteId> satellites_{kSv};
};

Eigen::Vector3d place(int k, double radius_m) {
  const double up = 1.0 - 2.0 * (k + 0.5) / 12.0, turn = 2.4 * k, level = std::sqrt(1.0 - up * up);
  return radius_m * Eigen::Vector3d(level * std::cos(turn), level * std::sin(turn), up);
}

/// Worst range error over twelve places and two directions of flight. The documented 1e-5 m, and the time of
/// transmission, which is a whole nanosecond: half of one times the speed.
StressFigure light_time(double radius_m, double speed_m_s) {
  StressFigure out{0.0, 1e-5 + 0.5e-9 * speed_m_s};
  for (int k = 0; k < 12; ++k)
    for (const double sense : {1.0, -1.0}) {
      const Straight one(place(k, radius_m), sense * speed_m_s * place(5 * k % 12, 1.0));
      const auto found = transmission_to(one, kSv, kReceived, kAntenna);
      take_worst(out, std::abs(found->range_m - static_cast<double>(one.travel_s(kAntenna) * kSpeedOfLight)));
      take_worst(out, std::abs(found->travel_s * kSpeedOfLight - found->range_m));
    }
  return out;
}

/// Against Sagnac's closed form w / c (x_s y_r - y_s x_r) of a satellite at rest in E, whose remainder is of second
/// order: (w tau)^2 |p_s| |p_r| / (2 range), and the 1e-5 m documented.
StressFigure sagnac(double longitude_deg) {
  const Eigen::Vector3d r(6.378e6, 0.0, 0.0);
  const double a = longitude_deg * kDegree, radius_m = 42.164e6;
  const Eigen::Vector3d p(radius_m * std::cos(a), radius_m * std::sin(a), 0.0);
  class Fixed final : public Constellation {
   public:
    explicit Fixed(const Eigen::Vector3d& at) { state_.p_E = at; }
    const std::vector<SatelliteId>& satellites() const override { return satellites_; }
    std::optional<SatelliteState> state(SatelliteId, GpsTime) const override { return state_; }

   private:
    SatelliteState state_;
    std::vector<SatelliteId> satellites_{kSv};
  };
  const double still_m = (p - r).norm();
  const double closed_m = still_m + kGpsEarthRate / kSpeedOfLight * (p.x() * r.y() - p.y() * r.x());
  const double turn = kGpsEarthRate * still_m / kSpeedOfLight;
  const auto found = transmission_to(Fixed(p), kSv, kReceived, r);
  return {std::abs(found->range_m - closed_m), 1e-5 + turn * turn * p.norm() * r.norm() / still_m};
}

/// Place found from a pseudorange whose receiver clock is off by `off_s`: the same as without, but for nanoseconds at
/// 4 km/s, and the satellite clock's rounding.
StressFigure from_pseudorange(double off_s) {
  const double satellite_clock_s = 1e-3;
  const Straight one(place(3, 26.56e6), {3.0e3, -2.0e3, 1.5e3}, satellite_clock_s);
  const auto sent = transmission_to(one, kSv, kReceived, kAntenna);
  const double pseudorange_m = sent->range_m + kSpeedOfLight * (off_s - satellite_clock_s);
  const auto seen = transmission_from_pseudorange(one, kSv, kReceived + off_s, pseudorange_m);
  // Two rounded instants, the pseudorange's own digits (eps c off), and the light time's 1e-5 m of range (33 fs).
  const double time_s = 1.5e-9 + 4.0 * kEpsilon * std::abs(off_s);
  return {(seen->state.p_E - sent->state.p_E).norm(), 4.5e3 * time_s};
}

/// Range rate against the central difference of the exact range. "Exact" by its docstring; what is left are roundings:
/// each of some 64 operations by eps of the satellite's speed in E.
StressFigure rate(double speed_m_s) {
  StressFigure out{0.0, 64.0 * kEpsilon * (speed_m_s + kGpsEarthRate * 26.56e6)};
  for (int k = 0; k < 12; ++k) {
    const Straight one(place(k, 26.56e6), speed_m_s * place(7 * k % 12, 1.0));
    const auto range_m = [&](long double s) {
      return one.travel_s(kAntenna, s) * static_cast<long double>(kSpeedOfLight);
    };
    constexpr long double h = 0.25L;
    const long double slope = (8 * (range_m(h) - range_m(-h)) - (range_m(2 * h) - range_m(-2 * h))) / (12 * h);
    // At the exact instant of transmission, which GpsTime would round.
    const double s = -static_cast<double>(one.travel_s(kAntenna));
    const Eigen::Vector3d v = speed_m_s * place(7 * k % 12, 1.0);
    RateMeasurement m;
    m.p_E = Straight::turned(place(k, 26.56e6) + s * v, s);
    m.v_E = Straight::turned(v, s) + kGpsEarthRate * Eigen::Vector3d(m.p_E.y(), -m.p_E.x(), 0.0);
    take_worst(out, std::abs(range_rate_m_s(m, kAntenna, Eigen::Vector3d::Zero()) - static_cast<double>(slope)));
  }
  return out;
}

}  // namespace

std::vector<StressCase> light_time_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "light time of a satellite that moves fast or stands near",
           "a fixed number of passes from 75 ms: each gains a factor of v / c only",
           "root of a quadratic; 1e-5 m as documented, and 0.5 ns of the instant times the speed", "m"});
  rows.add("light_time/medium_orbit_4_km_s", [] { return light_time(26.56e6, 4e3); })
      .add("light_time/geostationary_3_km_s", [] { return light_time(42.2e6, 3.1e3); })
      .add("light_time/low_orbit_8_km_s", [] { return light_time(6.9e6, 8e3); })
      .add("light_time/far_1e8_m_at_rest", [] { return light_time(1e8, 0.0); });

  rows.of({StressGroup::kGeometry, "the Earth turns while the signal travels",
           "the sign of the turn, or the turn applied about the wrong instant: 30 m at the horizon",
           "Sagnac's w / c (x_s y_r - y_s x_r), remainder (w tau)^2 p_s p_r / range", "m"});
  for (const double lon : {-80.0, -45.0, 0.0, 45.0, 80.0})
    rows.add(
        "light_time/sagnac_at_" + std::string(lon < 0 ? "west_" : "east_") + std::to_string(std::lround(std::abs(lon))),
        [lon] { return sagnac(lon); });

  rows.of({StressGroup::kLong, "a receiver clock far off",
           "the satellite is placed by the receiver's reading instead of its own: 4 m for each millisecond",
           "the same place whatever the clock: nanoseconds of the instants times 4.5 km/s", "m"});
  for (const double off : {0.0, 1e-3, -1.0, 86400.0})
    rows.add("light_time/receiver_clock_off_" + std::string(off < 0 ? "minus_" : "") +
                 std::to_string(std::lround(std::abs(off) * 1e3)) + "_ms",
             [off] { return from_pseudorange(off); });

  rows.of({StressGroup::kGeometry, "range rate of a fast satellite",
           "the change of the travel time or the turning of E neglected: 2 cm/s",
           "derivative of the exact range to 64 eps of the speed in E", "m/s"});
  for (const double v : {0.0, 4e3, 3e4})
    rows.add("light_time/range_rate_at_" + std::to_string(std::lround(v)) + "_m_s", [v] { return rate(v); });
  return rows.take();
}

}  // namespace canyon::gnss
