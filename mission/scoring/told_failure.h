#pragma once

#include "canyon/core/output/failure_words.h"
#include "canyon/mission/scoring/scorer.h"

namespace canyon::mission {

/// A failure as its words are made of.
ToldFailure told_failure(const Failure& failure);

/// What a scene's object is called where it is hit: its kind before its name, unless the name begins so: "vehicle 350",
/// "building relation 123", of what moves "other vehicle bus 2".
std::string name_with_kind(const scene::SceneAt& scene, std::uint32_t object);

}  // namespace canyon::mission
