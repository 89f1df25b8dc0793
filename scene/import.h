#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/result.h"
#include "canyon/scene/importers/importer.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_cost.h"

namespace canyon::scene {

/// What heights in files are above; kAuto: as the coordinate system says, else the geoid.
enum class HeightDatum { kAuto, kOrthometric, kEllipsoidal };
/// Streets for the route; kAuto: of the file if it has any, else the middle lines of the free space.
enum class StreetSource { kAuto, kFile, kFreeSpace };

/// The part of [scene] that says how a scene is read from files.
struct ImportConfig {
  std::string file;                     ///< empty: the built-in city
  std::vector<std::string> more_files;  ///< bridges, streets, ... of the same place
  std::string terrain;                  ///< elevation model; empty: what the files say of the ground
  std::string crs;                      ///< over what the file says
  HeightDatum heights = HeightDatum::kAuto;
  std::optional<double> undulation_m;  ///< none: of a geoid
  std::vector<double> center_deg;      ///< latitude, longitude of W's origin; empty: the middle of the scene
  double radius_m = 0.0;               ///< > 0: only what is that near to W's origin
  double ground_cell_m = 5.0;
  double margin_m = 60.0;  ///< of terrain in full detail around the buildings
  std::string height_property, ground_property, storeys_property;
  double storey_m = 3.0;
  double default_height_m = 9.0;
  UpAxis up_axis = UpAxis::kAuto;
  std::string wall_material = "concrete", roof_material = "roofing", ground_material = "asphalt";
  std::vector<std::string> materials;  ///< the user's own tables
  StreetSource streets = StreetSource::kAuto;
};
void visit(FieldVisitor& f, ImportConfig& c);

/// What was read, and what a user should know of it.
struct ImportReport {
  std::string crs, vertical;  ///< names; empty: local metres
  /// Of files in local metres: what lies at W's origin. Not 0 where the file's own origin lies far outside of it.
  Eigen::Vector3d file_origin_m = Eigen::Vector3d::Zero();
  SceneCost predicted{};              ///< before anything was made
  std::string undulation_source;      ///< "egm96-5", "stated", "none"
  std::string ground;                 ///< where the terrain is from
  std::string streets;                ///< where the streets are from
  std::vector<std::string> warnings;  ///< counted
};

struct ImportedScene {
  SceneParts parts;
  ImportReport report;
};

/// Reads the files of a scene and sets them into W: local east-north-up around the middle of the scene (or center_deg),
/// at the height of the ground there. Buildings stand on the terrain without gaps: their walls reach half a metre below
/// the lowest ground around them.
///
/// `origin` is where a scene in local metres lies: its own origin, or, where that is farther than 2 km from its middle
/// and outside of it (coordinates of a map whose system is not said), its middle in whole metres.
///
/// Refused, by file and line: corners more than 100 km from the scene's middle. Refused before it is made: a scene that
/// is going to have more than max_triangles.
Result<ImportedScene> import_scene(const ImportConfig& config, const Geodetic& origin,
                                   std::int64_t max_triangles = kMaxTriangles);

}  // namespace canyon::scene
