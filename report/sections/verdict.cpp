#include <algorithm>
#include <cmath>

#include "canyon/core/output/failure_words.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/read/run_story.h"
#include "canyon/report/sections/sections.h"
#include "canyon/report/sections/why_details.h"

namespace canyon::report {
namespace {

constexpr double kBeforeFailure_s = 30;  // "in the 30 s before"

std::string spoken(const std::string& fidelity) {
  return "run " + fidelity;
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

/// "completes the mission", "fails after 213 s" or "is stopped after 60 s".
std::string present(const Run& run) {
  if (run.succeeded()) return "completes the mission";
  const double t_s = run.failure ? run.failure->t_s : run.figure("duration_s");
  return std::string(run.was_stopped() ? "is stopped" : "fails") +
         (std::isfinite(t_s) ? " after " + show_quantity(t_s, "s") : "");
}

std::string signed_number(double v) {
  return (v > 0 ? "+" : "") + show_number(v);
}

/// "6 of 11 waypoints and 0 of 3 mission waypoints".
std::string waypoints_reached(const Run& run, const Mission& mission) {
  const double n = static_cast<double>(mission.waypoints.size());
  double mission_n = 0;
  for (const Waypoint& w : mission.waypoints) mission_n += w.mission ? 1 : 0;
  const double reached = run.figure("waypoints_reached"), mission_reached = run.figure("mission_waypoints_reached");
  std::vector<std::string> parts;
  if (std::isfinite(reached))
    parts.push_back(show_count(reached) + (n > 0 ? " of " + show_count(n) : "") + " waypoints");
  if (std::isfinite(mission_reached)) {
    parts.push_back(show_count(mission_reached) + (mission_n > 0 ? " of " + show_count(mission_n) : "") +
                    " mission waypoints");
  }
  return listed(parts);
}

/// "waypoint “house”" of a 1-based number.
std::string waypoint_name(double number, const Mission& mission) {
  const auto i = static_cast<std::size_t>(std::max(1.0, number)) - 1;
  if (i >= mission.waypoints.size()) return "the end of the route";
  const std::string& name = mission.waypoints[i].name;
  return name.empty() ? "waypoint " + show_count(number) : "waypoint \xE2\x80\x9C" + name + "\xE2\x80\x9D";
}

std::string success_sentence(const Run& run, const Mission& mission) {
  std::string text = " completed the mission";
  if (const std::string reached = waypoints_reached(run, mission); !reached.empty()) text += ": " + reached;
  if (std::isfinite(run.figure("duration_s"))) text += ", in " + show_quantity(run.figure("duration_s"), "s");
  if (std::isfinite(run.figure("distance_m"))) text += " over " + show_quantity(run.figure("distance_m"), "m", 4);
  if (std::isfinite(run.figure("position_error_rms_m"))) {
    text += ", with a position error of " + show_quantity(run.figure("position_error_rms_m"), "m") + " RMS";
    if (std::isfinite(run.figure("position_error_max_m"))) {
      text += " and " + show_quantity(run.figure("position_error_max_m"), "m") + " at worst";
    }
  }
  return text + ".";
}

ToldFailure told_failure(const Run& run) {
  return {run.failure->kind, run.failure->detail, run.figure("hit_in_scans_s"), run.figure("hit_last_range_m"),
          run.figure("hit_last_seen_s")};
}

/// "hit a parked car (vehicle 350), seen by its LIDAR for the last 1.4 s, in the end 4.2 m off,"
std::string failure_clause(const Run& run) {
  const ToldFailure told = told_failure(run);
  const std::string seen = sighting_words(told, "\xC2\xA0");
  return failure_words(told) + seen + (seen.empty() ? "" : ",");
}

std::string failure_sentence(const Run& run, const Mission& mission) {
  const std::string& kind = run.failure ? run.failure->kind : run.outcome;
  std::string text = (kind == "stopped" ? " " : " failed: it ");
  text += run.failure ? failure_clause(run) : outcome_words(kind);
  std::string where;
  if (run.failure) {
    const Failure& f = *run.failure;
    if (std::isfinite(f.t_s)) text += " after " + show_quantity(f.t_s, "s", 4);
    if (run.nav) {
      if (const auto row = row_at(*run.nav, f.t_s)) {
        const EpochTable& nav = *run.nav;
        const double heading_for = nav["waypoint"][*row];
        if (std::isfinite(heading_for)) text += ", on its way to " + waypoint_name(heading_for, mission);
        if (const double error_m = error_norm_m(nav, *row); std::isfinite(error_m)) {
          where = " It took itself to be " + show_quantity(error_m, "m") + " from where it truly was (" +
                  signed_number(nav["error_e_m"][*row]) + " m east, " + signed_number(nav["error_n_m"][*row]) +
                  " m north, " + signed_number(nav["error_u_m"][*row]) + " m up).";
        }
      }
    }
  }
  if (const std::string reached = waypoints_reached(run, mission); !reached.empty())
    text += "; it had reached " + reached;
  return text + "." + where;
}

/// The circumstances: what the simulator said, and the reception before.
std::string circumstances(const Run& run) {
  if (!run.failure) return {};
  const Failure& f = *run.failure;
  // What was hit has been said.
  std::string text = tells_what_was_hit(told_failure(run)) ? std::string() : f.detail;
  if (!text.empty()) text = capitalised(text) + (text.back() == '.' ? "" : ".");
  if (std::isfinite(f.x_m) && std::isfinite(f.y_m)) {
    text += (text.empty() ? "" : " ") + std::string("Where: ") + show_quantity(f.x_m, "m", 4) + " east and " +
            show_quantity(f.y_m, "m", 4) + " north of the scene\xE2\x80\x99s origin.";
  }
  if (!run.gnss_epochs || !std::isfinite(run.failure->t_s)) return text;
  const double before_s = std::min(kBeforeFailure_s, run.failure->t_s);
  const Reception r = reception(*run.gnss_epochs, run.failure->t_s - before_s, run.failure->t_s);
  if (r.epochs == 0) return text;
  std::vector<std::string> parts;
  if (std::isfinite(r.satellites_min)) {
    parts.push_back(show_count(r.satellites_min) +
                    (r.satellites_min == r.satellites_max ? "" : "\xE2\x80\x93" + show_count(r.satellites_max)) +
                    (r.satellites_max == 1 ? " satellite" : " satellites") + " in the fix");
  }
  if (std::isfinite(r.gdop_max)) parts.push_back("a GDOP of up to " + show_number(r.gdop_max));
  if (std::isfinite(r.multipath_max_m))
    parts.push_back("multipath errors of up to " + show_quantity(r.multipath_max_m, "m"));
  if (r.without_fix > 0) {
    parts.push_back(show_count(static_cast<double>(r.without_fix)) + " of " +
                    count_of(static_cast<double>(r.epochs), "epoch", "epochs") + " without a fix" +
                    (r.last_reason.empty() ? "" : " (the last: " + r.last_reason + ")"));
  }
  if (parts.empty()) return text;
  return text + (text.empty() ? "" : " ") + "In the " + show_quantity(before_s, "s", before_s < 10 ? 1 : 2) +
         " before: " + listed(parts) + ".";
}

}  // namespace

std::string headline(const Results& results) {
  const std::vector<std::size_t> pure = pure_runs(results);
  const std::vector<Run>& runs = results.runs;
  if (results.open_loop) {
    const Run &a = runs[pure.empty() ? 0 : pure[0]], &b = pure.size() > 1 ? runs[pure[1]] : a;
    return "On one true motion " + spoken(b.fidelity) + " was wrong by " +
           show_quantity(b.figure("position_error_rms_m"), "m") + " RMS" +
           (pure.size() > 1 ? ", " + spoken(a.fidelity) + " by " + show_quantity(a.figure("position_error_rms_m"), "m")
                            : std::string()) +
           ".";
  }
  if (pure.size() < 2) {
    const Run& run = runs[pure.empty() ? 0 : pure[0]];
    return capitalised(spoken(run.fidelity)) + " " + present(run) + ".";
  }
  const Run &a = runs[pure[0]], &b = runs[pure[1]];
  if (a.succeeded() != b.succeeded() || a.was_stopped() != b.was_stopped()) {
    return capitalised(spoken(a.fidelity)) + " " + present(a) + "; " + spoken(b.fidelity) + " " + present(b) + ".";
  }
  const double ratio = b.figure("position_error_rms_m") / a.figure("position_error_rms_m");
  std::string text = capitalised(spoken(a.fidelity)) + " and " + spoken(b.fidelity) +
                     (a.was_stopped() ? " are both stopped by their time limit"
                      : a.succeeded() ? " both complete the mission"
                                      : " both fail");
  if (std::isfinite(ratio)) {
    text += "; the position error is " + show_number(ratio) + " times as large in " + spoken(b.fidelity);
  }
  return text + ".";
}

namespace {

/// In an open loop nobody drove: what the runs' errors are, and how they differ.
std::string open_loop_section(const Results& results) {
  std::string body = "<ul class=\"verdicts\">\n";
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const Run& run = results.runs[i];
    body += "<li class=\"verdict keep " + run_class(i) + (run.is_pure() ? "" : " mixed") + "\"><p><strong>" +
            escape_html(run.fidelity) + "</strong> was wrong by " +
            show_quantity(run.figure("position_error_rms_m"), "m") + " RMS and " +
            show_quantity(run.figure("position_error_max_m"), "m") + " at worst.</p>";
    for (const PairedErrors& p : results.open_loop->paired) {
      if (p.b != run.fidelity || !std::isfinite(p.difference_m)) continue;
      body += "<p class=\"more\">Its error is larger than that of " + escape_html(p.a) + " by " +
              show_quantity(p.difference_m, "m") + " on average over " + show_count(p.epochs) + " epochs";
      if (std::isfinite(p.low_m))
        body += " (95 % interval " + show_quantity(p.low_m, "m") + " to " + show_quantity(p.high_m, "m") + ")";
      body += ", and at " + show_number(100.0 * p.worse_share) + " % of them.</p>";
    }
    body += "</li>\n";
  }
  return section("verdict", "Open loop",
                 "All runs on one true motion: " + escape_html(results.open_loop->tape) +
                     ". Nobody drove, so there is no outcome; errors are compared epoch by epoch.",
                 body + "</ul>\n");
}

/// What replays say of why it failed.
std::string why_of(const Why& why) {
  return "<p class=\"more\"><strong>Why:</strong> " + escape_html(why.verdict) + ".</p>\n" +
         why_details(why, "Chain of events, and what each removal does");
}

}  // namespace

std::string verdict_section(const Results& results) {
  if (results.open_loop) return open_loop_section(results);
  std::string body = "<ul class=\"verdicts\">\n";
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const Run& run = results.runs[i];
    const std::string sentence =
        run.succeeded() ? success_sentence(run, results.mission) : failure_sentence(run, results.mission);
    body += "<li class=\"verdict keep " + run_class(i) + (run.is_pure() ? "" : " mixed") +
            "\"><p><span class=\"mark-of " + outcome_class(run.outcome) + "\">" + outcome_mark(run.outcome) +
            "</span> <strong>" + escape_html(run.fidelity) + "</strong>" + escape_html(sentence) + "</p>";
    if (run.why) body += why_of(*run.why);
    if (const std::string more = circumstances(run); !more.empty())
      body += "<p class=\"more\">" + escape_html(more) + "</p>";
    body += "</li>\n";
  }
  return section("verdict", "Verdict", {}, body + "</ul>\n");
}

}  // namespace canyon::report
