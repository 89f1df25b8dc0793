#include "canyon/study/results/results.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/core/files/file_hash.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/process/version.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/scene/tracing/ray_tracer_instructions.h"
#include "canyon/study/plan/plan_file.h"
#include "canyon/study/results/figures.h"
#include "canyon/study/results/over_seeds.h"
#include "canyon/study/results/verdict_json.h"

namespace canyon::study {

namespace {

/// Undefined is null, never 0 or NaN.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json known(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json point(const Eigen::Vector2d& p) {
  return Json::array({p.x(), p.y()});
}

Json waypoints_json(const mission::MissionConfig& config) {
  Json out = Json::array();
  for (const mission::Waypoint& waypoint : config.autonomy.waypoints)
    out.push_back({{"name", waypoint.name},
                   {"x_m", waypoint.p_m.x()},
                   {"y_m", waypoint.p_m.y()},
                   {"mission", waypoint.is_mission()},
                   {"building", waypoint.is_mission() ? Json(waypoint.observe) : Json(nullptr)}});
  return out;
}

/// A figure of a run: with several seeds its median over them, or of closed loops how many succeed, of how many ended.
Json figure_of(const RunSummary& run, const std::string& key, const Results& results, const OverSeeds* seeds) {
  if (seeds == nullptr) return run_json(run)[key];
  const auto k = static_cast<std::size_t>(&run - results.summaries.data());
  if (key == "successes" || key == "ended") {
    if (seeds->open_loop) return nullptr;
    return key == "ended" ? seeds->shares[k].n : seeds->shares[k].success;
  }
  for (const FigureOverSeeds& row : seeds->figures[k])
    if (row.figure->key == key) return number(row.median.value);
  return nullptr;
}

Json square_json(const TwoByTwo& square, const Results& results, const OverSeeds* seeds) {
  Json out{{"gnss", square.levels}, {"imu", square.levels}};
  std::vector<const char*> keys{"position_error_rms_m", "registration_error_rms_m", "map_error_prior_rms_m"};
  if (seeds == nullptr) keys.insert(keys.begin(), "outcome");
  if (seeds != nullptr) keys.insert(keys.begin(), {"successes", "ended"});
  for (const char* key : keys) {
    out[key] = Json::array();
    for (const auto& row : square.runs)
      out[key].push_back({figure_of(*row[0], key, results, seeds), figure_of(*row[1], key, results, seeds)});
  }
  return out;
}

/// The 2 x 2 of GNSS and IMU, and where the filter is a third factor one of each.
void add_squares(const Results& results, const OverSeeds* seeds, Json& out) {
  const std::vector<TwoByTwo> squares = two_by_two(results.summaries);
  out["two_by_two"] = squares.empty() ? Json(nullptr) : square_json(squares.front(), results, seeds);
  for (const TwoByTwo& square : squares)
    if (!square.filter.empty()) out["two_by_two_by_filter"][square.filter] = square_json(square, results, seeds);
}

/// What errors of an open loop say of two runs epoch by epoch.
Json paired_json(const std::vector<PairedErrors>& pairs) {
  Json paired = Json::array();
  for (const PairedErrors& p : pairs)
    paired.push_back({{"a", p.a},
                      {"b", p.b},
                      {"epochs", p.epochs},
                      {"position_error_difference_m", number(p.mean_m)},
                      {"low_m", number(p.low_m)},
                      {"high_m", number(p.high_m)},
                      {"worse_share", number(p.worse_share)}});
  return paired;
}

/// Which loop the figures are of.
Json loop_json(const Results& results) {
  if (!results.records.front().open_loop) return {{"kind", "closed"}};
  return {{"kind", "open"}, {"tape", results.tape_source}, {"paired_epochs", paired_json(results.paired)}};
}

/// The open loop that stands beside closed ones.
Json open_loop_json(const OpenLoopRuns& open) {
  Json out{{"tape", open.tape_source}, {"duration_s", open.duration_s}, {"runs", Json::array()}};
  for (const auto& runs : open.by_seed)
    for (const RunSummary& run : runs) out["runs"].push_back(run_json(run));
  out["paired_epochs"] = paired_json(open.paired);
  if (open.by_seed.size() > 1) write_over_seeds(over_seeds(open.by_seed), out);
  return out;
}

void remove_timing(Json& node) {
  if (node.is_object()) node.erase("timing");
  if (node.is_structured())
    for (auto& child : node) remove_timing(child);
}

/// SHA-256 over the files of epochs/ and clouds/ by name, and summary.json without timing.
Result<std::string> results_hash(const std::string& directory, Json summary) {
  std::vector<std::string> files;
  for (const char* folder : {"epochs", "clouds"})
    for (const auto& entry : std::filesystem::directory_iterator(directory + "/" + folder))
      files.push_back(std::string(folder) + "/" + entry.path().filename().string());
  std::sort(files.begin(), files.end());
  std::string digest;
  for (const auto& file : files) {
    CANYON_TRY(const std::string of_file, sha256_of_file(directory + "/" + file));
    digest += file + " " + of_file + "\n";
  }
  remove_timing(summary);
  return sha256_hex(digest + json_text(summary));
}

Json made_json(const scene::Scene& scene) {
  const scene::Scene::Made made = scene.made();
  return {{"acceleration_structures", made.acceleration_structures},
          {"tiles", made.tiles},
          {"facets_indexed", made.facets},
          {"edges_indexed", made.edges}};
}

Json manifest_json(const Results& results) {
  Json runs = Json::object(), files = Json::object(), initial = Json::object(), mountings = Json::object(),
       registrations = Json::object();
  for (const mission::RunRecord& record : results.records) {
    for (const mission::InputFile& file : record.files) files[file.path] = file.sha256;
    mission::MissionConfig config = record.config;
    const Eigen::Vector3d &p = record.initial_X_WB.p, &v = record.initial_v_WB_W;
    const Eigen::Quaterniond& q = record.initial_X_WB.R;
    initial[record.name] = {{"position_m", {p.x(), p.y(), p.z()}},
                            {"attitude_wxyz", {q.w(), q.x(), q.y(), q.z()}},
                            {"velocity_m_s", {v.x(), v.y(), v.z()}}};
    const Eigen::Vector3d askew_deg = so3_log(record.imu_R_BU) / kDegree;
    mountings[record.name] = {{"imu_deg", {askew_deg.x(), askew_deg.y(), askew_deg.z()}}};
    const std::string& method = config.registration.method.name;
    registrations[record.name] = {{"name", method},
                                  {"engine", model_row(lidar::registration_methods(), method).make.engine}};
    runs[record.name] = Json::parse(fields_as_json([&config](FieldVisitor& f) { visit(f, config); }));
  }
  Json left_out = Json::object();
  for (std::size_t i = 0; i < results.plans.size(); ++i)
    left_out[results.records[i].name] = left_out_json(results.plans[i]);
  return {{"schema", 1},
          {"left_out", left_out},
          {"version", kVersion},
          {"commit", known(results.commit)},
          {"command_line", known(results.command_line)},
          {"seed", results.records.front().config.run.seed},
          {"start", results.mission->start.iso()},
          {"instruction_set", scene::ray_tracer_instruction_set()},
          {"scene_hash", results.mission->scene->hash()},
          {"files", files},
          {"initial_estimates", initial},
          {"true_mountings", mountings},
          {"registration_method", registrations},
          {"configuration", runs}};
}

}  // namespace

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

Json run_json(const RunSummary& s) {
  Json out;
  out["fidelity"] = s.name;
  out["gnss"] = s.gnss;
  out["imu"] = s.imu;
  if (!s.filter.empty()) out["filter"] = s.filter;
  out["seed"] = s.seed;
  out["outcome"] = s.outcome ? Json(mission::name(*s.outcome)) : Json(nullptr);
  out["failure"] = nullptr;
  if (s.failure)
    out["failure"] = {{"kind", mission::name(s.failure->kind)},
                      {"t_s", s.failure->t_s},
                      {"x_m", s.failure->p_W.x()},
                      {"y_m", s.failure->p_W.y()},
                      {"detail", s.failure->detail}};
  write_figures(s, false, out);
  if (s.failure && s.failure->seen)
    out["failure"]["seen"] = {{"last_range_m", s.failure->seen->range_m},
                              {"in_scans_s", s.failure->seen->stood_s},
                              {"last_seen_s", s.failure->seen->ago_s}};
  out["waypoints"] = Json::array();
  for (const mission::WaypointScore& waypoint : s.waypoints)
    out["waypoints"].push_back({{"name", waypoint.name},
                                {"verdict", waypoint.reached    ? "reached"
                                            : waypoint.believed ? "believed"
                                                                : "missed"},
                                {"closest_m", number(waypoint.closest_m)},
                                {"believed_at_m", number(waypoint.believed_at_m)}});
  out["mission_waypoints"] = Json::array();
  for (const mission::WaypointScore& waypoint : s.waypoints) {
    if (!waypoint.mission) continue;
    out["mission_waypoints"].push_back({{"name", waypoint.name},
                                        {"reached", waypoint.reached},
                                        {"closest_m", waypoint.closest_m},
                                        {"stopped_s", waypoint.stopped_s},
                                        {"facade_seen_share", waypoint.facade_seen_share},
                                        {"facade_range_m", number(waypoint.facade_range_m)},
                                        {"facade_obliquity_deg", number(waypoint.facade_obliquity_deg)},
                                        {"facade_px_per_m", number(waypoint.facade_px_per_m)}});
  }
  out["verdict"] = s.verdict;
  if (s.evidence) out["evidence"] = evidence_json(*s.evidence);
  out["counters"] = s.counters;
  out["timing"] = Json::object();
  write_figures(s, true, out["timing"]);
  Json& parts = out["timing"]["parts"] = Json::array();
  for (const auto& [part, cpu_s] : s.cpu_parts_s) parts.push_back({{"name", part}, {"cpu_s", cpu_s}});
  return out;
}

Json summary_json(const Results& results) {
  const mission::PreparedMission& mission = *results.mission;
  const mission::MissionConfig& config = results.records.front().config;
  const scene::Scene& scene = *mission.scene;
  Json route = Json::array();
  const auto& points = mission.prior.route.points();
  for (std::size_t i = 0; i < points.size(); i += 8) route.push_back(point(points[i]));
  if (!points.empty()) route.push_back(point(points.back()));

  Json out;
  out["schema"] = 1;
  out["mission"] = {{"name", config.run.name},
                    {"seed", config.run.seed},
                    {"start", mission.start.iso()},
                    {"route_length_m", mission.prior.route.length_m()},
                    {"nominal_duration_s", mission.nominal_s},
                    {"time_limit_s", mission.time_limit_s},
                    {"route", route},
                    {"waypoints", waypoints_json(config)}};
  const Eigen::Vector3d extent = scene.extent().max - scene.extent().min;
  out["scene"] = {{"name", scene.name()},
                  {"buildings", scene.buildings().size()},
                  {"triangles", scene.mesh().triangles.size()},
                  {"counters", made_json(scene)},
                  {"extent_m", {extent.x(), extent.y(), extent.z()}},
                  {"origin",
                   {{"lat_deg", scene.frame().origin().lat_rad / kDegree},
                    {"lon_deg", scene.frame().origin().lon_rad / kDegree},
                    {"h_m", scene.frame().origin().h_m}}}};
  out["runs"] = Json::array();
  double cpu_s = 0.0;
  for (const RunSummary& summary : results.summaries) {
    out["runs"].push_back(run_json(summary));
    cpu_s += summary.cpu_s;
  }
  for (const auto& runs : results.further_seeds)
    for (const RunSummary& summary : runs) {
      out["runs"].push_back(run_json(summary));
      cpu_s += summary.cpu_s;
    }
  if (results.open_loop)
    for (const auto& runs : results.open_loop->by_seed)
      for (const RunSummary& summary : runs) cpu_s += summary.cpu_s;
  out["figures"] = figure_descriptions();
  std::optional<OverSeeds> seeds;
  if (!results.further_seeds.empty()) {
    seeds = over_seeds(runs_by_seed(results));
    write_over_seeds(*seeds, out);
  }
  add_squares(results, seeds ? &*seeds : nullptr, out);
  out["loop"] = loop_json(results);
  if (results.open_loop) out["open_loop"] = open_loop_json(*results.open_loop);
  out["timing"] = {{"wall_s", results.wall_s},
                   {"cpu_s", cpu_s},
                   {"peak_memory_mb", results.peak_memory_mb},
                   {"threads", results.threads}};
  return out;
}

Json scene_json(const scene::Scene& scene) {
  Json out;
  const auto& extent = scene.extent();
  out["extent_m"] = {{"min", {extent.min.x(), extent.min.y(), extent.min.z()}},
                     {"max", {extent.max.x(), extent.max.y(), extent.max.z()}}};
  out["buildings"] = Json::array();
  for (const scene::Building& building : scene.buildings()) {
    Json footprint = Json::array();
    for (const auto& corner : building.footprint_W) footprint.push_back(point(corner));
    out["buildings"].push_back({{"name", building.name},
                                {"base_m", building.base_m},
                                {"height_m", building.height_m},
                                {"footprint", footprint}});
  }
  out["streets"] = Json::array();
  const scene::StreetGraph& streets = scene.streets();
  for (const auto& edge : streets.edges)
    out["streets"].push_back(
        {{"a", point(streets.nodes_W[edge.a])}, {"b", point(streets.nodes_W[edge.b])}, {"width_m", edge.width_m}});
  out["trees"] = Json::array();
  for (const scene::Foliage& tree : scene.foliage())
    out["trees"].push_back({tree.center_W.x(), tree.center_W.y(), std::max(tree.radii_m.x(), tree.radii_m.y())});
  // Parked vehicles: the centre of each object's triangles.
  std::vector<Eigen::Vector2d> sum(scene.objects().size(), Eigen::Vector2d::Zero());
  std::vector<double> count(scene.objects().size(), 0.0);
  const scene::Mesh& mesh = scene.mesh();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (scene.objects()[mesh.object[i]].kind != scene::ObjectKind::kVehicle) continue;
    for (const std::uint32_t v : mesh.triangles[i]) sum[mesh.object[i]] += mesh.vertices[v].head<2>().cast<double>();
    count[mesh.object[i]] += 3.0;
  }
  out["vehicles"] = Json::array();
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (count[i] > 0.0) out["vehicles"].push_back(point(sum[i] / count[i]));
  return out;
}

Result<std::string> write_results(const std::string& directory, const Results& results) {
  Json summary = summary_json(results);
  CANYON_TRY(const std::string hash, results_hash(directory, summary));
  summary["hash"] = hash;
  CANYON_TRY_STATUS(write_text_file(directory + "/summary.json", json_text(summary, 1) + "\n"));
  CANYON_TRY_STATUS(write_text_file(directory + "/manifest.json", json_text(manifest_json(results), 1) + "\n"));
  CANYON_TRY_STATUS(write_text_file(directory + "/scene.json", json_text(scene_json(*results.mission->scene)) + "\n"));
  return hash;
}

}  // namespace canyon::study
