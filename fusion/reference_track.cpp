#include "canyon/fusion/reference_track.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/dead_reckoning.h"

namespace canyon::fusion {
namespace {

constexpr std::size_t kAround = 3;         // states to each side
constexpr double kGapFactor = 1.5;         // of the usual interval
constexpr double kLargestTurn_rad = 2.0;   // from the state before: beyond pi a rotation vector starts anew
constexpr std::size_t kIntervals = 10000;  // the usual one is the median of so many at most

double usual_interval_s(std::span<const NavState> reference) {
  std::vector<double> intervals;
  const std::size_t step = std::max<std::size_t>(1, reference.size() / kIntervals);
  for (std::size_t i = 0; i + 1 < reference.size(); i += step) intervals.push_back(reference[i + 1].t - reference[i].t);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

/// Index of the first state later than t.
std::size_t first_after(std::span<const NavState> reference, GpsTime t) {
  const auto next = std::upper_bound(reference.begin(), reference.end(), t,
                                     [](GpsTime value, const NavState& state) { return value < state.t; });
  return static_cast<std::size_t>(next - reference.begin());
}

/// The states around the interval that ends at `next`, as far as neither a gap nor a turn cuts them off.
std::span<const NavState> neighbours(std::span<const NavState> reference, std::size_t next, double longest_s) {
  const NavState& a = reference[next - 1];
  const auto joined = [&](std::size_t i, std::size_t j) {
    return reference[j].t - reference[i].t <= longest_s &&
           so3_log(a.R_EU.conjugate() * reference[i].R_EU).norm() < kLargestTurn_rad &&
           so3_log(a.R_EU.conjugate() * reference[j].R_EU).norm() < kLargestTurn_rad;
  };
  std::size_t first = next - 1, last = next;
  while (first > 0 && next - first < kAround && joined(first - 1, first)) --first;
  while (last + 1 < reference.size() && last + 1 - next < kAround && joined(last, last + 1)) ++last;
  return reference.subspan(first, last + 1 - first);
}

}  // namespace

std::optional<NavState> reference_at(std::span<const NavState> reference, GpsTime t) {
  if (reference.empty() || t < reference.front().t || reference.back().t < t) return std::nullopt;
  const std::size_t next = first_after(reference, t);
  const NavState& a = reference[next - 1];
  if (a.t == t) return a;
  const double longest_s = kGapFactor * usual_interval_s(reference);
  if (reference[next].t - a.t > longest_s) return std::nullopt;
  const std::span<const NavState> around = neighbours(reference, next, longest_s);
  NavState out = a.v_EU_E.allFinite() ? interpolate(a, reference[next], t) : NavState{.t = t};
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), turn = position;
  if (a.v_EU_E.allFinite()) out.v_EU_E.setZero();
  for (const NavState& at : around) {
    double weight = 1.0;
    for (const NavState& other : around)
      if (other.t != at.t) weight *= (t - other.t) / (at.t - other.t);
    position += weight * (at.p_EU_E - a.p_EU_E);
    turn += weight * so3_log(a.R_EU.conjugate() * at.R_EU);
    out.v_EU_E += weight * at.v_EU_E;
  }
  if (!a.v_EU_E.allFinite()) out.p_EU_E = a.p_EU_E + position;
  out.R_EU = (a.R_EU * so3_exp(turn)).normalized();
  return out;
}

std::optional<NavState> first_common_state(std::span<const NavState> reference, std::span<const ImuSample> samples) {
  if (reference.empty() || samples.empty()) return std::nullopt;
  const GpsTime first_edge = samples.front().t - samples.front().dt_s;
  std::optional<NavState> start;
  // The first state at or after the log's beginning, and whether it is that beginning.
  const std::size_t next = first_after(reference, first_edge - kSameInstant_s);
  const bool begins_there = next < reference.size() && reference[next].t - first_edge <= kSameInstant_s;
  if (next > 0 && !begins_there) start = reference_at(reference, first_edge);
  if (!start && next < reference.size()) start = reference[next];
  if (!start) return std::nullopt;
  // The edge of a sample that is the same instant.
  const auto edge = std::lower_bound(samples.begin(), samples.end(), start->t - kSameInstant_s,
                                     [](const ImuSample& s, GpsTime t) { return s.t < t; });
  if (begins_there) {
    start->t = first_edge;
  } else if (edge != samples.end() && edge->t - start->t <= kSameInstant_s) {
    start->t = edge->t;
  }
  if (!(start->t < samples.back().t)) return std::nullopt;
  return start;
}

std::vector<NavState> reference_from(const NavState& start, std::span<const NavState> reference) {
  std::vector<NavState> out = {start};
  for (const NavState& state : reference)
    if (state.t - start.t > kSameInstant_s) out.push_back(state);
  return out;
}

}  // namespace canyon::fusion
