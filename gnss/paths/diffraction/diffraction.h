#pragma once

#include <memory>
#include <span>

#include "canyon/core/model_table.h"
#include "canyon/gnss/paths/path_model.h"

namespace canyon::gnss {

/// What edges make of the straight way.
class DiffractionModel {
 public:
  virtual ~DiffractionModel() = default;
  /// `out` has line_of_sight; adds echoes (not sorted) and changes `direct`.
  virtual void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
                     std::span<SignalPaths> out, GnssCounters& counters) const = 0;
  /// False if shadows are sharp: then trace() need not be called.
  virtual bool bends() const { return true; }
};

using MakeDiffractionModel =
    MakerAndNeed<std::unique_ptr<DiffractionModel>(const ModelParameters& own, const PathParameters& p),
                 StatePathNeeds>;
ModelTable<MakeDiffractionModel> diffraction_models();

/// Knife edges of ITU-R P.526-15: each convex edge of the scene (roof, corner of a house) that the satellite's wave
/// passes or is cut off by. The point of the edge follows exactly from the law of diffraction (equal angles with the
/// edge, Keller 1962); both legs are tested for obstacles. A blocked satellite gets an echo for every edge that leads
/// the wave round (roof, left and right corner: they add up as fields); a visible one near a shadow's border has its
/// direct field changed by the one edge that comes nearest, from half at the border to ripples of a decibel beyond
/// (nu > -3). The edge is a thin screen: no polarization, no material. With weakest -20 dB a wave bends by at most
/// about 17 degrees at 5 m, 4 degrees at 100 m.
std::unique_ptr<DiffractionModel> make_knife_edge(const PathParameters& p);
/// The same, and for blocked satellites also two edges after each other (P.526-15 section 4.2, first method: the losses
/// of the two edges, the second seen from the first, and the correction for their spacing if both exceed 15 dB).
std::unique_ptr<DiffractionModel> make_double_knife_edge(const PathParameters& p);
/// The same edges as wedges of their own angle and material, by the uniform theory of diffraction (wedge.h), of finite
/// length (finite_edge_factor), both circular polarizations. All edges near a visible satellite's way add echoes too,
/// that on the lit side take from the direct field; fields fade out over 3.5 dB above the weakest. The faces reflect as
/// for the grazing angle of half the bend, which is the mirror's own at the border of its reflection and the same both
/// ways. One edge only, of shadows. With PathParameters::reflection_borders the terms of faces that mirror are left
/// out: those borders are the image search's (mirror_borders.h).
std::unique_ptr<DiffractionModel> make_wedge(const PathParameters& p);

}  // namespace canyon::gnss
