// What is made of innovations, and where a recording starts.
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/math/chi_square.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/fusion/acceptance/acceptance.h"
#include "canyon/fusion/alignment/alignment.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Worst;

/// Innovations of three axes of which each is `sigmas` of the noise, R = 4, and of the prediction, as much again.
class Judge {
 public:
  Judge(const std::string& row, const std::string& keys)
      : acceptance_(model_row(acceptance_models(), row).make(configured(keys).own)) {
    acceptance_->start();
  }
  Decision decide(double t_s, double sigmas) {
    const Measurement::Vector r = Vector3d::Constant(2.0 * sigmas);
    const Measurement::Square R = 4.0 * Measurement::Square::Identity(3, 3), P = R;
    return acceptance_->decide({.t = GpsTime::from_week_sow(1590, 1000.0 + t_s),
                                .residual = r,
                                .R = R,
                                .predicted = P,
                                .nis = 3.0 * 4.0 * sigmas * sigmas / 8.0});
  }
  bool takes_all() const { return acceptance_->takes_all(); }

 private:
  std::unique_ptr<Acceptance> acceptance_;
};

/// Sigmas per axis of which three make that NIS, with a prediction as unsure as the noise.
double sigmas_of(double nis) {
  return std::sqrt(2.0 * nis / 3.0);
}

/// The gate stands at the NIS that is as rare as the stated deviation, to the tails' own 1e-9, of 1 to 8 sigma; what is
/// refused for ten seconds and five times is taken for being lost, with the NIS's share as loosening.
StressFigure gate() {
  Worst worst;
  for (const double sigma : {1.0, 3.0, 5.0, 8.0}) {
    const double nis = chi_square_threshold(normal_two_sided_tail(sigma), 3.0);
    Judge judge("gate", "gate_sigma = " + number_text(sigma));
    for (const double off : {-1e-9, 1e-9})
      worst.look(judge.decide(0.0, sigmas_of(nis * (1.0 + off))).accepted == (off < 0.0) ? 0.0 : stress::kInfinity,
                 1.0);
  }
  Judge judge("gate", "gate_sigma = 3");
  for (int k = 0; k <= 10; ++k) {
    const Decision d = judge.decide(k, 100.0);
    worst.look(d.accepted == (k == 10) ? 0.0 : stress::kInfinity, 1.0);
    if (k == 10) worst.look(d.loosening / (100.0 * 100.0 / 2.0) - 1.0, 8.0 * kEpsilon);
  }
  worst.look(judge.decide(11.0, 100.0).accepted || !judge.decide(12.0, 0.5).accepted ? stress::kInfinity : 0.0, 1.0);
  Judge seldom("gate", "gate_sigma = 3\ngate_recovery_s = 1");
  for (int k = 0; k < 5; ++k)  // five at least, however long it is
    worst.look(seldom.decide(100.0 * k, 100.0).accepted == (k == 4) ? 0.0 : stress::kInfinity, 1.0);
  worst.look(Judge("gate", "").takes_all() && !Judge("gate", "gate_sigma = 3").takes_all() ? 0.0 : stress::kInfinity,
             1.0);
  return worst.figure();
}

/// Weights of a single innovation in closed form: those of Huber and Student, and what nearer ones do not do.
/// Roundings.
StressFigure weights() {
  Worst worst;
  for (const double sigmas : {0.0, 0.5, 1.0, 3.0, 30.0, 1e6, 1e100}) {
    const double d = sigmas / std::sqrt(2.0), nis = 3.0 * d * d;
    worst.look(Judge("huber", "huber_sigma = 2").decide(0, sigmas).noise_scale / std::max(1.0, d / 2.0) - 1.0,
               16.0 * kEpsilon);
    worst.look(
        Judge("student_t", "student_t_dof = 4").decide(0, sigmas).noise_scale / std::max(1.0, (4.0 + nis) / 7.0) - 1.0,
        16.0 * kEpsilon);
    // Twice the prediction's part is taken off what is measured.
    worst.look(
        Judge("innovation_adaptive", "").decide(0, sigmas).noise_scale / std::max(1.0, sigmas * sigmas - 1.0) - 1.0,
        16.0 * kEpsilon);
  }
  // No larger than expected: no rule but the first; far beyond it, the last.
  worst.look(Judge("fuzzy_adaptive", "").decide(0, 1.0).noise_scale - 1.0, 16.0 * kEpsilon);
  worst.look(Judge("fuzzy_adaptive", "fuzzy_large = 7").decide(0, 30.0).noise_scale / 49.0 - 1.0, 16.0 * kEpsilon);
  return worst.figure();
}

/// Ten innovations of nothing, then of ten sigma each second: the noise is the mean with weights e^(-age / tau), a
/// geometric sum of which each term rounds.
StressFigure memory(double tau_s) {
  Judge judge("innovation_adaptive", "adaptive_tau_s = " + number_text(tau_s));
  const double kept = std::exp(-1.0 / tau_s);
  Worst worst;
  for (int k = 0; k < 40; ++k) {
    const double found = judge.decide(k, k < 10 ? 0.0 : 10.0).noise_scale;
    double all = 0.0, large = 0.0;
    for (int age = 0; age <= k; ++age) {
      const double weight = std::exp(-age / tau_s);
      all += weight;
      if (k - age >= 10) large += weight;
    }
    const double expected = std::max(1.0, (large * 100.0 - all) / all);
    worst.look(found / expected - 1.0, 4.0 * (k + 8) * kEpsilon / (1.0 - 0.5 * kept));
  }
  return worst.figure();
}

Result<Aligned> aligned(const std::string& row, const std::string& keys, const AlignmentInputs& inputs) {
  const auto& found = model_row(alignments(), row);
  ModelParameters own;
  if (found.parameters != nullptr) found.parameters(own);
  const auto node = ConfigNode::parse(keys, "stress");
  CANYON_CHECK(node && read_fields(&*node, "start", [&own](FieldVisitor& f) { own.visit_all(f); }).ok(), keys);
  return found.make(own, inputs);
}

/// A good unit at rest, levelled and by the Earth's rate: the attitude comes back to roundings of the force, of 2000
/// sums and of the rate, whose horizontal part is cos(latitude) of it; the place by the lever arms.
StressFigure at_rest(double lat_deg, double heading_deg) {
  NavState s = levelled({lat_deg * kDegree, -7.0 * kDegree, 300.0}, heading_deg * kDegree, {0.1, -0.2, 1.0});
  s.t = GpsTime::from_week_sow(1590, 1000.0);
  std::vector<ImuSample> imu;
  for (std::int64_t k = 0; k < 2000; ++k) imu.push_back(rest_sample(s, k, 100.0));
  const Vector3d imu_B(0.3, -0.2, 1.0), antenna_B(-1.0, 0.4, 2.0);
  std::vector<GnssFix> fixes(5);
  for (std::size_t k = 0; k < 5; ++k) {
    fixes[k].t = s.t + 1.0 * static_cast<double>(k);
    fixes[k].status = FixStatus::kSingle;
    fixes[k].p_A_E = s.p_EU_E + s.R_EU * (antenna_B - imu_B);
    fixes[k].covariance_E = Eigen::Matrix3d::Identity();
  }
  const AlignmentInputs inputs{.imu = imu, .fixes = fixes, .noise = {}, .lever_U_B = imu_B, .lever_A_B = antenna_B};
  Worst worst;
  // What is level is so at the antenna, which stands beside the unit: their distance over Earth's radius, by which
  // north turns tan(latitude) times too, and a compass once more by what is not level.
  const double force = 1e4 * kEpsilon + (antenna_B - imu_B).norm() / 6.35e6,
               meridians = force * std::abs(std::tan(lat_deg * kDegree)), compass = force + 2.0 * meridians;
  for (const bool known : {false, true}) {
    const auto found = aligned("static", known ? "static_heading_deg = " + number_text(heading_deg) : "", inputs);
    if (!found) return {stress::kInfinity, 1.0};
    const Vector3d off_E = so3_log(found->nav.R_EU * s.R_EU.conjugate());
    worst.look(off_E.norm(), known ? force + meridians : compass);
    // Gravity is that of the antenna's place, 3e-7 of it a metre up and sideways.
    worst.look((found->nav.p_EU_E - s.p_EU_E).norm(), 2e-6 + 4.0 * compass);
    worst.look(found->nav.v_EU_E.norm(), 1e-300);
  }
  return worst.figure();
}

/// What an alignment at rest says of itself, over noise, latitude and time at rest: tilt of what biases and the mean of
/// white noise leave of gravity, heading of what they leave of the Earth's rate's horizontal part, pi from 20 degrees
/// on; place by the fixes and the heading's share of the lever arm. By the formulas that the model cites: roundings.
StressFigure said_at_rest(double lat_deg) {
  Worst worst;
  const RandomStream draws(5, "stress.alignment");
  int compassed = 0, lost = 0;
  // The antenna stands 2 m beside the unit, and the rate's share turns with the latitude's tangent.
  const double beside = 1e-6 * (1.0 + std::abs(std::tan(lat_deg * kDegree)));
  for (std::uint64_t k = 0; k < 24; ++k) {
    NavState s = levelled({lat_deg * kDegree, 0.4, 100.0}, 2.0, {0.1, -0.2, 1.0});
    s.t = GpsTime::from_week_sow(1590, 1000.0);
    const double rest_s = draws.uniform(2.0, 30.0, 0, k);
    std::vector<ImuSample> imu;
    for (std::int64_t i = 0; i < 1600; ++i) imu.push_back(rest_sample(s, i, 50.0));
    ImuNoise noise;
    const double size = std::pow(10.0, draws.uniform(-8.5, -4.5, 1, k));
    noise.gyro = {.white_per_sqrt_hz = size * draws.uniform(0.1, 3.0, 2, k),
                  .turn_on_bias_sigma = size * draws.uniform(0.1, 3.0, 3, k),
                  .in_run_bias_sigma = size * draws.uniform(0.1, 3.0, 4, k)};
    noise.accel = {.white_per_sqrt_hz = draws.uniform(1e-3, 0.1, 5, k),
                   .turn_on_bias_sigma = draws.uniform(1e-3, 0.1, 6, k),
                   .in_run_bias_sigma = draws.uniform(1e-3, 0.1, 7, k)};
    const Vector3d imu_B(0.3, -0.2, 1.0), antenna_B(-1.0, 0.4, 2.0);
    std::vector<GnssFix> fixes(3);
    for (std::size_t i = 0; i < 3; ++i) {
      fixes[i].t = s.t + 0.5 * static_cast<double>(i);
      fixes[i].status = FixStatus::kSingle;
      fixes[i].p_A_E = s.p_EU_E + s.R_EU * (antenna_B - imu_B);
      fixes[i].covariance_E = Vector3d(0.3, 0.5 + static_cast<double>(i), 0.2).cwiseAbs2().asDiagonal();
    }
    const auto found =
        aligned("static", "static_s = " + number_text(rest_s) + "\nstatic_velocity_sigma_m_s = 0.07",
                {.imu = imu, .fixes = fixes, .noise = noise, .lever_U_B = imu_B, .lever_A_B = antenna_B});
    if (!found) return {stress::kInfinity, 1.0};
    // Samples that end up to static_s after the first one did.
    const double span_s = (std::floor(rest_s * 50.0 + 1e-9) + 1.0) / 50.0;
    worst.look(found->nav.t - s.t - span_s, 1e-6);
    const auto rms = [&](const TriadNoise& n) {
      return std::sqrt(std::pow(n.turn_on_bias_sigma, 2) + std::pow(n.in_run_bias_sigma, 2) +
                       std::pow(n.white_per_sqrt_hz, 2) / span_s);
    };
    worst.look(found->tilt_rad / (rms(noise.accel) / gravity_E(s.p_EU_E).norm()) - 1.0, 1e-6);
    const double compass = rms(noise.gyro) / (Wgs84::rate_rad_s * std::cos(lat_deg * kDegree));
    const bool known = compass < 20.0 * kDegree;
    (known ? compassed : lost) += 1;
    worst.look(found->heading_rad / (known ? compass : kPi) - 1.0, beside);
    const double place = std::hypot(2.5, std::min(2.0, known ? compass : kPi) * (antenna_B - imu_B).norm());
    worst.look(found->position_m / place - 1.0, 1e-6);
    worst.look(found->velocity_m_s - 0.07, 1e-300);
  }
  worst.look(compassed > 3 && lost > 3 ? 0.0 : stress::kInfinity, 1.0);
  return worst.figure();
}

/// In a bend of even speed the course turns evenly; what the alignment takes for the nose is the course of the last
/// fix, and for the acceleration the difference of two velocities: half the turn between them squared over six.
StressFigure in_motion(double lat_deg, double heading_deg, double turn_rad_s) {
  NavState s = levelled({lat_deg * kDegree, 170.0 * kDegree, 50.0}, heading_deg * kDegree, {0.0, 0.0, 1.0});
  s.t = GpsTime::from_week_sow(1590, 1000.0);
  s.v_EU_E = s.R_EU * Vector3d(12.0, 0.0, 0.0);
  const auto strapdown = make_strapdown("three_sample");
  std::vector<ImuSample> imu;
  std::vector<GnssFix> fixes;
  for (std::int64_t k = 0; k < 600; ++k) {
    const Vector3d turn(0.0, 0.0, turn_rad_s), v_U = s.R_EU.conjugate() * s.v_EU_E;
    const Eigen::Matrix3d R_UE = s.R_EU.toRotationMatrix().transpose();
    const Vector3d force = turn.cross(v_U) + R_UE * (2.0 * earth_rate_E().cross(s.v_EU_E) - gravity_E(s.p_EU_E));
    const Increments in{.dt_s = 0.01, .dtheta_U = 0.01 * (turn + R_UE * earth_rate_E()), .dv_U = 0.01 * force};
    ImuSample sample;
    sample.t = tick(s.t, 1, 100.0);
    sample.dt_s = 0.01;
    sample.dtheta_U = in.dtheta_U;
    sample.dv_U = in.dv_U;
    imu.push_back(sample);
    strapdown->advance(s, in);
    s.t = sample.t;
    if (k % 20 != 19) continue;
    GnssFix& fix = fixes.emplace_back();
    fix.t = s.t;
    fix.status = FixStatus::kSingle;
    fix.p_A_E = s.p_EU_E;
    fix.v_A_E = s.v_EU_E;
    fix.covariance_E = Eigen::Matrix3d::Identity();
    fix.velocity_covariance_E = 1e-6 * Eigen::Matrix3d::Identity();
    if (fixes.size() == 12) break;
  }
  const auto found = aligned("in_motion", "", {.imu = imu, .fixes = fixes, .noise = {}});
  if (!found) return {stress::kInfinity, 1.0};
  const GnssFix* last = nullptr;
  for (const GnssFix& fix : fixes)
    if (fix.t == found->nav.t) last = &fix;
  if (last == nullptr) return {stress::kInfinity, 1.0};
  // The state there, by integrating back nothing: the nose lies along the velocity of that fix.
  const Vector3d nose_E = found->nav.R_EU * Vector3d::UnitX(), up_E = -gravity_E(found->nav.p_EU_E).normalized();
  // Between two fixes 1 to 2 s apart the force bends by the square of the turn over 24, of v w against g; a step of
  // 10 ms by its own turn.
  const double span = 2.0, bend = 12.0 * std::abs(turn_rad_s) / 9.8;
  // Coriolis' 2 w v is left out of the force.
  const double off = bend * (std::pow(turn_rad_s * span, 2) / 24.0 + std::abs(turn_rad_s) * 0.01) +
                     2.0 * Wgs84::rate_rad_s * 12.0 / 9.8 + 5e-6;
  Worst worst;
  worst.look((nose_E - last->v_A_E.normalized()).norm(), off);
  worst.look((found->nav.R_EU * Vector3d::UnitZ() - up_E).norm(), off);
  worst.look((found->nav.p_EU_E - last->p_A_E).norm(), 1e-8);
  // A chord of the acceleration, carried from the fix to itself.
  worst.look((found->nav.v_EU_E - last->v_A_E).norm(), 1e-12 * 12.0);
  return worst.figure();
}

/// Geodetic numbers, north-east-down: turned back, exactly but for 64 roundings of a radian and of Earth's radius.
StressFigure given() {
  Worst worst;
  const ImuSample first = rest_sample(resting_at(10.0, 20.0, 0.0), 0, 100.0);
  for (const double lat : {-89.0, 0.0, 52.0})
    for (const double heading : {0.0, 77.0, 300.0}) {
      const auto found = aligned("given",
                                 "place_deg_deg_m = [" + number_text(lat) +
                                     ", -120, 45]\nvelocity_ned_m_s = [1, 2, 3]\nroll_pitch_heading_deg = [0, 0, " +
                                     number_text(heading) + "]",
                                 {.imu = std::span(&first, 1), .fixes = {}, .noise = {}});
      if (!found) return {stress::kInfinity, 1.0};
      const Geodetic at{lat * kDegree, -120.0 * kDegree, 45.0};
      const Eigen::Matrix3d R_EN = rotation_E_from_enu(at);
      const double a = heading * kDegree;
      worst.look((found->nav.p_EU_E - ecef_from_geodetic(at)).norm(), 64.0 * kEpsilon * 6.4e6);
      worst.look((R_EN.transpose() * found->nav.v_EU_E - Vector3d(2.0, 1.0, -3.0)).norm(), 64.0 * kEpsilon);
      worst.look(
          (R_EN.transpose() * (found->nav.R_EU * Vector3d::UnitX()) - Vector3d(std::sin(a), std::cos(a), 0.0)).norm(),
          64.0 * kEpsilon);
      worst.look((R_EN.transpose() * (found->nav.R_EU * Vector3d::UnitZ()) - Vector3d::UnitZ()).norm(),
                 64.0 * kEpsilon);
      worst.look(found->nav.t - (first.t - first.dt_s), 1e-9);
    }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> acceptance_cases() {
  const StressMechanism judged{StressGroup::kData, "an innovation at a threshold, and far beyond it",
                               "a threshold of another number of axes; a filter that refuses the truth for ever",
                               "the NIS as rare as the stated deviation, to 1e-9; weights in closed form",
                               "of the bound"};
  const StressMechanism remembered{StressGroup::kLong, "innovations that are remembered",
                                   "a mean that forgets by samples and not by time, or never",
                                   "a mean with weights e^(-age / tau), to roundings of its terms", "of the bound"};
  const StressMechanism start{StressGroup::kGeometry, "where a recording starts, from a known motion",
                              "a heading of the other hand, a lever arm that is added, gravity where force is",
                              "attitude and place again, to roundings, and of a bend the square of its turn",
                              "of the bound"};
  StressRows rows;
  rows.of(judged).add("acceptance/gate", gate).add("acceptance/weights", weights);
  for (const double tau_s : {0.1, 10.0, 1e5})
    rows.of(remembered).add("acceptance/adaptive_over_" + stress::text(tau_s) + "_s", [tau_s] {
      return memory(tau_s);
    });
  rows.of(start);
  for (const auto& [lat, heading] : {std::pair{0.0, 10.0}, {-45.0, 200.0}, {80.0, 300.0}})
    rows.add("acceptance/rest_at_" + stress::text(lat) + "_deg_heading_" + stress::text(heading) + "_deg",
             [lat = lat, heading = heading] { return at_rest(lat, heading); });
  for (const double turn : {0.0, 0.02, -0.2})
    rows.add("acceptance/start_in_a_bend_of_" + stress::text(turn) + "_rad_s",
             [turn] { return in_motion(-30.0, 130.0, turn); });
  rows.add("acceptance/start_as_given", given);
  rows.of({StressGroup::kData, "what an alignment at rest says of itself",
           "a density over the wrong time, a compass that does not know of the latitude, an axis left out",
           "biases and means over gravity and the Earth's rate, by the formulas: roundings", "of the bound"});
  for (const double lat_deg : {0.0, 45.0, -80.0})
    rows.add("alignment/said_at_rest_at_" + stress::text(lat_deg) + "_deg",
             [lat_deg] { return said_at_rest(lat_deg); });
  return rows.take();
}

}  // namespace canyon::fusion
