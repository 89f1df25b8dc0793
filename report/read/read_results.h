#pragma once

#include <string>

#include "canyon/report/read/json_fields.h"
#include "canyon/report/read/results.h"

namespace canyon::report {

/// Reads a results directory (docs/results.md). summary.json and scene.json must be there; manifest.json, epochs and
/// clouds may be missing, as may any figure. What is there must be well formed: the first mistake comes back with file,
/// line and key.
Result<Results> read_results(const std::string& directory);

/// Parts of it. `file` is named in errors.
Status read_summary(std::string_view json, const std::string& file, Results& results);
Status read_scene_drawing(std::string_view json, const std::string& file, SceneDrawing& drawing);
/// Reads why.json into the runs that it names; summary.json must have been read. What is of further seeds stands apart.
Status read_why(std::string_view json, const std::string& file, Results& results);

Status read_manifest(std::string_view json, const std::string& file, Results& results);

}  // namespace canyon::report
