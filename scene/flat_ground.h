#pragma once

#include "canyon/scene/scene.h"

namespace canyon::scene {

/// Flat streets without a house, 300 m square, at the built-in city's place: made once, for what needs open ground.
const Scene& flat_ground();

}  // namespace canyon::scene
