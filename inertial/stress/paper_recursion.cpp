#include <array>
#include <cmath>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/errors/markov_process.h"
#include "canyon/inertial/paper_figures.h"
#include "canyon/inertial/paper_formulas.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

/// Where the printed recursion stays below a thousand times what drives it, by halving. Its limit above 1 s is
/// tau / (tau - 1), which is a thousand at 1.001 s: the border found lies 0.1 % beside that of stability.
StressFigure border() {
  double low_s = 0.5, high_s = 2.0;
  while (high_s - low_s > 1e-6) {
    const double tau_s = 0.5 * (low_s + high_s);
    double sigma = 1.0;
    for (int k = 0; k < 100'000 && sigma < 1e3; ++k) sigma = recursion_as_printed(sigma, tau_s, 1.0);
    (sigma < 1e3 ? high_s : low_s) = tau_s;
  }
  return {std::abs(high_s - 1.0), 0.01};
}

/// Grows by 1 / tau a sample once the offset's share is below an epsilon: two roundings.
StressFigure printed_growth(double tau_s) {
  double sigma = 1.0;
  for (int k = 0; k < static_cast<int>(40.0 / -std::log(tau_s)); ++k) sigma = recursion_as_printed(sigma, tau_s, 1.0);
  return {std::abs(recursion_as_printed(sigma, tau_s, 1.0) / sigma * tau_s - 1.0), 4.0 * stress::kEpsilon};
}

/// The exact process at the same correlation time and 125 Hz keeps its variance: 300 processes, three axes, six
/// standard deviations.
StressFigure corrected_variance(double tau_s) {
  constexpr int kProcesses = 300;
  double square = 0.0;
  for (std::uint32_t n = 0; n < kProcesses; ++n)
    square += MarkovProcess::gauss_markov(2, "stress", n, 1.0, tau_s, 1.0 / 125.0).at(1000).squaredNorm();
  return {std::abs(square / (3.0 * kProcesses) - 1.0), 6.0 * std::sqrt(2.0 / (3.0 * kProcesses))};
}

/// Above 1 s it forgets within dt / ln(tau), 3.5 ms at 10 s and 125 Hz: how long an offset takes to fall to 1/e, found
/// from its fall in one sample. An epsilon of what is left is one over ln(tau) of the logarithm, four times each way.
StressFigure printed_memory(double tau_s) {
  constexpr double kStep_s = 1.0 / 125.0;
  const double left = recursion_as_printed(1.0, tau_s, 0.0);
  const double found_s = kStep_s / -std::log(left);
  return {std::abs(found_s / recursion_correlation_time_s(tau_s, kStep_s) - 1.0),
          8.0 * stress::kEpsilon / std::log(tau_s)};
}

/// The chain as printed is not made where it diverges, the corrected one is made everywhere.
StressFigure chains() {
  int wrong = 0;
  for (const double tau_s : {1e-6, 0.5, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 10.0, 1e9}) {
    auto entry = load_catalogue_entry("high_grade_mems");
    if (!entry.ok()) return {stress::kInfinity, 0.0};
    entry->paper.correlation_time_s = tau_s;
    const ChainSetup setup{.entry = *entry, .seed = 1, .rate_hz = 125.0};
    wrong += make_error_chain("paper_as_printed", setup).ok() == (tau_s > 1.0) ? 0 : 1;
    wrong += make_error_chain("paper", setup).ok() ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// A sensor of which each term of the paper's is as large as the others, so that none hides behind another.
CatalogueEntry made_sensor(double tau_s) {
  CatalogueEntry entry = *load_catalogue_entry("high_grade_mems");
  PaperParameters& p = entry.paper;
  p.temperature_k = 310.0, p.correlation_time_s = tau_s, p.run_time_hr = 0.7;
  p.gyro = {.quality_factor = 0.02,
            .mass_kg = 3e-18,
            .resonance_hz = 12.0,
            .drive_amplitude_m = 4e-4,
            .bandwidth_hz = 70.0,
            .white_process = 0.05,
            .zero_offset = -0.04,
            .quantization = 2e-5};
  p.accel = {.quality_factor = 0.03,
             .mass_kg = 2e-17,
             .resonance_hz = 30.0,
             .drive_amplitude_m = 0.0,
             .bandwidth_hz = 50.0,
             .white_process = 2e-3,
             .zero_offset = 3e-3,
             .quantization = 1e-6};
  entry.gyro.scale_ppm.value = 900.0, entry.accel.scale_ppm.value = 400.0;
  return entry;
}

/// Of one triad, in SI: what the terms are by the paper's formulas.
struct Terms {
  double thermal, quantization, white, zero;
};
struct BothTerms {
  Terms gyro, accel;
};
BothTerms printed_terms(const PaperParameters& p) {
  const double w_gyro = 2.0 * kPi * p.gyro.resonance_hz, w_accel = 2.0 * kPi * p.accel.resonance_hz;
  const double four_kt = 4.0 * 1.380649e-23 * p.temperature_k, quantization = 0.01745 * std::sqrt(3.0 / p.run_time_hr);
  // (Q / k) sqrt(4 k_B T R B) with R = m w / Q, k = m w^2; and sqrt(4 k_B T w / (m Q)).
  const double thermal =
      std::sqrt(four_kt * p.gyro.bandwidth_hz * p.gyro.quality_factor / (p.gyro.mass_kg * w_gyro)) / w_gyro;
  return {{thermal, quantization * p.gyro.quality_factor, p.gyro.white_process * kDegree, p.gyro.zero_offset * kDegree},
          {std::sqrt(four_kt * w_accel / (p.accel.mass_kg * p.accel.quality_factor)),
           quantization * p.accel.quality_factor, p.accel.white_process, p.accel.zero_offset}};
}

/// Mean, mean square and product with the sample before of what a chain adds, less `about`, of both triads; by dt.
struct Moments {
  double mean = 0.0, square = 0.0, lag = 0.0;
};
std::array<Moments, 2> moments_of(ErrorChain& chain, double rate_hz, int count, const std::array<double, 2>& about) {
  std::array<Moments, 2> out;
  std::array<Eigen::Vector3d, 2> before;
  constexpr int kBegun = 200;
  for (std::int64_t k = 0; k < count + kBegun; ++k) {
    ImuSample s;
    s.t = tick({}, k + 1, rate_hz);
    s.dt_s = 1.0 / rate_hz;
    s.dtheta_U = s.dv_U = Eigen::Vector3d::Zero();
    chain.corrupt(k, s);
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Vector3d x = ((i == 0 ? s.dtheta_U : s.dv_U) * rate_hz).array() - about[i];
      if (k >= kBegun) {
        out[i].mean += x.mean() / count, out[i].square += x.squaredNorm() / (3.0 * count);
        out[i].lag += x.dot(before[i]) / (3.0 * count);
      }
      before[i] = x;
    }
  }
  return out;
}

/// The chain as printed, sample by sample: sigma_T and sigma_quant with spreads of their own about themselves, and the
/// recursion, which has mean sigma_0 tau / (tau - 1), variance w^2 (1 + 1 / tau^2) / (1 - 1 / tau^2), and alone makes
/// neighbours hang together. Of 12000 samples of three axes: five standard deviations, more by what hangs together.
/// And what a filter is told of it is what the formulas say: rounding.
StressFigure printed_samples(double tau_s) {
  constexpr double kRate_hz = 125.0;
  constexpr int kCount = 12000;
  const CatalogueEntry entry = made_sensor(tau_s);
  const auto chain = make_error_chain("paper_as_printed", {.entry = entry, .seed = 3, .rate_hz = kRate_hz});
  if (!chain.ok()) return {stress::kInfinity, 1.0};
  const BothTerms both = printed_terms(entry.paper);
  const std::array<Terms, 2> terms{both.gyro, both.accel};
  const auto offset = [&](const Terms& e) { return e.thermal + e.quantization + e.zero * tau_s / (tau_s - 1.0); };
  const auto found = moments_of(**chain, kRate_hz, kCount, {offset(terms[0]), offset(terms[1])});
  const double memory = 1.0 / tau_s, fewer = std::sqrt((1.0 + memory) / (1.0 - memory));
  stress::Worst worst;
  for (std::size_t i = 0; i < 2; ++i) {
    const Terms& e = terms[i];
    const double own = e.white * e.white * (1.0 + memory * memory) / (1.0 - memory * memory);
    const double variance = e.thermal * e.thermal + e.quantization * e.quantization + own, count = 3.0 * kCount;
    worst.look(found[i].mean, 5.0 * fewer * std::sqrt(variance / count));
    worst.look(found[i].square / variance - 1.0, 5.0 * fewer * std::sqrt(2.0 / count));
    worst.look(found[i].lag - own * memory, 5.0 * fewer * variance / std::sqrt(count));
    const TriadNoise& told = i == 0 ? (*chain)->noise().gyro : (*chain)->noise().accel;
    const double recursion = e.white * std::sqrt(1.0 + memory * memory) / (1.0 - memory);
    const double white = std::hypot(e.thermal, e.quantization, recursion) / std::sqrt(kRate_hz);
    const double bias = e.thermal + e.quantization + std::abs(e.zero) / (1.0 - memory);
    worst.look(told.white_per_sqrt_hz / white - 1.0, 64.0 * stress::kEpsilon / (1.0 - memory));
    worst.look(told.turn_on_bias_sigma / bias - 1.0, 64.0 * stress::kEpsilon / (1.0 - memory));
    worst.look(told.in_run_bias_tau_s - tau_s, 1e-300);
  }
  return worst.figure();
}

/// The chain as corrected: thermal noise by its density, N sqrt(dt) an increment; quantization the difference of two
/// errors of Q, which neighbours share with the other sign; a process of sigma w and tau; the offset; and a scale
/// factor, the same for all samples, drawn with the sigma that is told. Bounds as above.
StressFigure corrected_samples(double tau_s) {
  constexpr double kRate_hz = 125.0;
  constexpr int kCount = 12000;
  CatalogueEntry entry = made_sensor(tau_s);
  PaperParameters& p = entry.paper;
  // Densities beside the rest, as above of figures.
  p.gyro.mass_kg = 2e-15, p.gyro.drive_amplitude_m = 0.6, p.accel.mass_kg = 1e-14;
  const auto chain = make_error_chain("paper", {.entry = entry, .seed = 3, .rate_hz = kRate_hz});
  if (!chain.ok()) return {stress::kInfinity, 1.0};
  const double kt = 1.380649e-23 * p.temperature_k, w_gyro = 2.0 * kPi * p.gyro.resonance_hz,
               w_accel = 2.0 * kPi * p.accel.resonance_hz;
  const std::array<Terms, 2> terms{
      Terms{std::sqrt(kt / (p.gyro.mass_kg * w_gyro * p.gyro.quality_factor)) / p.gyro.drive_amplitude_m,
            p.gyro.quantization * kDegree, p.gyro.white_process * kDegree, p.gyro.zero_offset * kDegree},
      Terms{std::sqrt(2.0 * kt * w_accel / (p.accel.mass_kg * p.accel.quality_factor)), p.accel.quantization,
            p.accel.white_process, p.accel.zero_offset}};
  const auto found = moments_of(**chain, kRate_hz, kCount, {terms[0].zero, terms[1].zero});
  const double memory = std::exp(-1.0 / (kRate_hz * tau_s)), fewer = std::sqrt((1.0 + memory) / (1.0 - memory));
  stress::Worst worst;
  for (std::size_t i = 0; i < 2; ++i) {
    const Terms& e = terms[i];
    const double steps = std::pow(e.quantization * kRate_hz, 2), own = e.white * e.white,
                 thermal = e.thermal * e.thermal * kRate_hz, variance = thermal + 2.0 * steps + own;
    const double count = 3.0 * kCount;
    worst.look(found[i].mean, 5.0 * fewer * std::sqrt(variance / count));
    worst.look(found[i].square / variance - 1.0, 5.0 * fewer * std::sqrt(2.0 / count));
    worst.look(found[i].lag - (own * memory - steps), 5.0 * fewer * variance / std::sqrt(count));
    const TriadNoise& told = i == 0 ? (*chain)->noise().gyro : (*chain)->noise().accel;
    worst.look(told.white_per_sqrt_hz / e.thermal - 1.0, 64.0 * stress::kEpsilon);
    worst.look(told.turn_on_bias_sigma - std::abs(e.zero), 4.0 * stress::kEpsilon * std::abs(e.zero));
    worst.look(told.in_run_bias_sigma - e.white, 4.0 * stress::kEpsilon * e.white);
    worst.look(told.in_run_bias_tau_s - tau_s, 1e-300);
    worst.look(told.scale_sigma * 1e6 - (i == 0 ? 900.0 : 400.0), 1e-9);
  }
  // The same samples on an input and without: their difference is the input and its scale factor, the same throughout,
  // and over 60 seeds of that sigma: five standard deviations.
  double square = 0.0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto one = make_error_chain("paper", {.entry = entry, .seed = seed, .rate_hz = kRate_hz});
    Eigen::Vector3d scale[2];
    for (int k = 0; k < 2; ++k) {
      ImuSample still, moved;
      still.dt_s = moved.dt_s = 1.0 / kRate_hz;
      still.dtheta_U = still.dv_U = Eigen::Vector3d::Zero();
      moved.dtheta_U = moved.dv_U = Eigen::Vector3d(1.0, -2.0, 3.0 + k);
      const Eigen::Vector3d in = moved.dtheta_U;
      (*one)->corrupt(k, still);
      (*one)->corrupt(k, moved);
      scale[k] = (moved.dtheta_U - still.dtheta_U).cwiseQuotient(in) - Eigen::Vector3d::Ones();
    }
    worst.look((scale[0] - scale[1]).norm(), 32.0 * stress::kEpsilon);
    square += (scale[0] * 1e6 / 900.0).squaredNorm() / 180.0;
  }
  worst.look(square - 1.0, 5.0 * std::sqrt(2.0 / 180.0));
  return worst.figure();
}

/// The paper's plain integration: angles are the sum of rates, places the sum of mean speeds; the rates' own sum says
/// so, to an epsilon a step.
StressFigure drift() {
  stress::Worst worst;
  for (const PaperFigure& figure : paper_figures()) {
    PaperFigure minute = figure;
    minute.seconds = 60.0;
    const auto found = paper_drift(minute, "paper", 3);
    if (!found || found->t_s.size() != 7500) return {stress::kInfinity, 1.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double angle_deg = 0.0, size = 0.0;
      for (std::size_t k = 0; k < 7500; ++k) {
        angle_deg += found->rate_deg_s[axis][k] / 125.0;
        size += std::abs(found->rate_deg_s[axis][k]) / 125.0;
        worst.look(found->angle_deg[axis][k] - angle_deg,
                   (static_cast<double>(k) + 4.0) * stress::kEpsilon * size + 1e-300);
      }
      // Second differences of the place are the mean of two neighbours' speed changes: all of one sign of a bias as
      // large as this over a minute, half a t^2.
      const auto& p = found->position_m[axis];
      const double first = p[3749] / (0.5 * 30.0 * 30.0), whole = p[7499] / (0.5 * 60.0 * 60.0);
      worst.look(std::isfinite(first) && std::isfinite(whole) ? 0.0 : stress::kInfinity, 1.0);
    }
    worst.look(found->t_s.back() - 60.0, 1e-9);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> paper_recursion_cases() {
  const auto group = StressGroup::kStiff;
  const StressMechanism stability{
      group, "the printed bias recursion's border of stability", "sigma(t-1) / tau stands where e^(-dt/tau) belongs",
      "as printed it diverges below tau = 1 s at any rate: found by halving, within 1 %", "s"};
  const StressMechanism growth{
      group, "divergence of the bias recursion as printed",
      "below 1 s each sample multiplies the bias by 1 / tau: 10^38 in a second at tau = 0.5 s and 125 Hz",
      "the growth a sample is 1 / tau to 4 epsilons", ""};
  const StressMechanism corrected{group, "the bias recursion as corrected, where the printed one diverges",
                                  "as printed", "the variance stays what it is: six standard deviations of 900 squares",
                                  ""};
  const StressMechanism memory{
      group, "memory of the bias recursion as printed",
      "its correlation time is dt / ln(tau), so it depends on the rate",
      "falls to 1/e in dt / ln(tau), 3.5 ms at tau = 10 s and 125 Hz: eight roundings over ln(tau)", ""};
  const StressMechanism refusal{
      group, "a chain that would diverge", "the recursion overflows after some thousand samples, and the run with it",
      "as printed it is refused up to 1 s and made above; as corrected it is always made: exact", "chains"};
  StressRows rows;
  rows.of(stability).add("paper_recursion/border_of_stability", border);
  rows.of(refusal).add("paper_recursion/chains_by_correlation_time", chains);
  for (const double tau_s : {0.1, 0.5, 0.9}) {
    const std::string at = "_at_tau_" + stress::text(tau_s) + "_s";
    rows.of(growth).add("paper_recursion/as_printed" + at, [tau_s] { return printed_growth(tau_s); });
    rows.of(corrected).add("paper_recursion/as_corrected" + at, [tau_s] { return corrected_variance(tau_s); });
  }
  for (const double tau_s : {1.0001, 10.0})
    rows.of(memory).add("paper_recursion/memory_at_tau_" + stress::text(tau_s) + "_s",
                        [tau_s] { return printed_memory(tau_s); });
  rows.of({StressGroup::kLong, "the paper's plain integration", "a sum of another axis", "angles are sums of rates",
           "of the bound"});
  rows.add("imu/paper_drift", drift);
  rows.of({StressGroup::kData, "samples of the paper's chain, as printed and as corrected",
           "a resistance, a density or a step of another unit, a spread for a mean",
           "means, squares and neighbours by its formulas: five deviations of 12000 samples", "of the bound"});
  for (const double tau_s : {1.5, 4.0})
    rows.add("paper_chain/as_printed_at_tau_" + stress::text(tau_s) + "_s", [tau_s] { return printed_samples(tau_s); });
  for (const double tau_s : {0.02, 0.3})
    rows.add("paper_chain/as_corrected_at_tau_" + stress::text(tau_s) + "_s",
             [tau_s] { return corrected_samples(tau_s); });
  return rows.take();
}

}  // namespace canyon::inertial
