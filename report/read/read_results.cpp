#include "canyon/report/read/read_results.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/messages.h"

namespace canyon::report {
namespace {

namespace fs = std::filesystem;

/// Cells along the scene's longer side: about one per metre of the built-in city, two per pixel of a column of the
/// page.
constexpr std::size_t kMapCells = 900;

const EpochColumns kNavColumns{{"t_s", "true_x_m", "true_y_m", "est_x_m", "est_y_m", "sigma_e_m", "sigma_n_m",
                                "sigma_u_m", "error_e_m", "error_n_m", "error_u_m", "waypoint"},
                               {"state"}};
const EpochColumns kGnssColumns{{"t_s", "satellites", "tracked", "nlos", "gdop", "error_e_m", "error_n_m", "error_u_m",
                                 "multipath_max_m", "accepted", "nis"},
                                {"status", "reason"}};
const EpochColumns kSatelliteColumns{{"t_s", "elevation_deg", "line_of_sight", "tracked", "multipath_m"},
                                     {"satellite"}};
const EpochColumns kKeyframeColumns{{"t_s", "prior_error_m", "prior_error_up_m", "registered_error_m",
                                     "registered_error_up_m", "step_nees", "open_directions"},
                                    {"status"}};

/// A file that need not be there.
Status read_epochs(const fs::path& path, const EpochColumns& columns, std::optional<EpochTable>& table) {
  if (!fs::exists(path)) return Ok{};
  CANYON_TRY(const std::string csv, read_text_file(path.string()));
  CANYON_TRY(table, parse_epoch_table(csv, path.string(), columns));
  return Ok{};
}

Status read_cloud(const fs::path& path, const MapGrid& grid, std::optional<CloudSummary>& cloud) {
  if (!fs::exists(path)) return Ok{};
  CANYON_TRY(cloud, summarize_cloud(path.string(), grid));
  return Ok{};
}

}  // namespace

double Run::figure(std::string_view key) const {
  const auto found = figures.find(key);
  return found == figures.end() ? kNaN : found->second;
}

bool Run::registers() const {
  if (!keyframes || keyframes->rows == 0) return true;  // nothing says otherwise
  const std::vector<std::string>& status = keyframes->text("status");
  return std::any_of(status.begin(), status.end(), [](const std::string& s) { return s != "not_registered"; }) ||
         std::isfinite(figure("registration_error_rms_m"));
}

const Run* Results::run(std::string_view fidelity) const {
  for (const Run& run : runs) {
    if (run.fidelity == fidelity) return &run;
  }
  return nullptr;
}

const Figure* Results::figure(std::string_view key) const {
  for (const Figure& figure : figures) {
    if (figure.key == key) return &figure;
  }
  return nullptr;
}

Status read_manifest(std::string_view json, const std::string& file, Results& results) {
  CANYON_TRY(const JsonFile tree, JsonFile::parse(json, file));
  std::optional<Error> error;
  const JsonFields fields(&tree.root(), tree, {}, error);
  results.version = fields.text("version");
  results.commit = fields.text("commit");
  results.command_line = fields.text("command_line");
  results.instruction_set = fields.text("instruction_set");
  results.scene_hash = fields.text("scene_hash");
  const JsonFields configuration = fields.object("configuration");
  for (Run& run : results.runs) {
    const JsonFields success = configuration.object(run.fidelity).object("success");
    run.rules = {success.number("waypoint_radius_m"), success.number("stop_s")};
  }
  if (error) return *error;
  return Ok{};
}

Result<Results> read_results(const std::string& directory) {
  const fs::path root(directory);
  if (!fs::is_directory(root)) return Error{directory, 0, {}, "no such directory", "a results directory"};
  const std::string summary = (root / "summary.json").string();
  const std::string scene = (root / "scene.json").string();
  const std::string manifest = (root / "manifest.json").string();

  Results results;
  CANYON_TRY(const std::string summary_json, read_text_file(summary));
  CANYON_TRY_STATUS(read_summary(summary_json, summary, results));
  CANYON_TRY(const std::string scene_json, read_text_file(scene));
  CANYON_TRY_STATUS(read_scene_drawing(scene_json, scene, results.drawing));
  if (fs::exists(manifest)) {
    CANYON_TRY(const std::string manifest_json, read_text_file(manifest));
    CANYON_TRY_STATUS(read_manifest(manifest_json, manifest, results));
  }
  if (const std::string why = (root / "why.json").string(); fs::exists(why)) {
    CANYON_TRY(const std::string why_json, read_text_file(why));
    CANYON_TRY_STATUS(read_why(why_json, why, results));
  }
  results.grid = MapGrid::over(results.drawing.min_W, results.drawing.max_W, kMapCells);
  for (Run& run : results.runs) {
    const fs::path epochs = root / "epochs";
    CANYON_TRY_STATUS(read_epochs(epochs / (run.fidelity + "_nav.csv"), kNavColumns, run.nav));
    CANYON_TRY_STATUS(read_epochs(epochs / (run.fidelity + "_gnss.csv"), kGnssColumns, run.gnss_epochs));
    CANYON_TRY_STATUS(read_epochs(epochs / (run.fidelity + "_satellites.csv"), kSatelliteColumns, run.satellites));
    CANYON_TRY_STATUS(read_epochs(epochs / (run.fidelity + "_keyframes.csv"), kKeyframeColumns, run.keyframes));
    CANYON_TRY_STATUS(read_cloud(root / "clouds" / (run.fidelity + "_prior.pcd"), results.grid, run.prior_cloud));
    CANYON_TRY_STATUS(
        read_cloud(root / "clouds" / (run.fidelity + "_registered.pcd"), results.grid, run.registered_cloud));
  }
  return results;
}

}  // namespace canyon::report
