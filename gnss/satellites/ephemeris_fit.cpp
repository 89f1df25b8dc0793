#include "gnss/satellites/ephemeris_fit.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "core/units.h"
#include "gnss/satellites/system_constants.h"

namespace canyon::gnss {
namespace {

constexpr double kHalfIntervalS = 2.0 * 3600.0, kStepS = 300.0, kToeStepS = 7200.0;
constexpr int kLeastSamples = 25;
constexpr int kUnknowns = 15;
constexpr double kGeostationaryInclination = 15.0 * kDegree, kGeostationaryRadius_m = 40e6;
using Vector15 = Eigen::Matrix<double, kUnknowns, 1>;

/// Steps of the unknowns that each move a satellite by about 10 m: scale of the problem and of its differences.
const Vector15& scales() {
  static const Vector15 s =
      (Vector15() << 1e-3, 4e-7, 4e-7, 4e-7, 4e-7, 4e-7, 5e-11, 5e-11, 5e-11, 4e-7, 4e-7, 10.0, 10.0, 4e-7, 4e-7)
          .finished();
  return s;
}

/// Unknowns that stay regular for circular orbits: sqrt(a), e cos w, e sin w, i, node, M + w, then the rates and the
/// six harmonics as the record has them.
KeplerEphemeris record_of(const Vector15& x, const KeplerEphemeris& frame) {
  KeplerEphemeris k = frame;
  k.sqrt_a = x[0];
  k.e = std::hypot(x[1], x[2]);
  k.argument_of_perigee_rad = k.e > 0.0 ? std::atan2(x[2], x[1]) : 0.0;
  k.i0_rad = x[3];
  k.omega0_rad = x[4];
  k.m0_rad = x[5] - k.argument_of_perigee_rad;
  k.delta_n_rad_s = x[6];
  k.omega_dot_rad_s = x[7];
  k.idot_rad_s = x[8];
  k.cuc_rad = x[9], k.cus_rad = x[10], k.crc_m = x[11], k.crs_m = x[12], k.cic_rad = x[13], k.cis_rad = x[14];
  return k;
}

/// Osculating elements at toe.
Vector15 first_guess(const SatelliteState& state, GpsTime toe, const SystemConstants& c) {
  const Eigen::Vector3d rate(0.0, 0.0, c.earth_rate_rad_s);
  const Eigen::Vector3d p = state.p_E, v = state.v_E + rate.cross(state.p_E);
  const Eigen::Vector3d momentum = p.cross(v);
  const double r = p.norm(), a = 1.0 / (2.0 / r - v.squaredNorm() / c.mu_m3_s2);
  const Eigen::Vector3d eccentricity = v.cross(momentum) / c.mu_m3_s2 - p / r;
  const double inclination = std::acos(momentum.z() / momentum.norm());
  const double node = std::atan2(momentum.x(), -momentum.y());
  const Eigen::Vector3d to_node(std::cos(node), std::sin(node), 0.0);
  const Eigen::Vector3d across = momentum.normalized().cross(to_node);
  const double k = eccentricity.dot(to_node), h = eccentricity.dot(across);
  // True argument of latitude to mean longitude, through the eccentric anomaly.
  const double u = std::atan2(p.dot(across), p.dot(to_node)), e = std::hypot(h, k),
               w = e > 0.0 ? std::atan2(h, k) : 0.0;
  const double anomaly = std::atan2(std::sqrt(1.0 - e * e) * std::sin(u - w), e + std::cos(u - w));
  Vector15 x = Vector15::Zero();
  x.head<6>() << std::sqrt(a), k, h, inclination, node + c.earth_rate_rad_s * (toe - c.ahead_s).sow_s(),
      anomaly - e * std::sin(anomaly) + w;
  return x;
}

NavigationMessage message_of(GnssSystem system) {
  if (system == GnssSystem::kGalileo) return NavigationMessage::kInav;
  if (system == GnssSystem::kBeidou) return NavigationMessage::kD1;
  return NavigationMessage::kLnav;
}

void set_group_delays(const SatelliteState& state, KeplerEphemeris& k) {
  const auto& d = state.group_delay_s;
  switch (k.sv.system) {
    case GnssSystem::kGalileo:
      k.tgd2_s = k.tgd_s = d[1];
      break;
    case GnssSystem::kBeidou:
      k.tgd_s = d[2];
      k.tgd2_s = d[7];
      break;
    default:
      k.tgd_s = d[1];
  }
}

/// Straight line through the clock without the periodic relativity, which the record computes for itself.
void fit_clock(const std::vector<std::pair<GpsTime, SatelliteState>>& samples, KeplerEphemeris& k) {
  k.af0_s = k.af1 = 0.0;
  double n = 0, t = 0, tt = 0, y = 0, ty = 0;
  for (const auto& [at, state] : samples) {
    const double dt = at - k.toc, clock = state.clock_s - k.at(at).clock_s;
    n += 1.0, t += dt, tt += dt * dt, y += clock, ty += dt * clock;
  }
  k.af1 = (n * ty - t * y) / (n * tt - t * t);
  k.af0_s = (y - k.af1 * t) / n;
}

}  // namespace

std::optional<FittedEphemeris> fit_ephemeris(const Constellation& constellation, SatelliteId sv, GpsTime toe) {
  if (sv.system == GnssSystem::kGlonass || sv.system == GnssSystem::kSbas) return std::nullopt;
  const auto middle = constellation.state(sv, toe);
  if (!middle) return std::nullopt;
  std::vector<std::pair<GpsTime, SatelliteState>> samples;
  for (double dt = -kHalfIntervalS; dt <= kHalfIntervalS; dt += kStepS)
    if (const auto state = constellation.state(sv, toe + dt)) samples.emplace_back(toe + dt, *state);
  if (static_cast<int>(samples.size()) < kLeastSamples) return std::nullopt;

  const SystemConstants& constants = constants_of(sv.system);
  KeplerEphemeris frame;
  frame.sv = sv;
  frame.message = message_of(sv.system);
  frame.toe = frame.toc = toe;
  const Validity validity = default_validity(sv.system, frame.message);
  frame.valid_before_s = validity.before_s;
  frame.valid_after_s = validity.after_s;
  Vector15 x = first_guess(*middle, toe, constants);
  if (x[3] < kGeostationaryInclination && x[0] * x[0] > kGeostationaryRadius_m) return std::nullopt;

  const auto rows = static_cast<Eigen::Index>(3 * samples.size());
  Eigen::VectorXd residual(rows);
  const auto evaluate = [&](const Vector15& at, Eigen::VectorXd& out) {
    const KeplerEphemeris k = record_of(at, frame);
    for (std::size_t i = 0; i < samples.size(); ++i)
      out.segment<3>(static_cast<Eigen::Index>(3 * i)) = samples[i].second.p_E - k.at(samples[i].first).p_E;
  };
  // Over a third of a revolution the harmonics nearly repeat what the elements can do; singular directions that weak
  // are left alone.
  for (int iteration = 0; iteration < 6; ++iteration) {
    evaluate(x, residual);
    Eigen::MatrixXd jacobian(rows, kUnknowns);
    Eigen::VectorXd plus(rows), minus(rows);
    for (int j = 0; j < kUnknowns; ++j) {
      Vector15 a = x, b = x;
      a[j] += scales()[j];
      b[j] -= scales()[j];
      evaluate(a, plus);
      evaluate(b, minus);
      jacobian.col(j) = 0.5 * (minus - plus);
    }
    Eigen::BDCSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(1e-9);
    const Vector15 step = svd.solve(residual);
    x += step.cwiseProduct(scales());
    if (step.norm() < 1e-7) break;
  }

  FittedEphemeris out;
  out.ephemeris = record_of(x, frame);
  evaluate(x, residual);
  out.rms_m = std::sqrt(residual.squaredNorm() / static_cast<double>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    out.max_m = std::max(out.max_m, residual.segment<3>(static_cast<Eigen::Index>(3 * i)).norm());
  fit_clock(samples, out.ephemeris);
  set_group_delays(*middle, out.ephemeris);
  return out;
}

NavigationData fit_navigation_data(const Constellation& constellation, GpsTime start, GpsTime end) {
  NavigationData data;
  const auto step_ns = static_cast<std::int64_t>(kToeStepS) * kNsPerSecond;
  const std::int64_t first = start.ns / step_ns, last = (end.ns + step_ns - 1) / step_ns;
  for (const SatelliteId sv : constellation.satellites())
    for (std::int64_t k = first; k <= last; ++k)
      if (const auto fitted = fit_ephemeris(constellation, sv, GpsTime{k * step_ns})) {
        data.kepler.push_back(fitted->ephemeris);
        data.kepler.back().iode = static_cast<int>(k % 256);
      }
  data.leap_seconds = start.leap_seconds();
  return data;
}

}  // namespace canyon::gnss
