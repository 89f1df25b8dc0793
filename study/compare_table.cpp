#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "canyon/study/compare.h"
#include "canyon/study/results/paired_errors.h"

namespace canyon::study {

namespace {

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(text.size() < width ? width - text.size() : 0, ' ');
  return left ? text + blanks : blanks + text;
}

/// One line of the table: a word, or a number whose ratio makes sense.
struct Line {
  std::string label;
  std::vector<std::string> cells;
  std::string ratio;
};

class Table {
 public:
  explicit Table(const std::vector<RunSummary>& runs) : runs_(runs) {}

  void section(const std::string& title) { lines_.push_back({title, {}, ""}); }
  void words(const std::string& label, const std::function<std::string(const RunSummary&)>& value) {
    Line line{label, {}, ""};
    for (const RunSummary& run : runs_) line.cells.push_back(value(run));
    lines_.push_back(std::move(line));
  }
  void numbers(const std::string& label, int decimals, const std::function<double(const RunSummary&)>& value) {
    capped_numbers(label, decimals, std::numeric_limits<double>::infinity(), value);
  }
  /// Values that reach `cap` are not known beyond it: no ratio of them means anything.
  void capped_numbers(const std::string& label, int decimals, double cap,
                      const std::function<double(const RunSummary&)>& value) {
    Line line{label, {}, ""};
    for (const RunSummary& run : runs_)
      line.cells.push_back(value(run) >= cap ? ">= " + fixed(cap, 0) : fixed(value(run), decimals));
    if (runs_.size() > 1) {
      const bool known = value(runs_[0]) < cap && value(runs_[1]) < cap;
      const double ratio = known ? value(runs_[1]) / value(runs_[0]) : kNaN;
      line.ratio = fixed(ratio, ratio < 10 ? 2 : 1);
    }
    lines_.push_back(std::move(line));
  }

  std::string str() const {
    std::size_t label_width = 0;
    for (const Line& line : lines_)
      if (!line.cells.empty()) label_width = std::max(label_width, line.label.size() + 2);
    std::vector<std::size_t> widths;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      widths.push_back(runs_[i].name.size());
      for (const Line& line : lines_)
        if (i < line.cells.size()) widths.back() = std::max(widths.back(), line.cells[i].size());
    }
    const std::string ratio_title = runs_.size() > 1 ? runs_[1].name + "/" + runs_[0].name : "";
    std::string out = padded("", label_width, true);
    for (std::size_t i = 0; i < runs_.size(); ++i) out += "  " + padded(runs_[i].name, widths[i], false);
    if (!ratio_title.empty()) out += "  " + ratio_title;
    out += "\n";
    for (const Line& line : lines_) {
      if (line.cells.empty()) {
        out += line.label + "\n";
        continue;
      }
      std::string row = padded("  " + line.label, label_width, true);
      for (std::size_t i = 0; i < line.cells.size(); ++i) row += "  " + padded(line.cells[i], widths[i], false);
      if (!line.ratio.empty()) row += "  " + padded(line.ratio, ratio_title.size(), false);
      out += row + "\n";
    }
    return out;
  }

 private:
  const std::vector<RunSummary>& runs_;
  std::vector<Line> lines_;
};

int mission_waypoints(const RunSummary& run) {
  int count = 0;
  for (const auto& waypoint : run.waypoints) count += waypoint.mission ? 1 : 0;
  return count;
}

std::string cell(const std::string& word, double value, int decimals, const char* unit) {
  return word + "  " + fixed(value, decimals) + unit;
}

/// The 2 x 2 of GNSS and IMU fidelity as lines of text; empty unless all four runs are there.
std::string square_text(const std::vector<RunSummary>& runs) {
  const auto square = two_by_two(runs);
  if (!square) return "";
  const bool open_loop = runs.front().open_loop;
  std::size_t width = 14;
  for (const std::string& level : square->levels) width = std::max(width, level.size() + 9);
  std::string out = open_loop ? "2 x 2, open loop: position error RMS on one true motion\n"
                              : "2 x 2, closed loop: outcome and position error RMS\n";
  out += padded("", width, true) + "  " + padded(square->levels[0] + " IMU", 26, true) + "  " + square->levels[1] +
         " IMU\n";
  for (std::size_t g = 0; g < 2; ++g) {
    out += padded("  " + square->levels[g] + " GNSS", width, true);
    for (const RunSummary* run : square->runs[g])
      out += "  " + padded(cell(open_loop ? "" : run->outcome, run->position_m.rms, 2, " m"), 26, true);
    out += "\n";
  }
  return out;
}

}  // namespace

std::string comparison_table(const Results& results) {
  // The mixed runs have a table of their own.
  std::vector<RunSummary> runs;
  for (const RunSummary& run : results.summaries)
    if (run.gnss == run.imu) runs.push_back(run);

  Table table(runs);
  const bool open_loop = results.summaries.front().open_loop;
  table.section(open_loop ? "open loop: one true motion for all runs"
                          : "mission (closed loop: each run drives by itself)");
  if (!open_loop) {
    table.words("outcome", [](const RunSummary& r) { return r.outcome; });
    table.words("waypoints reached", [](const RunSummary& r) {
      return std::to_string(r.waypoints_reached) + " of " + std::to_string(r.waypoints.size());
    });
    table.words("mission waypoints reached", [](const RunSummary& r) {
      return std::to_string(r.mission_waypoints_reached) + " of " + std::to_string(mission_waypoints(r));
    });
  }
  table.numbers("duration, s", 1, [](const RunSummary& r) { return r.duration_s; });
  table.numbers("distance, m", 0, [](const RunSummary& r) { return r.distance_m; });

  table.section("position error of the estimate, m");
  const auto axis = [&](const std::string& label, ErrorStatistics RunSummary::*member) {
    table.numbers(label + ", RMS", 3, [member](const RunSummary& r) { return (r.*member).rms; });
    table.numbers(label + ", 95 %", 3, [member](const RunSummary& r) { return (r.*member).p95; });
    table.numbers(label + ", max", 3, [member](const RunSummary& r) { return (r.*member).max; });
  };
  axis("east", &RunSummary::east_m);
  axis("north", &RunSummary::north_m);
  axis("up", &RunSummary::up_m);
  axis("3-D", &RunSummary::position_m);

  table.section("attitude error, deg RMS");
  table.numbers("roll", 3, [](const RunSummary& r) { return r.roll_rms_deg; });
  table.numbers("pitch", 3, [](const RunSummary& r) { return r.pitch_rms_deg; });
  table.numbers("yaw", 3, [](const RunSummary& r) { return r.yaw_rms_deg; });

  table.section("satellites");
  table.numbers("GDOP, median", 2, [](const RunSummary& r) { return r.gdop_median; });
  table.numbers("GDOP, max", 2, [](const RunSummary& r) { return r.gdop_max; });
  table.words("DOP jumps (|dGDOP| > 2 or fix lost/regained)",
              [](const RunSummary& r) { return r.dop_jumps ? std::to_string(*r.dop_jumps) : "-"; });
  table.numbers("satellites in the fix, mean", 1, [](const RunSummary& r) { return r.satellites_mean; });
  table.numbers("NLOS share of tracked, %", 1, [](const RunSummary& r) { return 100 * r.nlos_share; });
  table.numbers("multipath share of tracked, %", 1, [](const RunSummary& r) { return 100 * r.multipath_share; });
  table.numbers("fix error, RMS, m", 3, [](const RunSummary& r) { return r.fix_error_rms_m; });
  table.words("fixes lost",
              [](const RunSummary& r) { return std::to_string(r.fixes_lost) + " of " + std::to_string(r.fixes_due); });

  table.section("registration and map, m");
  table.numbers("keyframe pose RMS, prior alone", 3, [](const RunSummary& r) { return r.registration_prior_rms_m; });
  table.numbers("keyframe pose RMS, registered", 3, [](const RunSummary& r) { return r.registration_rms_m; });
  table.words("keyframes converged, of those registered", [](const RunSummary& r) {
    if (!r.keyframes_registered) return std::string("-");
    return std::to_string(*r.keyframes_converged) + " of " + std::to_string(*r.keyframes_registered);
  });
  table.numbers("map to true surface RMS, prior alone", 3,
                [](const RunSummary& r) { return r.prior_map.map_error_rms_m; });
  table.numbers("map to true surface RMS, registered", 3,
                [](const RunSummary& r) { return r.registered_map.map_error_rms_m; });
  table.capped_numbers("map to true surface 95 %, prior alone", 3, lidar::kMapErrorCap_m,
                       [](const RunSummary& r) { return r.prior_map.map_error_p95_m; });
  table.capped_numbers("map to true surface 95 %, registered", 3, lidar::kMapErrorCap_m,
                       [](const RunSummary& r) { return r.registered_map.map_error_p95_m; });
  const auto capped = [](const lidar::MapQuality& map) {
    return map.points > 0 ? 100.0 * static_cast<double>(map.capped_points) / static_cast<double>(map.points) : kNaN;
  };
  const std::string beyond = "share counted as " + fixed(lidar::kMapErrorCap_m, 0) + " m (no surface nearer), %, ";
  table.numbers(beyond + "prior", 1, [capped](const RunSummary& r) { return capped(r.prior_map); });
  table.numbers(beyond + "registered", 1, [capped](const RunSummary& r) { return capped(r.registered_map); });
  table.numbers("map up RMS, prior alone", 3, [](const RunSummary& r) { return r.prior_map.map_error_up_rms_m; });
  table.numbers("map up RMS, registered", 3, [](const RunSummary& r) { return r.registered_map.map_error_up_rms_m; });

  table.section("cost");
  table.numbers("real-time factor", 1, [](const RunSummary& r) { return r.real_time_factor(); });
  table.numbers("CPU time, s", 1, [](const RunSummary& r) { return r.cpu_s; });
  table.numbers("CPU time per simulated second, s", 3, [](const RunSummary& r) { return r.cpu_per_simulated_s(); });
  if (!runs.empty())
    for (std::size_t part = 0; part < runs.front().cpu_parts_s.size(); ++part)
      table.numbers("  " + runs.front().cpu_parts_s[part].first + ", s", 2,
                    [part](const RunSummary& r) { return r.cpu_parts_s[part].second; });

  std::string out = table.str();
  for (const RunSummary& run : results.summaries) {
    if (!run.failure) continue;
    out += "\n" + run.name + ": " + run.failure->kind + " at " + fixed(run.failure->t_s, 1) + " s, x " +
           fixed(run.failure->p_W.x(), 1) + " m, y " + fixed(run.failure->p_W.y(), 1) + " m (" + run.failure->detail +
           ")";
  }
  if (out.back() != '\n') out += "\n";
  for (const PairedErrors& pair : results.paired) {
    const std::string interval = std::isfinite(pair.low_m)
                                     ? "95 % interval " + fixed(pair.low_m, 3) + " to " + fixed(pair.high_m, 3) + " m"
                                     : "too short for an interval";
    out += "\n" + pair.b + " against " + pair.a + ", epoch by epoch (" + std::to_string(pair.epochs) +
           "): 3-D error larger by " + fixed(pair.mean_m, 3) + " m on average, " + interval + "; larger at " +
           fixed(100.0 * pair.worse_share, 0) + " % of epochs\n";
  }
  if (const std::string square = square_text(results.summaries); !square.empty()) out += "\n" + square;
  return out;
}

}  // namespace canyon::study
