#pragma once

#include <string>

#include "canyon/core/result.h"
#include "canyon/scene/scene.h"

namespace canyon::scene {

/// A scene as files that any 3-D program opens, and that read back as the same scene, to the bit: scene.obj and
/// scene.mtl (triangles in W, metres, z up), materials.toml, and scene.json with what those cannot carry: the frame,
/// kinds of objects, buildings, tree crowns and streets.
Status write_scene(const SceneParts& parts, const std::string& directory);

/// True if a file's text begins like scene.json.
bool is_written_scene(std::string_view beginning);
/// Reads scene.json and the files beside it.
Result<SceneParts> read_written_scene(const std::string& path);

}  // namespace canyon::scene
