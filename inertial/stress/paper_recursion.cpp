#include <vector>

#include "canyon/core/stress_rows.h"
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
  return rows.take();
}

}  // namespace canyon::inertial
