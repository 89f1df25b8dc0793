#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/report/read/read_results.h"

namespace canyon::report {
namespace {

Eigen::Vector2d point(const JsonNode& node, const JsonFields& owner, const std::string& path) {
  const std::vector<double> xy = json_numbers(node, 2, owner.file(), path, owner.error());
  if (!owner.error() && !(std::isfinite(xy[0]) && std::isfinite(xy[1]))) {
    owner.error() = owner.file().mistake(node, path, "null in a point", "a list of 2 numbers");
  }
  return {xy[0], xy[1]};
}

Mission read_mission(const JsonFields& fields) {
  Mission mission;
  mission.name = fields.required_text("name");
  mission.seed = fields.digits("seed");
  mission.start = fields.text("start");
  mission.nominal_duration_s = fields.number("nominal_duration_s");
  mission.time_limit_s = fields.number("time_limit_s");
  for (const auto& [node, path] : fields.list("route")) mission.route_W.push_back(point(*node, fields, path));
  for (const auto& [node, path] : fields.list("waypoints")) {
    const JsonFields f(node, fields.file(), path, fields.error());
    mission.waypoints.push_back({.name = f.required_text("name"),
                                 .p_W = {f.required_number("x_m"), f.required_number("y_m")},
                                 .mission = f.flag("mission"),
                                 .building = f.text("building")});
  }
  return mission;
}

SceneFacts read_scene_facts(const JsonFields& fields) {
  const JsonFields origin = fields.object("origin");
  return {.name = fields.text("name"),
          .buildings = fields.number("buildings"),
          .triangles = fields.number("triangles"),
          .extent_m = fields.numbers("extent_m", 3),
          .lat_deg = origin.number("lat_deg"),
          .lon_deg = origin.number("lon_deg"),
          .h_m = origin.number("h_m")};
}

/// A name that may stand in a file's name: it becomes epochs/NAME_nav.csv.
void check_run_name(const JsonFields& fields, const std::string& name) {
  if (name.empty() || name.find_first_of("/\\") != std::string::npos || name.find('\0') != std::string::npos ||
      name[0] == '.') {
    fields.fail(fields.find("fidelity"), "fidelity", "'" + name + "'", "a name that can be part of a file's name");
  }
}

/// What the figures are. A directory of before they were described has its runs' numbers, under their keys.
std::vector<Figure> read_figure_list(const JsonFields& summary) {
  std::vector<Figure> figures;
  for (const auto& [node, path] : summary.list("figures")) {
    const JsonFields f(node, summary.file(), path, summary.error());
    const std::string kind = f.text("kind");
    figures.push_back({.key = f.required_text("key"),
                       .group = f.text("group"),
                       .label = f.required_text("label"),
                       .unit = f.text("unit"),
                       .meaning = f.text("meaning"),
                       .better = f.text("better"),
                       .total = f.text("total"),
                       .kind = kind == "count"   ? Figure::Kind::kCount
                               : kind == "share" ? Figure::Kind::kShare
                                                 : Figure::Kind::kQuantity,
                       .cap = f.number("cap"),
                       .timing = f.text("under") == "timing"});
  }
  const auto runs = summary.list("runs");
  if (figures.empty() && !runs.empty() && runs.front().first->is_object()) {
    for (const auto& [key, node] : runs.front().first->items()) {
      if (node.is_number()) figures.push_back({.key = key, .group = "Figures", .label = key});
    }
  }
  return figures;
}

Interval read_interval(const JsonFields& fields) {
  return {fields.number("low"), fields.number("high")};
}

void read_figures(const JsonFields& fields, const std::vector<Figure>& figures, Run& run) {
  const JsonFields timing = fields.object("timing"), intervals = fields.object("intervals");
  for (const Figure& figure : figures) {
    const JsonFields& owner = figure.timing ? timing : fields;
    run.figures[figure.key] = figure.kind == Figure::Kind::kShare ? owner.share(figure.key) : owner.number(figure.key);
    if (intervals.has(figure.key)) run.intervals[figure.key] = read_interval(intervals.object(figure.key));
  }
}

std::vector<std::pair<std::string, double>> read_counters(const JsonFields& fields) {
  std::vector<std::pair<std::string, double>> out;
  if (!fields.node()) return out;
  for (const auto& member : fields.node()->items()) out.emplace_back(member.key(), fields.number(member.key()));
  return out;
}

Run read_run(const JsonFields& fields, const std::vector<Figure>& figures) {
  Run run;
  run.fidelity = fields.required_text("fidelity");
  check_run_name(fields, run.fidelity);
  run.gnss = fields.has("gnss") ? fields.text("gnss") : run.fidelity;
  run.imu = fields.has("imu") ? fields.text("imu") : run.fidelity;
  if (fields.has("filter")) run.filter = fields.text("filter");
  // null in an open loop
  if (const JsonNode* node = fields.find("outcome"); node == nullptr || !node->is_null())
    run.outcome = fields.required_text("outcome");
  if (fields.has("failure")) {
    const JsonFields f = fields.object("failure");
    run.failure = Failure{f.required_text("kind"), f.text("detail"), f.number("t_s"), f.number("x_m"), f.number("y_m")};
  }
  read_figures(fields, figures, run);
  for (const auto& [node, path] : fields.list("mission_waypoints")) {
    const JsonFields f(node, fields.file(), path, fields.error());
    run.mission_waypoints.push_back({f.text("name"), f.flag("reached"), f.number("closest_m"), f.number("stopped_s"),
                                     f.share("facade_seen_share")});
  }
  run.filter_verdict = read_filter_verdict(fields);
  run.counters = read_counters(fields.object("counters"));
  const JsonFields timing = fields.object("timing");
  for (const auto& [node, path] : timing.list("parts")) {
    const JsonFields f(node, fields.file(), path, fields.error());
    run.cpu_parts_s.emplace_back(f.required_text("name"), f.number("cpu_s"));
  }
  return run;
}

std::vector<std::string> read_names(const JsonFields& fields, std::string_view key) {
  std::vector<std::string> names;
  for (const auto& [node, path] : fields.list(key, true)) {
    if (!node->is_string()) fields.fail(node, key, describe(*node), "a list of names");
    names.push_back(node->is_string() ? node->get<std::string>() : std::string());
  }
  return names;
}

TwoByTwo read_two_by_two(const JsonFields& fields) {
  TwoByTwo table;
  table.gnss = read_names(fields, "gnss");
  table.imu = read_names(fields, "imu");
  const auto rows_of = [&](std::string_view key) {
    auto rows = fields.list(key);
    if (!rows.empty() && rows.size() != table.gnss.size()) {
      fields.fail(fields.find(key), key, describe(*fields.find(key)), std::to_string(table.gnss.size()) + " rows");
      rows.clear();
    }
    return rows;
  };
  for (const auto& [node, path] : rows_of("outcome")) {
    std::vector<std::string> row;
    if (!node->is_array() || node->size() != table.imu.size()) {
      fields.fail(node, "outcome", describe(*node), std::to_string(table.imu.size()) + " outcomes in a row");
      break;
    }
    for (const JsonNode& cell : *node) {
      if (!cell.is_null() && !cell.is_string()) fields.fail(&cell, "outcome", describe(cell), "a string or null");
      row.push_back(cell.is_string() ? cell.get<std::string>() : std::string());
    }
    table.outcome.push_back(std::move(row));
  }
  if (!fields.node()) return table;
  for (const auto& [key, member] : fields.node()->items()) {
    if (key == "gnss" || key == "imu" || key == "outcome") continue;
    if (!member.is_array()) continue;  // something a later version added
    for (const auto& [node, path] : rows_of(key)) {
      table.figures[key].push_back(json_numbers(*node, table.imu.size(), fields.file(), path, fields.error()));
    }
  }
  return table;
}

OpenLoop read_open_loop(const JsonFields& fields) {
  OpenLoop loop{.tape = fields.text("tape"), .paired = {}};
  for (const auto& [node, path] : fields.list("paired_epochs")) {
    const JsonFields f(node, fields.file(), path, fields.error());
    loop.paired.push_back({f.required_text("a"), f.required_text("b"), f.number("epochs"),
                           f.number("position_error_difference_m"), f.number("low_m"), f.number("high_m"),
                           f.number("worse_share")});
  }
  return loop;
}

OverSeeds read_over_seeds(const JsonFields& summary) {
  OverSeeds out;
  const auto seeds = summary.list("seeds");
  out.count = static_cast<double>(seeds.size());
  for (const auto& [node, path] : seeds) {
    if (!node->is_number_integer()) summary.fail(node, path, describe(*node), "a seed");
    (out.first.empty() ? out.first : out.last) = node->dump();
  }
  for (const auto& [node, path] : summary.list("shares")) {
    const JsonFields f(node, summary.file(), path, summary.error());
    out.shares.push_back({f.required_text("fidelity"), f.number("success"), f.number("n"), read_interval(f),
                          read_counters(f.object("outcomes"))});
  }
  for (const auto& [node, path] : summary.list("paired")) {
    const JsonFields f(node, summary.file(), path, summary.error());
    out.paired.push_back({f.required_text("a"), f.required_text("b"), f.text("figure"), f.number("n"),
                          f.number("difference"), read_interval(f), f.number("p")});
  }
  for (const auto& [node, path] : summary.list("over_seeds")) {
    const JsonFields f(node, summary.file(), path, summary.error());
    auto& of_run = out.medians.emplace_back(f.required_text("fidelity"), std::map<std::string, Median, std::less<>>());
    for (const char* part : {"figures", "timing"}) {
      const JsonFields rows = f.object(part);
      if (rows.node() == nullptr || !rows.node()->is_object()) continue;
      for (const auto& [key, member] : rows.node()->items()) {
        const JsonFields row = rows.object(key);
        of_run.second[key] = {row.number("median"), read_interval(row), row.number("min"), row.number("max")};
      }
    }
  }
  return out;
}

/// Those of the first seed; of the others over_seeds speaks.
std::vector<Run> read_runs(const JsonFields& fields, const std::string& first_seed,
                           const std::vector<Figure>& figures) {
  std::vector<Run> runs;
  for (const auto& [node, path] : fields.list("runs", true)) {
    if (node->is_null()) fields.fail(node, path, "null", "an object");
    const JsonFields run(node, fields.file(), path, fields.error());
    if (run.has("seed") && run.digits("seed") != first_seed) continue;
    runs.push_back(read_run(run, figures));
    for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
      if (runs[i].fidelity == runs.back().fidelity)
        fields.fail(node, path + ".fidelity", "'" + runs[i].fidelity + "' given twice", "each run once");
    }
  }
  if (!fields.error() && runs.empty()) fields.fail(fields.find("runs"), "runs", "empty", "at least one run");
  return runs;
}

LoopBeside read_beside(const JsonFields& fields, const std::string& first_seed, const std::vector<Figure>& figures,
                       bool several_seeds) {
  LoopBeside beside;
  beside.loop = read_open_loop(fields);
  beside.duration_s = fields.number("duration_s");
  beside.runs = read_runs(fields, first_seed, figures);
  if (fields.has("seeds")) beside.over_seeds = read_over_seeds(fields);
  if (beside.over_seeds.has_value() != several_seeds)
    fields.fail(fields.find("seeds"), "seeds", several_seeds ? "missing" : "given",
                several_seeds ? "as of the closed loop" : "none, as of the closed loop");
  return beside;
}

}  // namespace

Status read_summary(std::string_view json, const std::string& file, Results& results) {
  CANYON_TRY(const JsonFile tree, JsonFile::parse(json, file));
  std::optional<Error> error;
  const JsonFields fields(&tree.root(), tree, {}, error);
  const double schema = fields.required_number("schema");
  if (!error && schema != 1) fields.fail(fields.find("schema"), "schema", describe(*fields.find("schema")), "1");
  if (!fields.has("mission")) fields.fail(nullptr, "mission", "missing", "an object");
  results.mission = read_mission(fields.object("mission"));
  results.scene = read_scene_facts(fields.object("scene"));
  results.figures = read_figure_list(fields);
  results.runs = read_runs(fields, results.mission.seed, results.figures);
  if (fields.has("seeds")) results.over_seeds = read_over_seeds(fields);
  if (fields.has("two_by_two_by_filter")) {
    const JsonFields by_filter = fields.object("two_by_two_by_filter");
    if (by_filter.node() != nullptr) {  // else it is no object, which is told
      for (const auto& [filter, node] : by_filter.node()->items()) {
        results.two_by_two.push_back(read_two_by_two(by_filter.object(filter)));
        results.two_by_two.back().filter = filter;
      }
    }
  } else if (fields.has("two_by_two")) {
    results.two_by_two.push_back(read_two_by_two(fields.object("two_by_two")));
  }
  if (fields.has("loop") && fields.object("loop").text("kind") == "open")
    results.open_loop = read_open_loop(fields.object("loop"));
  if (fields.has("open_loop"))
    results.beside =
        read_beside(fields.object("open_loop"), results.mission.seed, results.figures, results.over_seeds.has_value());
  results.hash = fields.text("hash");
  const JsonFields timing = fields.object("timing");
  results.wall_s = timing.number("wall_s");
  results.cpu_s = timing.number("cpu_s");
  results.peak_memory_mb = timing.number("peak_memory_mb");
  results.threads = timing.number("threads");
  if (error) return *error;
  return Ok{};
}

}  // namespace canyon::report
