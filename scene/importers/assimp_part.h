#pragma once

#include <string>

#include "canyon/core/process/library_part.h"
#include "canyon/core/result.h"
#include "canyon/scene/importers/raw_scene.h"

namespace canyon::scene {

/// What stands on assimp (core/process/library_part.h).
struct AssimpPart {
  Result<RawScene> (*read)(const std::string& path);
};
extern "C" [[gnu::weak]] const AssimpPart canyon_assimp_part;

}  // namespace canyon::scene
