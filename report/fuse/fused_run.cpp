#include "canyon/report/fuse/fused_run.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

constexpr double kWeek_s = 604800.0;

/// Where times are counted from.
struct Start {
  double week = 0.0, sow_s = 0.0;
  double since_s(double of_week, double at_sow_s) const { return (of_week - week) * kWeek_s + (at_sow_s - sow_s); }
};

FusedFigures read_figures(const JsonFields& f, const std::string& name) {
  const JsonFields outage = f.object("outage");
  return {.name = name,
          .rms_3d_m = f.number("rms_3d_m"),
          .final_m = f.number("final_error_m"),
          .nees = f.number("nees_mean"),
          .position_enu_m = {f.number("rms_e_m"), f.number("rms_n_m"), f.number("rms_u_m")},
          .velocity_enu_m_s = f.numbers("velocity_rms_m_s", 3),
          .attitude_deg = f.numbers("attitude_rms_deg", 3),
          .outage_horizontal_m = outage.number("horizontal_rms_of_max_m"),
          .outage_vertical_m = outage.number("vertical_rms_of_max_m")};
}

std::vector<FusedOutage> read_outages(const JsonFields& f, const Start& start) {
  std::vector<FusedOutage> out;
  for (const auto& [node, path] : f.object("outage").list("windows")) {
    const JsonFields w(node, f.file(), path, f.error());
    // Within the week, as the file has it.
    FusedOutage outage{start.since_s(start.week, w.number("from_sow_s")),
                       start.since_s(start.week, w.number("to_sow_s")), w.number("horizontal_max_m"),
                       w.number("vertical_max_m")};
    if (outage.to_s < 0.0) outage.from_s += kWeek_s, outage.to_s += kWeek_s;
    out.push_back(outage);
  }
  return out;
}

std::vector<std::string> names_of(const JsonFields& f, const char* key) {
  std::vector<std::string> out;
  for (const auto& [node, path] : f.list(key))
    if (node->is_string()) out.push_back(node->get<std::string>());
  return out;
}

std::vector<std::string> read_mended(const JsonFields& f) {
  std::vector<std::string> out;
  for (const char* group : {"incidents", "diagnoses"}) {
    const JsonFields all = f.object(group);
    if (all.node() == nullptr || !all.node()->is_object()) continue;
    for (const auto& [key, node] : all.node()->items()) {
      if (node.is_object()) {
        const JsonFields one = all.object(key);
        out.push_back(show_count(one.number("count")) + " \xC3\x97 " + one.text("what"));
      } else {
        std::string words = key;
        std::replace(words.begin(), words.end(), '_', ' ');
        out.push_back(show_count(all.number(key)) + " \xC3\x97 " + words);
      }
    }
  }
  return out;
}

Result<std::optional<EpochTable>> read_errors(const std::string& path, const Start& start) {
  std::optional<EpochTable> out;
  if (!std::filesystem::exists(path)) return out;
  CANYON_TRY(const std::string csv, read_text_file(path));
  CANYON_TRY(out,
             parse_epoch_table(csv, path,
                               {.numbers = {"gps_week",        "sow",           "scored",         "error_e_m",
                                            "error_n_m",       "error_u_m",     "sigma_e_m",      "sigma_n_m",
                                            "sigma_u_m",       "error_ve_m_s",  "error_vn_m_s",   "error_vu_m_s",
                                            "sigma_ve_m_s",    "sigma_vn_m_s",  "sigma_vu_m_s",   "error_roll_deg",
                                            "error_pitch_deg", "error_yaw_deg", "sigma_roll_deg", "sigma_pitch_deg",
                                            "sigma_yaw_deg"},
                                .texts = {},
                                .in_order = false}));
  std::vector<double>& t_s = out->numbers["t_s"];
  for (std::size_t i = 0; i < out->rows; ++i) t_s.push_back(start.since_s((*out)["gps_week"][i], (*out)["sow"][i]));
  return out;
}

Status read_innovations(const std::string& path, const Start& start, FusedRun& run) {
  CANYON_TRY(const std::string csv, read_text_file(path));
  CANYON_TRY(const EpochTable table, parse_epoch_table(csv, path,
                                                       {.numbers = {"gps_week", "sow", "accepted", "dimension", "nis"},
                                                        .texts = {"measurement"},
                                                        .in_order = false}));
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < table.rows; ++i) {
    const std::string& name = table.text("measurement")[i];
    if (name.empty()) continue;
    const auto [place, is_new] = places.emplace(name, run.innovations.size());
    if (is_new) run.innovations.push_back({.name = name, .t_s = {}, .nis = {}});
    FusedMeasurement& m = run.innovations[place->second];
    m.count += 1.0;
    m.accepted += table["accepted"][i];
    m.dimension = std::max(m.dimension, static_cast<int>(table["dimension"][i]));
    m.t_s.push_back(start.since_s(table["gps_week"][i], table["sow"][i]));
    m.nis.push_back(table["nis"][i]);
  }
  for (FusedMeasurement& m : run.innovations) {
    std::vector<std::size_t> order(m.t_s.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return m.t_s[a] < m.t_s[b]; });
    const FusedMeasurement as_written = m;
    for (std::size_t i = 0; i < order.size(); ++i) {
      m.t_s[i] = as_written.t_s[order[i]];
      m.nis[i] = as_written.nis[order[i]];
    }
  }
  return Ok{};
}

}  // namespace

Result<FusedRun> read_fused_run(const std::string& directory) {
  const std::string path = directory + "/summary.json";
  CANYON_TRY(const std::string text, read_text_file(path));
  CANYON_TRY(const JsonFile file, JsonFile::parse(text, path));
  std::optional<Error> error;
  const JsonFields f(&file.root(), file, "", error);
  const JsonFields at = f.object("start"), inputs = f.object("inputs"), smoother = f.object("smoother");
  const Start start{at.required_number("week"), at.required_number("sow_s")};
  FusedRun out;
  out.start_from = at.text("from");
  out.imu = inputs.text("imu");
  out.gnss = inputs.text("gnss");
  out.truth = inputs.text("truth");
  out.states = names_of(f, "states");
  out.measurements = names_of(f, "measurements");
  out.duration_s = f.required_number("duration_s");
  out.samples = f.number("samples");
  out.fixes = f.number("fixes");
  out.fixes_accepted = f.number("fixes_accepted");
  out.fixes_withheld = f.number("fixes_withheld");
  out.restarts = f.number("restarts");
  out.trajectories.push_back(read_figures(f, "filter"));
  out.outages.push_back(read_outages(f, start));
  if (f.has("smoother")) {
    out.trajectories.push_back(read_figures(smoother, smoother.text("name")));
    out.outages.push_back(read_outages(smoother, start));
  }
  out.verdict = read_filter_verdict(f);
  out.mended = read_mended(f);
  if (error) return *error;
  for (std::size_t i = 0; i < out.trajectories.size(); ++i) {
    CANYON_TRY(auto errors, read_errors(directory + (i == 0 ? "/errors.csv" : "/smoothed_errors.csv"), start));
    out.errors.push_back(std::move(errors));
  }
  CANYON_TRY_STATUS(read_innovations(directory + "/innovations.csv", start, out));
  return out;
}

}  // namespace canyon::report
