#include "canyon/fusion/verdict/verdict.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/output/printed.h"

namespace canyon::fusion {
namespace {

/// What is significant and smaller than this is not worth words: a tenth of sigma, or of a correlation.
constexpr double kWorthSaying = 0.1;
/// More refusals than this are said; a gate at three sigma refuses 0.3 % of what is as it should be.
constexpr double kManyRefused = 0.05;

double badness(const SquareMean& mean) {
  return std::abs(std::log(std::clamp(mean.factor(), 1e-6, 1e6)));
}

/// What a correlated series, taken as a white one, is overrated by: the variance of its mean is
/// (1 + 2 tau / dt) times that of independent samples.
double badness(const Whiteness& white) {
  return 0.5 * std::log1p(2.0 * std::abs(white.correlation_s) / white.interval_s) + std::abs(white.at_lag_one);
}

void say_axis(const AxisNumbers& axis, std::vector<Finding>& out) {
  if (!axis.ratio.off()) return;
  const char* const unit = axis.unit.c_str();
  out.push_back({Finding::Kind::kErrors, axis.name, badness(axis.ratio),
                 printed("%s overconfident by %.1f (error %.2g %s where %.2g %s are claimed)", axis.name.c_str(),
                         axis.ratio.factor(), axis.rms, unit, axis.claimed, unit)});
}

/// Of a block none of whose axes has said anything.
void say_block(const BlockNumbers& block, std::vector<Finding>& out) {
  if (!block.nees.off()) return;
  out.push_back({Finding::Kind::kErrors, block.name, badness(block.nees),
                 printed("%s: errors and covariance do not fit together (NEES %.2g per axis)", block.name.c_str(),
                         block.nees.value)});
}

void say_measurement(const MeasurementNumbers& m, std::vector<Finding>& out) {
  const char* const name = m.name.c_str();
  if (m.nis.off()) {
    const double factor = m.nis.factor();
    out.push_back({Finding::Kind::kInnovations, m.name, badness(m.nis),
                   factor > 1.0 ? printed("%s: innovations %.1f times too large", name, factor)
                                : printed("%s: innovations %.1f times too small", name, 1.0 / factor)});
  }
  if (m.white.off()) {
    out.push_back(
        {Finding::Kind::kWhiteness, m.name, badness(m.white),
         m.white.correlation_s > 0.0
             ? printed("%s: innovations correlated over %.2g s (%.2f from one to the next)", name,
                       m.white.correlation_s, m.white.at_lag_one)
             : printed("%s: innovations not independent (%.2f from one to the next)", name, m.white.at_lag_one)});
  }
  if (m.refused > kManyRefused * m.count)
    out.push_back({Finding::Kind::kRefused, m.name, m.refused / m.count,
                   printed("%s: %.0f of %.0f refused", name, m.refused, m.count)});
}

void say_process(const ProcessNumbers& process, std::vector<Finding>& out) {
  if (!process.ratio.off()) return;
  out.push_back(
      {Finding::Kind::kProcess, process.name, badness(process.ratio),
       printed("%s: %.1f times larger than its 1-sigma lets expect", process.name.c_str(), process.ratio.factor())});
}

void say_fixes(const FixNumbers& fixes, std::vector<Finding>& out) {
  if (fixes.lasting_is_modelled) return;
  if (fixes.ratio.off()) {
    out.push_back({Finding::Kind::kFixes, "fixes", badness(fixes.ratio),
                   printed("fixes %.1f times worse than they say (error %.2g m where %.2g m are claimed)",
                           fixes.ratio.factor(), fixes.rms_m, fixes.claimed_m)});
  }
  if (fixes.white.off() && fixes.white.correlation_s > 0.0)
    out.push_back(
        {Finding::Kind::kFixes, "fixes", badness(fixes.white),
         printed("fixes correlated over %.2g s, the filter takes them as independent", fixes.white.correlation_s)});
}

/// Blocks none of whose states is observed are said as a whole, others state by state up to three of them.
void say_not_observed(const std::vector<StateNumbers>& states, std::vector<Finding>& out) {
  constexpr std::size_t kBySingle = 3;
  for (std::size_t begin = 0, end = 0; begin < states.size(); begin = end) {
    const std::string& block = states[begin].block;
    std::vector<std::string> names;
    for (end = begin; end < states.size() && states[end].block == block; ++end)
      if (!states[end].halved_after_s) names.push_back(states[end].name);
    if (block == "clone" || names.empty()) continue;
    const auto say = [&](const std::string& text) { out.push_back({Finding::Kind::kNotObserved, block, 0.0, text}); };
    if (names.size() == end - begin) {
      say(block + " not observed");
    } else if (names.size() > kBySingle) {
      say(printed("%s: %zu of %zu not observed", block.c_str(), names.size(), end - begin));
    } else {
      for (const std::string& name : names) say(name + " not observed");
    }
  }
}

bool is_fault(const Finding& finding) {
  return finding.kind != Finding::Kind::kNotObserved;
}

}  // namespace

bool SquareMean::off() const {
  return judged() && !band.contains(value) && std::abs(std::log(factor())) > std::log1p(kWorthSaying);
}

double SquareMean::factor() const {
  return std::sqrt(value);
}

bool Whiteness::off() const {
  return statistic > threshold && std::abs(at_lag_one) > kWorthSaying;
}

std::vector<Finding> findings(const VerdictNumbers& numbers) {
  std::vector<Finding> out;
  for (const AxisNumbers& axis : numbers.axes) say_axis(axis, out);
  for (const BlockNumbers& block : numbers.blocks) {
    const bool said = std::any_of(numbers.axes.begin(), numbers.axes.end(), [&](const AxisNumbers& axis) {
      return axis.block == block.name && axis.ratio.off();
    });
    if (!said) say_block(block, out);
  }
  for (const MeasurementNumbers& m : numbers.measurements) say_measurement(m, out);
  for (const ProcessNumbers& process : numbers.processes) say_process(process, out);
  if (numbers.fixes) say_fixes(*numbers.fixes, out);
  say_not_observed(numbers.states, out);
  std::stable_sort(out.begin(), out.end(), [](const Finding& a, const Finding& b) {
    return is_fault(a) != is_fault(b) ? is_fault(a) : a.badness > b.badness;
  });
  return out;
}

std::vector<std::string> verdict_lines(const VerdictNumbers& numbers) {
  const std::vector<Finding> all = findings(numbers);
  std::vector<std::string> out;
  if (all.empty() || !is_fault(all.front())) out.emplace_back("consistent");
  for (const Finding& finding : all) out.push_back(finding.text);
  return out;
}

}  // namespace canyon::fusion
