// What a receiver makes of its signals: echoes and links, simple rules, modes of operation, clutter's fields and
// scatterers, gathered delays, and what bounds say before anything is received.
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/paths/bounce.h"
#include "canyon/gnss/paths/clutter/clutter_scatterers.h"
#include "canyon/gnss/paths/clutter/lattice_noise.h"
#include "canyon/gnss/paths/clutter/street_shading.h"
#include "canyon/gnss/paths/need/obstacle_heights.h"
#include "canyon/gnss/paths/need/reflection_bound.h"
#include "canyon/gnss/paths/need/sky_span.h"
#include "canyon/gnss/paths/scatter/delay_bins.h"
#include "canyon/gnss/receiver/link_budget.h"
#include "canyon/gnss/receiver/modes/receiver_fix.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"
#include "canyon/gnss/receiver/multipath_rule.h"
#include "canyon/gnss/receiver/reports/cn0_estimator.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;
using Hand = std::complex<double>;

const RandomStream kReceived(4, "stress.receptions");
double between(double low, double high, std::uint32_t what, int k) {
  return kReceived.uniform(low, high, what, static_cast<std::uint64_t>(k));
}
double power_db(double x) {
  return 10.0 * std::log10(x);
}

/// Echoes by their definition: hands through the antenna's pattern add in power, what fades by many scatterers by a
/// first-order loop of 0.25 Hz, phase of the stronger hand (of both, weighed, where they are many), Doppler by the
/// motion. 1e-12 dB and cycles of a way of up to 1000 wavelengths.
StressFigure links() {
  Looks looks;
  LinkBudget link;
  link.cn0_zenith_dbhz = 46.5;
  link.antenna = make_sine_antenna({.horizon_loss_db = 8.0, .lhcp_rejection_db = 12.0});
  const double wave_m = 0.19029367;
  for (int k = 0; k < 300; ++k) {
    SignalPath path;
    path.excess_m = between(0, 190, 0, k);
    path.copolar = std::polar(between(0, 1, 1, k), between(-3, 3, 2, k));
    path.crosspolar = std::polar(between(0, 1, 3, k), between(-3, 3, 4, k));
    const double a = between(-kPi, kPi, 5, k), e = between(-1.5, 1.5, 6, k);
    path.arrival_W = {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
    path.foliage_m = k % 3 == 0 ? between(0, 40, 7, k) : 0.0;
    const bool many = k % 2 == 0;
    if (many)
      path.spread = between(0, 0.9, 8, k), path.gathered_copolar = between(0, 1, 9, k),
      path.gathered_crosspolar = between(0, 1, 10, k);
    const Vector3d v(between(-20, 20, 11, k), between(-20, 20, 12, k), 1.0), to = Vector3d(0.3, -0.5, 0.8).normalized();
    const ReceivedSignal r = receive(path, link, Vector3d::UnitZ(), to, v, wave_m);
    const double right_db = -8.0 * (1.0 - std::sin(e)), left_db = right_db - 12.0;
    const double gr = std::pow(10.0, 0.1 * right_db), gl = std::pow(10.0, 0.1 * left_db);
    double power = std::norm(path.copolar) * gr + std::norm(path.crosspolar) * gl;
    if (many) {
      const double ratio = v.norm() * path.spread / wave_m * kPi / 0.5;
      const double single = path.gathered_copolar * gr + path.gathered_crosspolar * gl;
      power = single + (power - single) / (1.0 + ratio * ratio);
    }
    const double leaves_db = 28.0 * -std::expm1(-path.foliage_m * 0.25 / 28.0);
    looks.near(r.cn0_dbhz, 46.5 - leaves_db + power_db(power), 1e-10);
    looks.near(link.foliage_db(path.foliage_m), leaves_db, 1e-12);
    looks.right(r.excess_m == path.excess_m);
    looks.near(r.doppler_hz, (v.dot(path.arrival_W) - v.dot(to)) / wave_m, 1e-11);
    const Hand right = path.copolar * std::sqrt(gr), left = path.crosspolar * std::sqrt(gl);
    const Hand hand = many                                ? right * std::abs(right) + left * std::abs(left)
                      : std::abs(right) >= std::abs(left) ? right
                                                          : left;
    looks.near(std::remainder(r.phase_rad - std::arg(hand) + 2.0 * kPi * path.excess_m / wave_m, 2.0 * kPi), 0.0,
               1e-11);
    const double field = between(0.01, 1.2, 13, k);
    looks.near(link.direct_cn0_dbhz(e, path.foliage_m, field), 46.5 + right_db - leaves_db + 2.0 * power_db(field),
               1e-11);
  }
  return looks.figure();
}

/// The rules without a correlator, case by case.
StressFigure rules() {
  Looks looks;
  MultipathParameters p;
  p.cutoff_m = 45.0, p.threshold_dbhz = 25.0;
  const double wave_m = 0.19;
  for (int k = 0; k < 400; ++k) {
    std::optional<ReceivedSignal> direct;
    if (k % 4 != 0) direct = ReceivedSignal{0.0, between(20, 45, 0, k), 0.0, 0.0};
    std::vector<ReceivedSignal> echoes;
    for (int i = 0; i < k % 5; ++i)
      echoes.push_back(
          {between(0, 90, 1, 8 * k + i), between(15, 40, 2, 8 * k + i), 0.0, between(-30, 30, 3, 8 * k + i)});
    std::sort(echoes.begin(), echoes.end(), [](const auto& a, const auto& b) { return a.excess_m < b.excess_m; });
    const bool clear = direct && direct->cn0_dbhz >= 25.0;
    const Reception none = model_row(multipath_rules(), "none").make({}, p)->receive(direct, echoes, wave_m);
    looks.right(none.tracked == clear && none.error_m == 0.0 && (!clear || none.cn0_dbhz == direct->cn0_dbhz));
    const Reception paper =
        model_row(multipath_rules(), "paper_first_return").make({}, p)->receive(direct, echoes, wave_m);
    int source = -1;
    bool tracked = clear;
    if (clear) {
      for (std::size_t i = 0; i < echoes.size() && source < 0; ++i)
        if (echoes[i].cn0_dbhz >= 25.0 && echoes[i].excess_m < 45.0) source = static_cast<int>(i);
    } else {
      double best = 25.0;
      for (std::size_t i = 0; i < echoes.size(); ++i)
        if (echoes[i].cn0_dbhz >= best) best = echoes[i].cn0_dbhz, source = static_cast<int>(i), tracked = true;
    }
    looks.right(paper.tracked == tracked && (!tracked || paper.source == source));
    if (!tracked) continue;
    const double excess = source < 0 ? 0.0 : echoes[static_cast<std::size_t>(source)].excess_m;
    const double hz = source < 0 ? 0.0 : echoes[static_cast<std::size_t>(source)].doppler_hz;
    looks.near(paper.error_m, excess, 1e-12), looks.near(paper.carrier_error_m, excess, 1e-12);
    looks.near(paper.range_rate_error_m_s, -wave_m * hz, 1e-12);
    looks.near(paper.cn0_dbhz, clear ? direct->cn0_dbhz : echoes[static_cast<std::size_t>(source)].cn0_dbhz, 1e-12);
  }
  CorrelatorDesign design;
  design.spacing_chips = 0.4;
  looks.near(late_arm_m(design), 1.2 * 299792458.0 / 1.023e6, 1e-9);
  ReceptionConfig config;
  config.cutoff_ns = 200.0;
  looks.near(config.cutoff_m(), 59.9584916, 1e-9);
  return looks.figure();
}

/// A reported C/N0: exact, in steps, or with the noise of its averaging, whose formula holds over 4000 epochs that are
/// an averaging time and more apart; 5 deviations.
StressFigure reported_strength() {
  Looks looks;
  for (const double cn0 : {15.0, 32.0, 48.0})
    for (const double averaging_s : {0.1, 1.0}) {
      const double rho = std::pow(10.0, 0.1 * cn0) * 0.02, samples = averaging_s / 0.02;
      const double sigma = 10.0 / std::log(10.0) * std::sqrt((1.0 + 2.0 / rho) / samples);
      looks.near(cn0_noise_db(cn0, averaging_s, 0.02), sigma, 1e-12);
      const Cn0Estimator estimator(3, "stress.cn0", {.averaging_s = averaging_s, .resolution_db = 0.0}, 0.02, 20.0);
      double sum = 0.0, squares = 0.0;
      constexpr int kN = 4000;
      for (int k = 0; k < kN; ++k) {
        const double off = estimator.reported_dbhz(cn0, 7, k) - cn0;
        sum += off / kN, squares += off * off / kN;
      }
      looks.near(sum / sigma, 0.0, 5.0 / std::sqrt(1.0 * kN));
      looks.near(squares / (sigma * sigma), 1.0, 5.0 * std::sqrt(2.0 / kN));
    }
  const Cn0Estimator steps(3, "stress.cn0", {.averaging_s = 0.0, .resolution_db = 0.25}, 0.02, 1.0),
      exact(3, "stress.cn0", {.averaging_s = 0.0, .resolution_db = 0.0}, 0.02, 1.0);
  for (double cn0 = -3.0; cn0 < 50.0; cn0 += 0.37) {
    looks.near(steps.reported_dbhz(cn0, 1, 5), cn0 > 0.0 ? 0.25 * std::round(cn0 / 0.25) : 0.0, 0.126);
    looks.near(std::remainder(steps.reported_dbhz(cn0, 1, 5), 0.25), 0.0, 1e-12);
    looks.right(exact.reported_dbhz(cn0, 1, 5) == cn0);
  }
  return looks.figure();
}

/// What a base 20 km away leaves: of 4000 seeds its differences have the stated 1-sigma (5 deviations), orbits keep
/// baseline over range, and the needs name what the models can leave at most. Two frequencies take off gain times what
/// they differ by.
StressFigure modes() {
  Looks looks;
  DgpsParameters p;
  p.baseline_km = 20.0, p.ionosphere_gradient_mm_per_km = 3.0, p.troposphere_gradient_mm_per_km = 1.5;
  ModelChoice<receiver_modes> choice("dgps");
  choice.own.get<DgpsParameters>() = p;
  CorrectionInput in;
  in.sv = {GnssSystem::kGalileo, 11};
  in.t = GpsTime::from_week_sow(1600, 1000.0);
  in.true_view.t = in.t;
  in.true_view.elevation_rad = 0.6;
  in.true_view.receiver = {0.7, 0.2, 100.0};
  in.receivers_view = in.true_view;
  in.range_m = 2.3e7;
  in.acting = {7.0, 4.0, 1.3};
  in.ionosphere_from_l1 = 1.3;
  double iono2 = 0.0, tropo2 = 0.0, base2 = 0.0;
  constexpr int kSeeds = 4000;
  for (int seed = 0; seed < kSeeds; ++seed) {
    ReceiverModeSetup at;
    at.seed = static_cast<std::uint64_t>(seed);
    const auto mode = model_row(receiver_modes(), "dgps").make.make(choice.own, at);
    const Correction c = mode->correction(in);
    iono2 += std::pow(7.0 - c.modelled.ionosphere_m, 2) / kSeeds;
    tropo2 += std::pow(4.0 - c.modelled.troposphere_m, 2) / kSeeds;
    base2 += c.base_m * c.base_m / kSeeds;
    looks.near(1.3 - c.modelled.ephemeris_m, 1.3 * 2e4 / 2.3e7, 1e-14);
    looks.near(c.total_m(), c.modelled.ionosphere_m + c.modelled.troposphere_m + c.modelled.ephemeris_m + c.base_m,
               1e-12);
  }
  const double five = 5.0 * std::sqrt(2.0 / kSeeds);
  const double iono_m = 0.06 * 1.3 * single_layer_obliquity(0.6), tropo_m = 0.03 * niell_wet(0.6, 0.7),
               base_m = 0.16 + 1.07 * std::exp(-0.6 * 180.0 / kPi / 15.5);
  looks.near(iono2 / (iono_m * iono_m), 1.0, five);
  looks.near(tropo2 / (tropo_m * tropo_m), 1.0, five);
  looks.near(base2 / (base_m * base_m), 1.0, five);
  DelayQuestion question;
  question.ionosphere_m = 40.0, question.troposphere_m = 10.0, question.ephemeris_m = 5.0;
  question.lowest_elevation_rad = 0.2, question.lat_rad = 0.7;
  const auto needs = dgps_needs(choice.own, question);
  looks.right(needs.size() == 5);
  const double late = 1100.0 / 299792458.0;
  for (const Need& need : needs) {
    double expected = 0.0;
    if (need.effect == std::string(kIonosphere)) expected = 40.0 * late;
    if (need.effect == std::string(kTroposphere)) expected = 10.0 * late;
    if (need.effect == std::string(kEphemeris)) expected = 5.0 * late + 5.0 * 2e4 / 1.8e7;
    if (expected > 0.0) looks.near(need.bound, expected + 1e-7, 1e-12);
    if (need.effect == std::string(kIonosphereDifference))
      looks.right(need.bound > 5.0 * 0.06 * 1.02 * single_layer_obliquity(0.2) && need.bound < 20.0 * 0.06 * 3.0);
    if (need.effect == std::string(kTroposphereDifference))
      looks.right(need.bound > 5.0 * 0.03 * niell_wet(0.2, 0.7) && need.bound < 20.0 * 0.03 * niell_wet(0.2, 0.7));
  }
  const auto dual = model_row(receiver_modes(), "dual").make.make({ModelChoice<receiver_modes>("dual").own}, {});
  in.two = FrequencyDifference{1.5, 4.0, 0.2, -0.3};
  const Correction c = dual->correction(in);
  looks.near(c.noise_m, 0.3, 1e-14), looks.near(c.multipath_m, -0.45, 1e-14);
  looks.near(c.modelled.ionosphere_m, 6.0 - 0.3 + 0.45, 1e-14);
  looks.right(dual->dual_frequency() && dual->status() == FixStatus::kSingle);
  // Decisions: the root of the statistic may grow by the bound over the sigmas.
  PositionSolution s;
  s.ok = true;
  s.dop.gdop = 3.0;
  s.integrity = {IntegrityTest::Status::kPassed, 4.0, 16.0, 3};
  GnssEpoch epoch;
  epoch.observations.resize(4);
  for (GnssObservation& o : epoch.observations) o.sigma_m = 2.0;
  // 2 + b < 0.99 * 4.
  looks.right(decisions_hold(s, epoch, 1.95, 10.0) && !decisions_hold(s, epoch, 1.97, 10.0));
  looks.right(decisions_hold(s, epoch, 0.1, 3.04) && !decisions_hold(s, epoch, 0.1, 3.02));
  s.integrity.status = IntegrityTest::Status::kRepaired;
  looks.right(!decisions_hold(s, epoch, 0.1, 10.0));
  return looks.figure();
}

/// Between its corners a field is their sum with cosines and sines of the stated angle along each coordinate, whatever
/// their number: roundings; and over far corners it is standard normal, 5 deviations of 20000.
StressFigure lattices() {
  Looks looks;
  const LatticeNoise noise(11, "stress.lattice");
  const auto angle = [](double f) { return 0.5 * kPi * f * f * (3.0 - 2.0 * f); };
  for (int k = 0; k < 200; ++k) {
    std::array<double, 3> x{between(-90, 90, 0, k), between(-90, 90, 1, k), between(-90, 90, 2, k)};
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      std::array<double, 3> at{};
      double weight = 1.0;
      for (std::size_t d = 0; d < 3; ++d) {
        const double low = std::floor(x[d]), theta = angle(x[d] - low);
        const bool upper = (corner >> d & 1) != 0;
        at[d] = low + (upper ? 1.0 : 0.0);
        weight *= upper ? std::sin(theta) : std::cos(theta);
      }
      sum += weight * noise.at<3>(at, 5);
    }
    looks.near(noise.at<3>(x, 5), sum, 1e-13);
    looks.right(noise.at<3>(x, 5) != noise.at<3>(x, 6));
  }
  double mean = 0.0, square = 0.0;
  constexpr int kN = 20000;
  for (int k = 0; k < kN; ++k) {
    const double v = noise.at<2>({3.0 * k + 0.3, 0.7 - 2.0 * k}, 1);
    mean += v / kN, square += v * v / kN;
  }
  looks.near(mean, 0.0, 5.0 / std::sqrt(1.0 * kN));
  looks.near(square, 1.0, 5.0 * std::sqrt(2.0 / kN));
  return looks.figure();
}

scene::Scene plain_at(double height_m, double box_m) {
  scene::SceneParts parts;
  parts.name = "plain";
  parts.frame = LocalFrame(Geodetic{0.5646, -1.586, 60.0});
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-300, -300, height_m}, {300, -300, height_m}, {300, 300, height_m}, {-300, 300, height_m},
            mesh.material("asphalt"));
  if (box_m > 0.0) {
    mesh.begin_object("box", scene::ObjectKind::kBuilding);
    mesh.box({100.0, 40.0, 0.5 * box_m}, Eigen::Matrix3d::Identity(), {10.0, 5.0, 0.5 * box_m},
             mesh.material("concrete"));
  }
  return scene::Scene(std::move(parts));
}

/// One scatterer in each cell, evenly within it and up to 5 m over the ground; those within a radius and no others;
/// hands of variance 1. Of 10000 cells: 5 deviations of means and squares.
StressFigure scatterers() {
  Looks looks;
  const scene::Scene plain = plain_at(7.0, 0.0);
  const ClutterScatterers all(3.0, 5);
  std::vector<ClutterScatterer> found, within;
  all.near(plain, {10.0, -20.0, 0.0}, 170.0, found);
  Vector3d mean = Vector3d::Zero(), square = Vector3d::Zero();
  double co = 0.0, cross = 0.0;
  std::vector<std::pair<int, int>> cells;
  const auto n = static_cast<double>(found.size());
  looks.near(n / (kPi * 170.0 * 170.0 / 9.0), 1.0, 0.02);
  for (const ClutterScatterer& s : found) {
    const double fx = s.p_W.x() / 3.0 - std::floor(s.p_W.x() / 3.0), fy = s.p_W.y() / 3.0 - std::floor(s.p_W.y() / 3.0),
                 fz = (s.p_W.z() - 7.0) / 5.0;
    looks.right(fz >= 0.0 && fz < 1.0 && (s.p_W.head<2>() - Eigen::Vector2d(10.0, -20.0)).norm() < 170.0);
    const Vector3d f(fx, fy, fz);
    mean += f / n, square += f.cwiseAbs2() / n;
    co += std::norm(s.co) / n, cross += std::norm(s.cross) / n;
    cells.emplace_back(static_cast<int>(std::floor(s.p_W.x() / 3.0)), static_cast<int>(std::floor(s.p_W.y() / 3.0)));
  }
  std::sort(cells.begin(), cells.end());
  looks.right(std::adjacent_find(cells.begin(), cells.end()) == cells.end());
  for (int a = 0; a < 3; ++a) {
    looks.near(mean[a], 0.5, 5.0 / std::sqrt(12.0 * n));
    looks.near(square[a], 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / n));
  }
  looks.near(co, 1.0, 5.0 / std::sqrt(n)), looks.near(cross, 1.0, 5.0 / std::sqrt(n));
  all.near(plain, {40.0, 15.0, 0.0}, 25.0, within);
  std::size_t expected = 0;
  for (const ClutterScatterer& s : found)
    expected += (s.p_W.head<2>() - Eigen::Vector2d(40.0, 15.0)).norm() < 25.0 ? 1 : 0;
  looks.right(within.size() == expected);
  return looks.figure();
}

/// Shades over far places and times are spread as the law says of independent normal numbers: means and squares of
/// 20000, against 200000 drawn; 5 deviations.
StressFigure shades(double elevation_rad) {
  Looks looks;
  const TwoStateLaw law(TwoStateLaw::environments().front(), 1.0);
  const StreetShading shading(law, {}, 3, 9);
  double mean = 0.0, square = 0.0, expected = 0.0, expected2 = 0.0;
  constexpr int kN = 20000, kDrawn = 200000;
  for (int k = 0; k < kN; ++k) {
    const double a = between(-kPi, kPi, 0, k);
    const Vector3d from(std::cos(elevation_rad) * std::cos(a), std::cos(elevation_rad) * std::sin(a),
                        std::sin(elevation_rad));
    const double db =
        shading.level_db({61.3 * k, -83.7 * k, 0.0}, from, GpsTime::from_week_sow(1600, 31.7 * (k % 19000)));
    mean += db / kN, square += db * db / kN;
    // From below the ground as from above it on the same side.
    if (k % 500 == 0)
      looks.near(shading.level_db({1.0, 2.0, 0.0}, {from.x(), from.y(), -from.z()}, GpsTime{}) -
                     shading.level_db({1.0, 2.0, 0.0}, from, GpsTime{}),
                 0.0, 1e-12);
  }
  for (std::uint64_t k = 0; k < kDrawn; ++k) {
    const double ma = law.mean_level_db(kReceived.normal(20, k), elevation_rad);
    const double db = ma + law.spread_db(ma, elevation_rad) * kReceived.normal(21, k);
    expected += db / kDrawn, expected2 += db * db / kDrawn;
  }
  const double variance = expected2 - expected * expected;
  looks.near(mean, expected, 5.0 * std::sqrt(variance * (1.0 / kN + 1.0 / kDrawn)));
  // A fourth moment of up to ten variances squared: a mixture of two states.
  looks.near(square - mean * mean, variance, 5.0 * variance * std::sqrt(10.0 / kN));
  return looks.figure();
}

/// Phasors gathered by delay add up at the carrier as they are, to roundings of 600 m in wavelengths; powers in squares
/// of their shares, and one direction has no spread.
StressFigure gathered() {
  Looks looks;
  const double wave_m = 0.19029367;
  DelayBins bins;
  bins.clear(wave_m);
  Hand co = 0.0, cross = 0.0;
  std::vector<double> power(DelayBins::kBins, 0.0);
  for (int k = 0; k < 200; ++k) {
    const double excess = between(0.0, 620.0, 0, k);
    const DelayBins::Phasor phasor{std::polar(between(0, 1, 1, k), between(-3, 3, 2, k)),
                                   std::polar(between(0, 1, 3, k), between(-3, 3, 4, k))};
    bins.add(phasor, excess, Vector3d::UnitX(), 1.0);
    const auto first = static_cast<std::size_t>(excess / 15.0);
    if (first + 1 >= DelayBins::kBins) continue;
    const double share = excess / 15.0 - static_cast<double>(first);
    co += phasor.co * std::polar(1.0, -2.0 * kPi * excess / wave_m);
    cross += phasor.cross * std::polar(1.0, -2.0 * kPi * excess / wave_m);
    const double both = std::norm(phasor.co) + std::norm(phasor.cross);
    power[first] += (1.0 - share) * (1.0 - share) * both, power[first + 1] += share * share * both;
  }
  Hand co_sum = 0.0, cross_sum = 0.0;
  for (std::size_t i = 0; i < DelayBins::kBins; ++i) {
    const Hand turn = std::polar(1.0, -2.0 * kPi * 15.0 * static_cast<double>(i) / wave_m);
    co_sum += bins.bins()[i].co * turn, cross_sum += bins.bins()[i].cross * turn;
    looks.near(bins.bins()[i].co_power + bins.bins()[i].cross_power, power[i], 1e-12);
  }
  looks.near(std::abs(co_sum - co), 0.0, 1e-9), looks.near(std::abs(cross_sum - cross), 0.0, 1e-9);
  std::vector<SignalPath> out;
  const double least = 1.5;
  bins.append(least, SignalPath::kClutter, out);
  for (const SignalPath& path : out) {
    const auto i = static_cast<std::size_t>(std::lround(path.excess_m / 15.0));
    const DelayBins::Bin& bin = bins.bins()[i];
    const double sum = std::norm(bin.co) + std::norm(bin.cross), amplitude = std::sqrt(sum > power[i] ? sum : power[i]);
    const double kept = amplitude / least - 1.0 > 1.0 ? 1.0 : amplitude / least - 1.0;
    looks.near(std::abs(path.copolar - kept * bin.co), 0.0, 1e-13);
    looks.near(std::abs(path.crosspolar - kept * bin.cross), 0.0, 1e-13);
    looks.near(path.gathered_copolar + path.gathered_crosspolar, kept * kept * power[i], 1e-12);
    looks.near(path.spread, 0.0, 1e-7);
    looks.near((path.arrival_W - Vector3d::UnitX()).norm(), 0.0, 1e-14);
    looks.right(path.facets[0] == SignalPath::kClutter && path.facets[1] == i);
  }
  looks.right(out.size() > 10);
  // Two directions at right angles of equal power: mean 1 / sqrt 2 long, spread as much.
  bins.clear(wave_m);
  bins.add({1.0, 0.0}, 30.0, Vector3d::UnitX(), 1.0);
  bins.add({Hand(0.0, 1.0), 0.0}, 30.0, Vector3d::UnitY(), 1.0);
  out.clear();
  bins.append(1e-3, SignalPath::kScattered, out);
  looks.right(out.size() == 1);
  if (out.size() == 1) looks.near(out[0].spread, std::sqrt(0.5), 1e-12);
  return looks.figure();
}

/// Bounds that are made before anything is received: never below what is, and no farther above it than their steps.
StressFigure bounds() {
  Looks looks;
  for (const scene::Material& material : scene::builtin_materials())
    for (const double rough_m : {0.0, 0.01}) {
      const ReflectionBound bound(material, rough_m);
      for (double cosine = 0.005; cosine < 1.0; cosine += 0.0217) {
        double most = 0.0;
        for (const double hz : {1.15e9, 1.3e9, kL1Hz, 1.62e9}) {
          const double incidence = std::acos(cosine);
          const Vector3d in(std::sin(incidence), 0.0, -cosine);
          const Bounce bounce = bounce_off(material, in, Vector3d::UnitZ(), rough_m, hz);
          most = worse(most, std::abs(bounce.coefficients.te) * bounce.factor);
          most = worse(most, std::abs(bounce.coefficients.tm) * bounce.factor);
        }
        looks.right(bound.from(cosine) >= most * (1.0 - 1e-12));
        if (material.thickness_m > 0.0 || material.rf_absorbing) continue;
        // A half-space: the largest TE at the carriers' ends, at the cosine's step below.
        const double step = std::floor(256.0 * cosine) / 256.0;
        double te = 0.0;
        for (const double hz : {1.15e9, 1.62e9})
          te = worse(te, std::abs(fresnel(material.permittivity(hz), std::acos(step)).te));
        looks.near(bound.from(cosine),
                   te * roughness_factor(std::hypot(material.roughness_m, rough_m), step, kSpeedOfLight / 1.15e9),
                   1e-12);
      }
    }
  const auto sky = make_nominal_gps();
  const LocalFrame frame(Geodetic{0.5646, -1.586, 60.0});
  const GpsTime start = GpsTime::from_week_sow(1600, 3000.0);
  const Ball place{{200.0, -100.0, 5.0}, 150.0};
  const SkySpan span = sky_span(*sky, frame, start, start + 400.0, place, 0.1);
  looks.right(span.directions.size() > 40 && span.spread_rad < 0.01);
  for (int k = 0; k < 150; ++k) {
    const Vector3d off = 150.0 * Vector3d(between(-1, 1, 0, k), between(-1, 1, 1, k), 0.0) / std::sqrt(2.0);
    const Vector3d p_E = frame.to_E(place.center_W + off);
    const GpsTime t = start + between(0, 400, 2, k);
    for (const SatelliteId sv : sky->satellites()) {
      const auto signal = transmission_to(*sky, sv, t, p_E);
      if (!signal) continue;
      const Vector3d s = frame.R_EW().transpose() * (signal->p_E() - p_E).normalized();
      if (s.z() < std::sin(0.1)) continue;
      double nearest = 4.0;
      for (const auto& d : span.directions)
        if (d.sv == sv) nearest = std::min(nearest, 2.0 * std::asin(0.5 * (d.s_W - s).norm()));
      looks.right(nearest <= span.spread_rad && std::asin(s.z()) >= span.lowest_rad);
    }
    const Ball from{{between(-50, 50, 3, k), between(-50, 50, 4, k), 0.0}, between(0, 5, 5, k)},
        at{{between(-200, 200, 6, k), between(-200, 200, 7, k), between(0, 300, 8, k)}, between(0, 20, 9, k)};
    const Vector3d v = at.center_W - from.center_W;
    const double reach = at.radius_m + from.radius_m;
    std::optional<std::size_t> expected;
    for (std::size_t i = 0; i < span.directions.size() && !expected; ++i) {
      const double turned = std::acos(std::min(1.0, v.normalized().dot(span.directions[i].s_W)));
      if (v.norm() <= reach || turned <= std::asin(reach / v.norm()) + span.spread_rad) expected = i;
    }
    looks.right(span.through(from, at) == expected);
  }
  // A box on a plain, from along a way: its top over the lower end, by the distance less half widths and half a square.
  const scene::Scene plain = plain_at(0.0, 24.0);
  const ObstacleHeights heights(plain);
  for (const double x : {-150.0, -40.0, 30.0}) {
    RouteSegment segment;
    segment.points_W = {{x, 40.0, 0.0}, {x + 10.0, 40.0, 0.0}};
    segment.low_m = 0.0, segment.half_width_m = 2.0;
    const double found = heights.horizon_rad(segment, 1.5, 1.0);
    // The box spans 90 to 110 by x; a square's circle has up to 4 sqrt 2 of 4 m squares.
    const double true_m = 90.0 - (x + 10.0) - 3.0;
    looks.right(found >= std::atan((24.0 - 1.5) / true_m) && found <= std::atan((24.0 - 1.5 + 0.01) / (true_m - 8.0)));
  }
  RouteSegment inside;
  inside.points_W = {{95.0, 40.0, 0.0}, {99.0, 40.0, 0.0}};
  looks.near(heights.horizon_rad(inside, 1.5, 1.0), 0.5 * kPi, 1e-15);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> reception_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "signals as a receiver gets them, and what simple rules make of them",
           .why = "a gain of the other hand, a factor of 10 where 20 belongs, an echo beyond the cut-off",
           .expected = "definitions written out: roundings, and five deviations of what is drawn",
           .unit = "of the bound",
           .loose = "some are as they are said to the bit"});
  rows.add("receptions/links", links)
      .add("receptions/rules", rules)
      .add("receptions/reported_strength", reported_strength)
      .add("receptions/modes", modes);
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "fields over a street, and scatterers in it",
           .why = "corners that are exchanged, a cell that has two, a level of another elevation",
           .expected = "sums over corners, counts, and the law's mean and spread to five deviations",
           .unit = "of the bound"});
  rows.add("receptions/lattices", lattices)
      .add("receptions/scatterers", scatterers)
      .add("receptions/gathered_delays", gathered);
  for (const double e : {0.4, 0.9})
    rows.add("receptions/shades_at_" + stress::text(e) + "_rad", [e] { return shades(e); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "what can be said before anything is received",
           .why = "a bound that is none, or so wide that nothing is ever left out",
           .expected = "above all that is, and no farther than its steps",
           .unit = "of the bound"});
  rows.add("receptions/bounds", bounds);
  return rows.take();
}

}  // namespace canyon::gnss
