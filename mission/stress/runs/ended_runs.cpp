// Whole runs and how they end: by a fault, by being lost, on a tape, with nobody who drives; and who believes what.
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/mission/stress/runs/heard_run.h"
#include "canyon/mission/stress/runs/subjects.h"

namespace canyon::mission {
namespace {

using Eigen::Vector2d;
using stress::kInfinity;
using stress::Looks;

std::string briefly(const std::string& more_of_run = "", double limit_s = 2.0) {
  return "[time]\nlimit_s = " + stress::text(limit_s) + "\n[autonomy]\nrate_hz = 100\n[lidar]\nrate_hz = 10\n" +
         "[run]\ntruth_as_pose = true\n" + more_of_run;
}

int count_of(const HeardRun& run, Heard what) {
  int n = 0;
  for (const HeardEvent& event : run.events) n += event.what == what ? 1 : 0;
  return n;
}

HeardRun::Says steady(double speed_m_s) {
  return {.drives = [=](int) { return DriveCommand{.speed_m_s = speed_m_s, .curvature_1_m = 0.0}; }};
}

/// A command that is not finite, a call that throws, and an autonomy that says it is lost: each ends the run there and
/// then, with its words; and the user's own limit does.
StressFigure ended_by_autonomy() {
  Looks looks;
  const auto ends = [&](const HeardRun& run, Outcome outcome, double t_s, const std::string& words) {
    looks.right(run.record.outcome == outcome && run.record.failure.has_value());
    if (!run.record.failure) return;
    looks.near(run.record.failure->t_s, t_s, 1e-9);
    looks.right(run.record.failure->detail == words);
    looks.near(run.record.simulated_s, t_s, 1e-9);
  };
  HeardRun::Says says = steady(3.0);
  says.drives = [](int n) {
    return DriveCommand{.speed_m_s = n == 29 ? kInfinity : 3.0, .curvature_1_m = n == 29 ? -0.26 : 0.0};
  };
  const auto endless = heard_run(briefly(), says);
  ends(*endless, Outcome::kAutonomyFault, 0.3, "its command was inf m/s, -0.3 1/m");
  looks.right(endless->asked.size() == 30);
  says.drives = [](int n) -> DriveCommand {
    if (n == 49) throw std::runtime_error("no idea");
    return {.speed_m_s = 3.0, .curvature_1_m = 0.0};
  };
  ends(*heard_run(briefly(), says), Outcome::kAutonomyFault, 0.5, "it threw: no idea");
  says = steady(3.0);
  says.is = [](int asked) { return asked >= 40 ? AutonomyState::kLost : AutonomyState::kDriving; };
  ends(*heard_run(briefly("told_step_m = 2.5\ntold_step_every_s = 0.1\n"), says), Outcome::kLost, 0.4,
       "it said so, and was 2.5 m from where it took itself to be");
  const auto stopped = heard_run(briefly(), steady(3.0));
  ends(*stopped, Outcome::kStopped, 2.0, "by [time] limit_s after 2.0 s");
  looks.right(stopped->asked.size() == 200 && stopped->scans.size() == 20 && stopped->nodes.size() == 201);
  return looks.figure();
}

/// An autonomy that says it has finished, after one of its waypoints or none; and what it believed when.
StressFigure believed() {
  Looks looks;
  const Vector2d start(213.9, 60.0), crossing(213.9, 109.9);
  HeardRun::Says says = steady(4.0);
  says.next_waypoint = 1;
  says.is = [](int asked) { return asked >= 60 ? AutonomyState::kDone : AutonomyState::kDriving; };
  const auto run = heard_run(briefly(), says);
  looks.right(run->record.outcome == Outcome::kMissedWaypoint && run->record.failure.has_value());
  looks.near(run->record.simulated_s, 0.6, 1e-9);
  const auto& found = run->record.waypoints;
  looks.right(!found.empty() && found[0].believed && !found[0].reached);
  for (std::size_t i = 1; i < found.size(); ++i) looks.right(!found[i].believed);
  // After the first step of 10 ms it has not gone a millimetre yet.
  looks.near(found[0].believed_at_m, (crossing - start).norm(), 1e-3);
  const double driven_m = run->nodes.back().motion.X_WB.p.y() - start.y();
  looks.right(driven_m > 0.2);
  looks.near(found[0].closest_m, (crossing - start).norm() - driven_m, 1e-3);
  return looks.figure();
}

/// The true motion of one run given to another: the same nodes to the bit to its end, whatever is asked for; an answer
/// that is not finite is nobody's fault, one that throws is not asked again, and is told; and without an autonomy all
/// else is as it was.
StressFigure on_a_tape() {
  Looks looks;
  const auto drive = heard_run(briefly(), steady(3.0));
  Tape tape;
  tape.nodes = drive->nodes;
  for (TapeNode& node : tape.nodes) node.motion.t = GpsTime{node.motion.t.ns - drive->record.start.ns};
  HeardRun::Says says = steady(-1.0);
  says.drives = [](int n) -> DriveCommand {
    if (n == 99) throw std::runtime_error("enough");
    return {.speed_m_s = n == 50 ? kInfinity : 0.0, .curvature_1_m = 0.0};
  };
  const auto same = [&](const HeardRun& run) {
    looks.right(run.nodes.size() == drive->nodes.size() && !run.record.outcome && run.record.waypoints.empty() &&
                run.record.open_loop);
    for (std::size_t k = 0; k < run.nodes.size(); ++k)
      looks.right(run.nodes[k].motion.X_WB.p == drive->nodes[k].motion.X_WB.p &&
                  run.nodes[k].motion.t == drive->nodes[k].motion.t);
    looks.right(run.fixes.size() == drive->fixes.size());
    for (std::size_t k = 0; k < run.fixes.size(); ++k) looks.right(run.fixes[k].fix.p_A_E == drive->fixes[k].fix.p_A_E);
  };
  const auto laid = heard_run(briefly(), says, &tape);
  same(*laid);
  looks.right(laid->asked.size() == 100 && laid->record.warnings.size() == 1);
  looks.right(!laid->record.warnings.empty() &&
              laid->record.warnings[0] == "the autonomy was not asked any more after 1 s: it threw: enough");
  // A scan that is due at the same time is shown before the question.
  looks.right(laid->scans.size() == 10);
  Omissions nobody;
  nobody.autonomy = true;
  const auto alone = heard_run(briefly(), says, &tape, &nobody);
  same(*alone);
  looks.right(alone->asked.empty() && alone->scans.empty() && alone->record.warnings.empty());
  looks.right(count_of(*alone, Heard::kEpoch) == count_of(*drive, Heard::kEpoch));
  // The user's limit holds on a tape too.
  const auto brief = heard_run(briefly("", 1.2), steady(0.0), &tape);
  looks.near(brief->record.simulated_s, 1.2, 1e-9);
  return looks.figure();
}

/// Who does not look is shown what becomes a keyframe, and nothing else; without keyframes nothing is fired at all.
StressFigure looked_at() {
  Looks looks;
  HeardRun::Says says = steady(4.0);
  says.looks = false;
  const auto run = heard_run(briefly("", 4.0), says);
  // A first one, then after each two metres the next that comes, tenths of a second apart.
  const double driven_m = run->record.distance_m, most_m = 2.0 + 0.1 * 4.1,
               more = static_cast<double>(run->scans.size()) - 1.0;
  looks.right(driven_m > 6.0 && more <= driven_m / 2.0 && more > driven_m / most_m - 1.0);
  looks.right(run->scans.size() == static_cast<std::size_t>(run->record.counters.at("lidar_scans")));
  for (std::size_t k = 1; k < run->seen.size(); ++k) {
    const double way_m = (run->seen[k].X_WB.p - run->seen[k - 1].X_WB.p).norm();
    looks.right(way_m >= 2.0 - 1e-9 && way_m < most_m);
  }
  Omissions none;
  none.registration = none.maps = none.keyframes = true;
  const auto blind = heard_run(briefly(), says, nullptr, &none);
  looks.right(blind->scans.empty() && blind->record.counters.at("lidar_scans") == 0);
  looks.right(!blind->record.maps_made && !blind->record.keyframes_made && run->record.maps_made);
  looks.right(run->record.prior_quality.points > 100 && blind->record.prior_quality.points == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> ended_run_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "runs and how they end",
           "a fault that is passed over, a run that goes on after its end, a question to who has failed",
           "when, by what words, and what was asked until then: exact, and roundings of a time", "of the bound"});
  rows.add("heard/ended_by_the_autonomy", ended_by_autonomy)
      .add("heard/believed", believed)
      .add("heard/on_a_tape", on_a_tape)
      .add("heard/looked_at", looked_at);
  return rows.take();
}

}  // namespace canyon::mission
