// Records of a run: a verdict's numbers and words from records that are known, and the names of states.
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/stress/looks.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/fusion/stress/subjects.h"
#include "canyon/fusion/verdict/error_record.h"
#include "canyon/fusion/verdict/innovation_record.h"
#include "canyon/fusion/verdict/state_record.h"
#include "canyon/fusion/verdict/verdict.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kInfinity;
using stress::Looks;

/// The names of the states, in the order in which they stand; counts what differs.
StressFigure names() {
  StressFigure out;
  const auto right = [&](bool holds) { out.figure += holds ? 0.0 : 1.0; };
  const Drive drive = simulated_drive(
      1, {.seconds = 0.1, .keys = "states = [\"biases\", \"gains\", \"mounting\", \"wheel_scale\", \"fix_error\"]"});
  const ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  std::vector<std::string> expected{"roll",          "pitch",          "yaw",
                                    "east position", "north position", "height",
                                    "east velocity", "north velocity", "vertical velocity"};
  const char* const axes = "xyz";
  for (const ErrorState::Member& member : filter.state().members()) {
    const int n = member.block->size();
    for (int i = 0; i < n; ++i) {
      const std::string triad = 2 * i < n ? "gyro " : "accel ";
      const char a = axes[i % 3];
      if (member.name == "biases") expected.push_back(triad + "bias " + a);
      if (member.name == "gains" && n == 18) {
        const char r = axes[(i % 9) / 3];
        expected.push_back(triad + (r == a ? std::string("scale ") + r : std::string("misalignment ") + r + a));
      }
      if (member.name == "mounting" || member.name == "fix_error") expected.push_back(member.name + " " + a);
      if (member.name == "wheel_scale") expected.push_back("wheel_scale");
    }
  }
  const auto found = state_names(filter.state());
  right(found.size() == expected.size());
  for (std::size_t k = 0; k < found.size() && k < expected.size(); ++k) right(found[k].name == expected[k]);
  return out;
}

/// A verdict's numbers from records that are known: means, bands by chi-square of their degrees, tests counted, each
/// with its part of the false alarm; and what is said of them, in words and order.
StressFigure numbers() {
  Looks looks;
  DrawnNumbers draw(9);
  const auto t = [](int k) { return GpsTime::from_week_sow(1590, 100.0 + k); };
  InnovationRecord innovations;
  double nis = 0.0;
  for (int k = 0; k < 600; ++k) {
    UpdateReport report{.measurement = "position", .t = t(k), .accepted = k % 6 != 0, .dimension = 3};
    for (int i = 0; i < 3; ++i) report.normalized[i] = 2.0 * draw.next();
    report.nis = report.normalized.head<3>().squaredNorm();
    nis += report.nis;
    innovations.add(report);
  }
  ErrorRecord errors(ErrorRecord::navigation());
  double squares[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < 500; ++k) {
    const Vector3d e = Vector3d(3.0, 0.5, 1.0).cwiseProduct(draw.three());
    for (int i = 0; i < 3; ++i) squares[i] += e[i] * e[i];
    errors.add(ErrorRecord::kVelocity, t(k), e, Eigen::Matrix3d::Identity());
  }
  FixRecord fixes;
  double fix_squares = 0.0;
  const Eigen::Matrix3d P = Vector3d(4.0, 1.0, 9.0).asDiagonal();
  double whitened = 0.0;
  for (int k = 0; k < 300; ++k) {
    const Vector3d e = Vector3d(2.0, 1.0, 3.0).cwiseProduct(draw.three());
    fix_squares += e.squaredNorm() / 3.0;
    whitened += (e.x() * e.x() / 4.0 + e.y() * e.y() + e.z() * e.z() / 9.0) / 3.0;
    fixes.add(t(k), e, P);
  }
  const VerdictNumbers v = verdict_numbers({.innovations = &innovations, .errors = &errors, .fixes = &fixes}, 0.01);
  looks.right(v.tests == 2 + 2 + 4);
  looks.close(v.false_alarm, 0.01 / 8.0, 4.0);
  if (v.measurements.size() != 1 || v.axes.size() != 3 || v.blocks.size() != 1 || !v.fixes) return {kInfinity, 1.0};
  const MeasurementNumbers& m = v.measurements[0];
  looks.right(m.name == "position" && m.count == 600.0 && m.refused == 100.0);
  looks.near(m.nis.value, nis / 1800.0, 1e-12);
  const double alarm = v.false_alarm;
  looks.near(m.nis.band.low, chi_square_threshold(1.0 - 0.5 * alarm, 1800.0) / 1800.0, 1e-12);
  looks.near(m.nis.band.high, chi_square_threshold(0.5 * alarm, 1800.0) / 1800.0, 1e-12);
  looks.near(m.nis.factor(), std::sqrt(nis / 1800.0), 1e-12);
  looks.right(m.nis.off() && m.nis.judged() && !m.white.off());
  looks.near(m.white.threshold, chi_square_threshold(alarm, 16.0), 1e-9);
  for (std::size_t i = 0; i < 3; ++i) {
    looks.near(v.axes[i].rms, std::sqrt(squares[i] / 500.0), 1e-12);
    looks.near(v.axes[i].claimed, 1.0, 1e-12);
    looks.near(v.axes[i].ratio.value, squares[i] / 500.0, 1e-12);
    looks.near(v.axes[i].ratio.band.low, 0.0, 1e-300);
    looks.near(v.axes[i].ratio.band.high,
               chi_square_threshold(alarm, v.axes[i].ratio.effective) / v.axes[i].ratio.effective, 1e-12);
  }
  looks.right(v.axes[0].ratio.off() && !v.axes[1].ratio.off());
  looks.near(v.blocks[0].nees.value, (squares[0] + squares[1] + squares[2]) / 1500.0, 1e-12);
  looks.near(v.fixes->rms_m, std::sqrt(fix_squares / 300.0), 1e-12);
  looks.near(v.fixes->claimed_m, std::sqrt(14.0 / 3.0), 1e-12);
  looks.near(v.fixes->ratio.value, whitened / 300.0, 1e-12);
  looks.right(!v.fixes->lasting_is_modelled && !v.fixes->ratio.off());
  // Said: the axis that is three times off, innovations twice too large, a sixth refused; the worst first.
  const auto said = findings(v);
  if (said.size() != 3) return {kInfinity, 1.0};
  looks.right(said[0].kind == Finding::Kind::kErrors && said[0].subject == "east velocity");
  looks.right(said[1].kind == Finding::Kind::kInnovations && said[1].subject == "position");
  looks.right(said[2].kind == Finding::Kind::kRefused);
  looks.near(said[0].badness, 0.5 * std::log(squares[0] / 500.0), 1e-12);
  looks.near(said[1].badness, 0.5 * std::log(nis / 1800.0), 1e-12);
  looks.near(said[2].badness, 100.0 / 600.0, 1e-12);
  const auto lines = verdict_lines(v);
  looks.right(lines.size() == 3 && lines[2] == "position: 100 of 600 refused" &&
              lines[1] == "position: innovations 2.0 times too large");
  looks.right(verdict_lines(VerdictNumbers{}) == std::vector<std::string>{"consistent"});
  // Whiteness: a correlation of 20 samples at 0.5 s counts half the logarithm of 1 + 2 tau / dt, and itself.
  VerdictNumbers white;
  white.measurements.push_back({.name = "x", .count = 100.0});
  white.measurements[0].white = {0.9, 50.0, 30.0, 10.0, 0.5};
  const auto told = findings(white);
  if (told.size() != 1) return {kInfinity, 1.0};
  looks.near(told[0].badness, 0.5 * std::log(41.0) + 0.9, 1e-12);
  white.measurements[0].white.at_lag_one = 0.05;
  looks.right(findings(white).empty());
  // What is not observed: blocks as a whole, by number, or one by one.
  VerdictNumbers seen;
  for (int k = 0; k < 3; ++k) seen.states.push_back({.block = "a", .name = "a " + std::to_string(k)});
  for (int k = 0; k < 6; ++k)
    seen.states.push_back(
        {.block = "b", .name = "b " + std::to_string(k), .halved_after_s = k < 2 ? std::optional(1.0) : std::nullopt});
  for (int k = 0; k < 3; ++k)
    seen.states.push_back(
        {.block = "c", .name = "c " + std::to_string(k), .halved_after_s = k < 2 ? std::optional(1.0) : std::nullopt});
  const std::vector<std::string> expected{"consistent", "a not observed", "b: 4 of 6 not observed", "c 2 not observed"};
  looks.right(verdict_lines(seen) == expected);
  ConsistencyMean mean;
  looks.right(std::isnan(mean.per_state()));
  mean.add(6.0, 3), mean.add(1.0, 2);
  looks.near(mean.per_state(), 7.0 / 5.0, 1e-15);
  looks.right(mean.count() == 2);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> record_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "a verdict from records that are known",
           .why = "a test that is not counted, a band of half the degrees, an order that puts the worst last",
           .expected = "the numbers by hand, and the words that they are said in",
           .unit = "of the bound"});
  rows.add("records/numbers_of_a_verdict", numbers);
  rows.of({.group = StressGroup::kData,
           .mechanism = "names of a filter's states",
           .why = "an axis of another row, a gyroscope's name for an accelerometer",
           .expected = "each by hand",
           .unit = "wrong"});
  rows.add("records/names_of_states", names);
  return rows.take();
}

}  // namespace canyon::fusion
