#pragma once

#include <memory>
#include <span>

#include "canyon/gnss/paths/path_model.h"

namespace canyon::gnss {

/// What stands and moves in a street and is not in its scene: poles, trees, signs, vehicles, crowds.
class ClutterModel {
 public:
  virtual ~ClutterModel() = default;
  /// `out` has all that the scene makes of the signals; changes its fields and adds echoes, not sorted. What moves does
  /// so by waves.t().
  virtual void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
                     std::span<SignalPaths> out, GnssCounters& counters) const = 0;
  /// False if the street is as the scene says: then trace() need not be called.
  virtual bool acts() const { return true; }
};

using MakeClutterModel =
    MakerAndNeed<std::unique_ptr<ClutterModel>(const ModelParameters& own, const PathParameters& p), StatePathNeeds>;
ModelTable<MakeClutterModel> clutter_models();

/// Shading by ITU-R P.681's two states, and scatterers about the antenna: see street_clutter.cpp.
std::unique_ptr<ClutterModel> make_street_clutter(const ModelParameters& own, const PathParameters& p);
void street_clutter_parameters(ModelParameters& section);

}  // namespace canyon::gnss
