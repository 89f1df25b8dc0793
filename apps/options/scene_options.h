#pragma once

#include <string>

#include "canyon/apps/line/verb.h"
#include "canyon/scene/scene_source.h"

namespace canyon::apps {

/// Options that say which scene, shared by the verbs of group scene.
struct SceneOptions {
  std::string scene;  ///< a scene file, a mission file, "vicksburg" or "city"
  scene::ImportConfig from;
};
/// The options beside it, for verbs that name the scene in their own way.
void declare_import_options(Arguments& arguments, scene::ImportConfig& from);
/// `scenes`: what the argument may be, for --help.
void declare_scene_options(Arguments& arguments, SceneOptions& options, const char* scenes);

/// [scene] of a mission file or of the built-in mission, or the scene file with the options.
Result<scene::SceneConfig> scene_config(const SceneOptions& options);

}  // namespace canyon::apps
