// What a receiver makes of its signals: echoes and links, simple rules, reported strength and modes of operation.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere.h"
#include "canyon/gnss/atmosphere/niell.h"
#include "canyon/gnss/receiver/link_budget.h"
#include "canyon/gnss/receiver/modes/delay_omissions.h"
#include "canyon/gnss/receiver/modes/receiver_fix.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"
#include "canyon/gnss/receiver/multipath_rule.h"
#include "canyon/gnss/receiver/reports/cn0_estimator.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Looks;
using Hand = std::complex<double>;

double power_db(double x) {
  return 10.0 * std::log10(x);
}

/// Echoes by their definition: hands through the antenna's pattern add in power, what fades by many scatterers by a
/// first-order loop of 0.25 Hz, phase of the stronger hand (of both, weighed, where they are many), Doppler by the
/// motion. 1e-12 dB and cycles of a way of up to 1000 wavelengths.
StressFigure links() {
  Looks looks;
  const RandomStream draws(4, "stress.receptions");
  LinkBudget link;
  link.cn0_zenith_dbhz = 46.5;
  link.antenna = make_sine_antenna({.horizon_loss_db = 8.0, .lhcp_rejection_db = 12.0});
  const double wave_m = 0.19029367;
  for (int k = 0; k < 300; ++k) {
    SignalPath path;
    path.excess_m = draws.uniform(0, 190, 0, k);
    path.copolar = std::polar(draws.uniform(0, 1, 1, k), draws.uniform(-3, 3, 2, k));
    path.crosspolar = std::polar(draws.uniform(0, 1, 3, k), draws.uniform(-3, 3, 4, k));
    const double a = draws.uniform(-kPi, kPi, 5, k), e = draws.uniform(-1.5, 1.5, 6, k);
    path.arrival_W = {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
    path.foliage_m = k % 3 == 0 ? draws.uniform(0, 40, 7, k) : 0.0;
    const bool many = k % 2 == 0;
    if (many)
      path.spread = draws.uniform(0, 0.9, 8, k), path.gathered_copolar = draws.uniform(0, 1, 9, k),
      path.gathered_crosspolar = draws.uniform(0, 1, 10, k);
    const Vector3d v(draws.uniform(-20, 20, 11, k), draws.uniform(-20, 20, 12, k), 1.0),
        to = Vector3d(0.3, -0.5, 0.8).normalized();
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
    const double field = draws.uniform(0.01, 1.2, 13, k);
    looks.near(link.direct_cn0_dbhz(e, path.foliage_m, field), 46.5 + right_db - leaves_db + 2.0 * power_db(field),
               1e-11);
  }
  return looks.figure();
}

/// No signal at all, and none that is strong enough: not tracked, by any rule, and nothing is told of it.
StressFigure no_signals() {
  Looks looks;
  MultipathParameters p;
  p.threshold_dbhz = 25.0;
  for (const auto& row : multipath_rules())
    for (int k = 0; k < 2; ++k) {
      std::vector<ReceivedSignal> echoes;
      if (k == 1) echoes.push_back({12.0, 10.0, 0.3, 0.0});
      const Reception found = row.make({}, p)->receive(std::nullopt, echoes, 0.19);
      looks.right(!found.tracked && found.error_m == 0.0 && found.carrier_error_m == 0.0 &&
                  found.range_rate_error_m_s == 0.0);
    }
  return looks.figure();
}

/// The rules without a correlator, case by case.
StressFigure rules() {
  Looks looks;
  const RandomStream draws(4, "stress.receptions");
  MultipathParameters p;
  p.cutoff_m = 45.0, p.threshold_dbhz = 25.0;
  const double wave_m = 0.19;
  for (int k = 0; k < 400; ++k) {
    std::optional<ReceivedSignal> direct;
    if (k % 4 != 0) direct = ReceivedSignal{0.0, draws.uniform(20, 45, 0, k), 0.0, 0.0};
    std::vector<ReceivedSignal> echoes;
    for (int i = 0; i < k % 5; ++i)
      echoes.push_back({draws.uniform(0, 90, 1, 8 * k + i), draws.uniform(15, 40, 2, 8 * k + i), 0.0,
                        draws.uniform(-30, 30, 3, 8 * k + i)});
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
  rows.of({StressGroup::kData, "a receiver of no signal", "a loop that is read where it locks on nothing",
           "not tracked, and nothing told", "of the bound"});
  rows.add("receptions/of_no_signal", no_signals);
  return rows.take();
}

}  // namespace canyon::gnss
