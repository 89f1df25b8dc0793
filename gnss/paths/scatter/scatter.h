#pragma once

#include <memory>
#include <span>

#include "canyon/gnss/paths/path_model.h"

namespace canyon::gnss {

/// What walls send on beside their mirror image.
class ScatterModel {
 public:
  virtual ~ScatterModel() = default;
  /// `out` has line_of_sight; adds echoes, not sorted.
  virtual void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
                     std::span<SignalPaths> out, GnssCounters& counters) const = 0;
  /// Share of the power that walls give back which is scattered; the rest is the mirrors'. None scatters: trace() adds
  /// nothing.
  virtual ScatteredShare scattered_share() const = 0;
};

using MakeScatterModel =
    MakerAndNeed<std::unique_ptr<ScatterModel>(const ModelParameters& own, const PathParameters& p), StatePathNeeds>;
ModelTable<MakeScatterModel> scatter_models();

/// Effective roughness, directive lobe (Degli-Esposti, Fuschini, Vitucci & Falciasecca, IEEE Trans. Antennas
/// Propag. 55 (2007) 143): see facade_scatter.cpp.
std::unique_ptr<ScatterModel> make_directive_scatter(const ModelParameters& own, const PathParameters& p);
void directive_scatter_parameters(ModelParameters& section);

}  // namespace canyon::gnss
