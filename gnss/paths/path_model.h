#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/model_choice.h"
#include "canyon/core/need.h"
#include "canyon/gnss/paths/counters.h"
#include "canyon/gnss/paths/diffraction/fresnel.h"
#include "canyon/gnss/paths/path_omissions.h"
#include "canyon/gnss/paths/plane_waves.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::scene {
class SceneAt;
}

namespace canyon::gnss {

struct PathQuestion;
/// States which of a model's effects can act on a piece of the route (gnss/paths/need/path_question.h).
using StatePathNeeds = std::vector<Need>(const PathQuestion& question);

/// One way from a satellite to the antenna beside the straight one: reflected, diffracted over an edge, or both.
struct SignalPath {
  static constexpr std::size_t kMaxReflections = 3;
  static constexpr std::uint32_t kNoFacet = 0xffffffffu;
  static constexpr std::uint32_t kTerrain = 0xfffffffeu;  ///< reflected by the ground
  /// In the place of the first reflector: scattered by façades, all that come about as late; the second then tells how
  /// late, in steps of the model.
  static constexpr std::uint32_t kScattered = 0xfffffffdu;
  static constexpr std::uint32_t kClutter = 0xfffffffcu;  ///< the same by clutter that the scene lacks

  double excess_m = 0.0;  ///< longer than the straight way by this; >= 0
  /// Field at the antenna relative to the free direct signal of that satellite: right-hand circular that stays
  /// right-hand, and that arrives left-hand. Reflections, roughness and diffraction are in it; foliage, the antenna's
  /// pattern and the phase of the longer way (-2 pi excess / wavelength) are not.
  std::complex<double> copolar, crosspolar;
  Eigen::Vector3d arrival_W{0, 0, 1};  ///< unit, from the antenna to where the signal comes from
  double foliage_m = 0.0;              ///< way through tree crowns, all legs
  /// Of an echo that many scatterers make together: what they have in power, each by itself, of either hand, and how
  /// far they stand apart in direction, 0 to 1 (root mean square, of unit vectors). 0: it is one way.
  double gathered_copolar = 0.0, gathered_crosspolar = 0.0, spread = 0.0;
  int reflections = 0;
  int diffractions = 0;
  /// Reflectors in order from the antenna, the first `reflections` of them: index into Scene::facets(), or kTerrain.
  std::array<std::uint32_t, kMaxReflections> facets{kNoFacet, kNoFacet, kNoFacet};
};

/// How the signal of one satellite reaches the antenna.
struct SignalPaths {
  bool line_of_sight = true;
  double foliage_m = 0.0;  ///< of the straight way
  /// Field of the straight way relative to a free one: 1 in the clear, 0 if blocked; with a diffraction model also what
  /// an edge beside the way makes of it. The signal that bends around the edge into the shadow is an echo.
  std::complex<double> direct = 1.0;
  std::vector<SignalPath> echoes;  ///< by growing excess
};

/// Finds the ways through the scene.
class PathModel {
 public:
  virtual ~PathModel() = default;
  /// The ways, and the fields at each wave's own carrier. out.size() == waves.size().
  virtual void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
                     std::span<SignalPaths> out, GnssCounters& counters) const = 0;
};

/// Which share of the power that an upright wall gives back goes elsewhere than a mirror's (scatter/scatter.h).
struct ScatteredShare {
  bool scatters = false;
  std::optional<double> coefficient;  ///< S of all walls; else each material's own

  double of(const scene::Material& material) const {
    const double s = scatters ? coefficient.value_or(material.scatter_coefficient) : 0.0;
    return s * s;
  }
};

/// What is worth finding. The defaults suit a receiver that tracks 45 dB-Hz at the zenith down to 25 dB-Hz.
struct PathParameters {
  double cutoff_m = 45.0;          ///< visible satellites: later reflections do not matter. Blocked ones have no limit
  double weakest_db = -20.0;       ///< visible satellites: weaker fields (relative to free direct) do not matter
  double weakest_nlos_db = -20.0;  ///< blocked satellites: weaker fields are not tracked
  double roughness_m = 0.0;        ///< standard deviation of the surfaces' height, for the Rayleigh factor
  ScatteredShare scattered_share{};
  /// A facet smaller than its first Fresnel zone reflects less than an infinite one (finite_facet_factor). Off: every
  /// facet reflects like an infinite one.
  bool finite_facets = true;
  /// A facet mirrors what Kirchhoff's integral over it gives (mirrored_share), beside its borders too, in place of that
  /// factor and a sharp border. Of the image search alone.
  bool reflection_borders = false;
  /// Ways with several reflections: within this distance of the antenna all facets are combined; beyond it, only those
  /// that FacetIndex::mirrors gives, which leaves out walls too low to be met by any way over vertical mirrors alone.
  double combine_all_m = 30.0;
  double leaning_reach_m = 1000.0;  ///< facets that lean back (pitched roofs) are not searched farther away
  int launched_rays = 20000;        ///< launching: over the whole sphere
  /// The search as such, without any of its shortcuts: every facet of the scene, none taken to be hidden. Slow.
  bool exhaustive = false;
  std::uint64_t seed = 0;     ///< of the run: what moves beside the scene's moving things is drawn from it
  PathOmissions leave_out{};  ///< what cannot act where the antenna is
};

using MakePathModel =
    MakerAndNeed<std::unique_ptr<PathModel>(const ModelParameters& own, const PathParameters& p), StatePathNeeds>;
ModelTable<MakePathModel> path_models();

/// Direct ways only: is each blocked, how far does it pass through foliage. One occlusion ray per satellite, outward
/// from the antenna; tree crowns do not block.
std::unique_ptr<PathModel> make_visibility(const PathParameters& p);

/// Direct ways and specular reflections off the scene's planar facets, up to the given number of them. Exact (image
/// method, plane wave over the scene): antenna mirrored at facet after facet, every leg tested for obstacles. A wall at
/// perpendicular distance d adds 2 d cos(incidence), and the reflection point lies d / cos(incidence) away: a high
/// satellite, which meets walls at large incidence, sees them from much farther than half the excess. So the search
/// has no fixed radius: a wall is within reach if it stands out above the lowest satellite's elevation (facets that
/// lean: FacetIndex::mirrors). Terrain and trees do not reflect here.
std::unique_ptr<PathModel> make_specular1(const PathParameters& p);
std::unique_ptr<PathModel> make_specular2(const PathParameters& p);
std::unique_ptr<PathModel> make_specular3(const PathParameters& p);

/// The same up to two reflections, found as in the paper (section 2.1, bidirectional ray tracing): rays launched evenly
/// over the sphere from the antenna, reflected at what they meet, and at each reflection joined with those satellites
/// that stand in the reflected direction to within the rays' spacing (the capture sphere, seen from the scene as a
/// cone; half-angle 3 / sqrt(rays)) by a ray back from the satellite. Of several rays over the same mirrors the one
/// nearest to the satellite counts. Approximate: the excess is off by up to the way's length times the angle missed
/// times the tilt of the mirrors; facets narrower than the rays' spacing are missed; cost grows with the rays, whatever
/// they find.
std::unique_ptr<PathModel> make_launching(const PathParameters& p);
/// The same with as many rays as its own key says (launched_rays, 1 to 1e8).
std::unique_ptr<PathModel> make_configured_launching(const ModelParameters& own, const PathParameters& p);
void launching_parameters(ModelParameters& section);

}  // namespace canyon::gnss
