#include "canyon/gnss/satellites/ephemerides/ephemeris_fit.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/Geometry>

#include "canyon/core/math/singular_values.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

constexpr double kHalfIntervalS = 2.0 * 3600.0, kStepS = 300.0, kToeStepS = 7200.0;
constexpr int kLeastSamples = 25;
constexpr int kUnknowns = 15;
constexpr double kStateHalfIntervalS = 450.0, kStateStepS = 90.0, kStateToeStepS = 900.0;  // of GLONASS
constexpr int kLeastStateSamples = 8;
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
  k.omega0_rad = std::remainder(x[4], 2.0 * kPi);
  k.m0_rad = std::remainder(x[5] - k.argument_of_perigee_rad, 2.0 * kPi);
  k.delta_n_rad_s = x[6];
  k.omega_dot_rad_s = x[7];
  k.idot_rad_s = x[8];
  k.cuc_rad = x[9], k.cus_rad = x[10], k.crc_m = x[11], k.crs_m = x[12], k.cic_rad = x[13], k.cis_rad = x[14];
  return k;
}

/// Osculating elements at toe.
Vector15 first_guess(const SatelliteState& state, const KeplerEphemeris& frame, const SystemConstants& c) {
  const Eigen::Vector3d rate(0.0, 0.0, c.earth_rate_rad_s);
  // The frame of a D2 message is inclined by 5 deg.
  const Eigen::AngleAxisd to_frame(frame.geostationary_frame() ? -5.0 * kDegree : 0.0, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d p = to_frame * state.p_E, v = to_frame * (state.v_E + rate.cross(state.p_E));
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
  x.head<6>() << std::sqrt(a), k, h, inclination, node + c.earth_rate_rad_s * (frame.toe - c.ahead_s).sow_s(),
      anomaly - e * std::sin(anomaly) + w;
  return x;
}

NavigationMessage message_of(SatelliteId sv) {
  if (sv.system == GnssSystem::kGalileo) return NavigationMessage::kInav;
  if (sv.system == GnssSystem::kBeidou) return beidou_message(sv.prn);
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

using Samples = std::vector<std::pair<GpsTime, SatelliteState>>;

Samples samples_of(const Constellation& constellation, SatelliteId sv, GpsTime middle, double half_s, double step_s) {
  Samples out;
  for (double dt = -half_s; dt <= half_s; dt += step_s)
    if (const auto state = constellation.state(sv, middle + dt)) out.emplace_back(middle + dt, *state);
  return out;
}

/// Straight line through the clock without what the record, its own clock zero, computes for itself: the periodic
/// relativity. {at `epoch`, rate}.
template <class Record>
std::pair<double, double> clock_line(const Samples& samples, const Record& record, GpsTime epoch) {
  double n = 0, t = 0, tt = 0, y = 0, ty = 0;
  for (const auto& [at, state] : samples) {
    const double dt = at - epoch, clock = state.clock_s - record.at(at).clock_s;
    n += 1.0, t += dt, tt += dt * dt, y += clock, ty += dt * clock;
  }
  const double rate = (n * ty - t * y) / (n * tt - t * t);
  return {(y - rate * t) / n, rate};
}

/// Positions of the samples minus those of the record, three rows each.
template <class Record>
Eigen::VectorXd position_errors(const Samples& samples, const Record& record) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(3 * samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    out.segment<3>(static_cast<Eigen::Index>(3 * i)) = samples[i].second.p_E - record.at(samples[i].first).p_E;
  return out;
}

/// Gauss-Newton in steps of `scales`. Over a part of a revolution some unknowns nearly repeat what others can do;
/// singular directions weaker than 1e-9 are left alone.
template <class Vector, class MakeRecord>
Vector fitted(const Samples& samples, Vector x, const Vector& scales, const MakeRecord& make_record) {
  for (int iteration = 0; iteration < 6; ++iteration) {
    throw_if_cancelled();
    const Eigen::VectorXd residual = position_errors(samples, make_record(x));
    Eigen::MatrixXd jacobian(residual.size(), x.size());
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      Vector plus = x, minus = x;
      plus[j] += scales[j];
      minus[j] -= scales[j];
      jacobian.col(j) =
          0.5 * (position_errors(samples, make_record(minus)) - position_errors(samples, make_record(plus)));
    }
    const Vector step = SingularValues(jacobian).solve(residual, 1e-9);
    x += step.cwiseProduct(scales);
    if (step.norm() < 1e-7) break;
  }
  return x;
}

/// {RMS, greatest} distance, m.
std::pair<double, double> distances_m(const Eigen::VectorXd& errors) {
  double most_m = 0.0;
  for (Eigen::Index i = 0; i < errors.size(); i += 3) most_m = std::max(most_m, errors.segment<3>(i).norm());
  return {std::sqrt(3.0 * errors.squaredNorm() / static_cast<double>(errors.size())), most_m};
}

}  // namespace

std::optional<FittedEphemeris> fit_ephemeris(const Constellation& constellation, SatelliteId sv, GpsTime toe) {
  if (sv.system == GnssSystem::kGlonass || sv.system == GnssSystem::kSbas) return std::nullopt;
  const auto middle = constellation.state(sv, toe);
  if (!middle) return std::nullopt;
  const Samples samples = samples_of(constellation, sv, toe, kHalfIntervalS, kStepS);
  if (static_cast<int>(samples.size()) < kLeastSamples) return std::nullopt;

  KeplerEphemeris frame;
  frame.sv = sv;
  frame.message = message_of(sv);
  frame.toe = frame.toc = toe;
  const Validity validity = default_validity(sv.system, frame.message);
  frame.valid_before_s = validity.before_s;
  frame.valid_after_s = validity.after_s;

  FittedEphemeris out;
  KeplerEphemeris& k = out.ephemeris;
  const auto make_record = [&](const Vector15& x) { return record_of(x, frame); };
  k = make_record(fitted(samples, first_guess(*middle, frame, constants_of(sv.system)), scales(), make_record));
  std::tie(out.rms_m, out.max_m) = distances_m(position_errors(samples, k));
  std::tie(k.af0_s, k.af1) = clock_line(samples, k, k.toc);
  set_group_delays(*middle, k);
  return out;
}

std::optional<FittedStateVector> fit_state_vector(const Constellation& constellation, SatelliteId sv, GpsTime t_b) {
  if (sv.system != GnssSystem::kGlonass) return std::nullopt;
  const auto middle = constellation.state(sv, t_b);
  if (!middle || middle->frequency_channel == kUnknownChannel) return std::nullopt;
  const Samples samples = samples_of(constellation, sv, t_b, kStateHalfIntervalS, kStateStepS);
  if (static_cast<int>(samples.size()) < kLeastStateSamples) return std::nullopt;

  GlonassEphemeris frame;
  frame.sv = sv;
  frame.toe = t_b;
  frame.frequency_channel = middle->frequency_channel;
  using Vector9 = Eigen::Matrix<double, 9, 1>;
  const auto make_record = [&](const Vector9& x) {
    GlonassEphemeris r = frame;
    r.p_E = x.head<3>();
    r.v_E = x.segment<3>(3);
    r.a_E = x.tail<3>();
    return r;
  };
  Vector9 guess, steps;
  guess << middle->p_E, middle->v_E, Eigen::Vector3d::Zero();
  steps << Eigen::Vector3d::Constant(10.0), Eigen::Vector3d::Constant(0.03), Eigen::Vector3d::Constant(1e-4);

  FittedStateVector out;
  GlonassEphemeris& r = out.ephemeris;
  r = make_record(fitted(samples, guess, steps, make_record));
  std::tie(out.rms_m, out.max_m) = distances_m(position_errors(samples, r));
  std::tie(r.clock_s, r.clock_rate) = clock_line(samples, r, t_b);
  r.delta_tau_s = middle->group_delay_s[2] - middle->group_delay_s[1];
  return out;
}

NavigationData fit_navigation_data(const Constellation& constellation, const std::vector<SatelliteId>& satellites,
                                   GpsTime start, GpsTime end) {
  NavigationData data;
  data.leap_seconds = start.leap_seconds();
  const auto grid = [](GpsTime t, double step_s, bool up) {
    const auto step_ns = static_cast<std::int64_t>(step_s) * kNsPerSecond;
    return (t.ns + (up ? step_ns - 1 : 0)) / step_ns;
  };
  for (const SatelliteId sv : satellites) {
    if (sv.system == GnssSystem::kGlonass) {
      const double leap_s = start.leap_seconds();
      for (std::int64_t k = grid(start - leap_s, kStateToeStepS, false); k <= grid(end - leap_s, kStateToeStepS, true);
           ++k) {
        const GpsTime about = GpsTime{} + (static_cast<double>(k) * kStateToeStepS + leap_s);
        const GpsTime t_b = about + (about.leap_seconds() - leap_s);
        if (const auto vector = fit_state_vector(constellation, sv, t_b)) data.glonass.push_back(vector->ephemeris);
      }
      continue;
    }
    for (std::int64_t k = grid(start, kToeStepS, false); k <= grid(end, kToeStepS, true); ++k)
      if (const auto record = fit_ephemeris(constellation, sv, GpsTime{} + static_cast<double>(k) * kToeStepS)) {
        data.kepler.push_back(record->ephemeris);
        data.kepler.back().iode = static_cast<int>(k % 256);
      }
  }
  return data;
}

}  // namespace canyon::gnss
