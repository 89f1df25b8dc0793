#pragma once

#include <memory>
#include <string>

#include "canyon/gnss/paths/clutter/clutter.h"
#include "canyon/gnss/paths/diffraction/diffraction.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/gnss/paths/scatter/scatter.h"

namespace canyon::gnss {

/// Keys of what happens to signals in the scene.
struct PropagationConfig {
  ModelChoice<path_models> paths{"specular1"};
  ModelChoice<diffraction_models> diffraction{"none"};
  ModelChoice<scatter_models> scatter{"none"};
  ModelChoice<clutter_models> clutter{"none"};
  bool ground_reflection = false;
  bool reflection_borders = false;
  double surface_roughness_m = 0.0;  ///< standard deviation of the reflecting surfaces' height
};
void visit(FieldVisitor& f, PropagationConfig& c);

/// The limits, with mirrors that end by and by where they are asked for (PathParameters::reflection_borders; of the
/// image search alone). Those of hidden satellites are the visible ones' then: an echo that was followed down to
/// another strength would come or go at once where its satellite goes out of sight.
PathParameters with_borders(const PropagationConfig& c, PathParameters limits);

/// All of it. `limits`: what the receiver can notice; the roughness is the configuration's.
Result<std::unique_ptr<PathModel>> make_propagation(const PropagationConfig& config, PathParameters limits);

/// A path model with the reflection off the ground, diffraction, scattering and clutter (null: none) added to what it
/// finds, in that order; echoes by growing excess.
std::unique_ptr<PathModel> make_propagation(std::unique_ptr<PathModel> paths,
                                            std::unique_ptr<DiffractionModel> diffraction, bool ground_reflection,
                                            const PathParameters& p, std::unique_ptr<ScatterModel> scatter = nullptr,
                                            std::unique_ptr<ClutterModel> clutter = nullptr);

}  // namespace canyon::gnss
