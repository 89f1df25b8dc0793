#pragma once

#include <memory>
#include <string>

#include "canyon/gnss/paths/diffraction/diffraction.h"
#include "canyon/gnss/paths/path_model.h"

namespace canyon::gnss {

/// A path model with diffraction and the reflection off the ground added to what it finds; echoes by growing excess.
std::unique_ptr<PathModel> make_propagation(std::unique_ptr<PathModel> paths,
                                            std::unique_ptr<DiffractionModel> diffraction, bool ground_reflection,
                                            const PathParameters& p);

}  // namespace canyon::gnss
