#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/model_table.h"
#include "canyon/core/result.h"
#include "canyon/scene/importers/raw_scene.h"

namespace canyon::scene {

/// Of mesh files; kAuto: y of glTF, z of all else.
enum class UpAxis { kAuto, kY, kZ };

/// What a reader is told beside the file.
struct ReadOptions {
  /// Properties of a footprint or building that hold its height above ground, the height of the ground, and its number
  /// of storeys; empty: those of the known layouts.
  std::string height_property, ground_property, storeys_property;
  UpAxis up_axis = UpAxis::kAuto;
  double storey_m = 3.0;          ///< height of one storey, where only storeys are known
  double default_height_m = 9.0;  ///< of buildings that say nothing, which are counted; 0 leaves them out
};

/// One file format. Adding one = one file and one row in importer.cpp.
struct SceneReader {
  std::vector<const char*> endings;  ///< of file names, lower case; a trailing .gz is looked through
  Result<RawScene> (*read)(const std::string& path, const ReadOptions& options);
  /// For endings that several formats share: does this text look like a file of this one?
  bool (*looks_like)(std::string_view text) = nullptr;
};

/// In the order in which they are tried.
using SceneFormat = ModelRow<SceneReader>;
ModelTable<SceneReader> scene_formats();

/// Reads a file of any known format, chosen by its ending and, where formats share one, by what is in it.
Result<RawScene> read_scene_file(const std::string& path, const ReadOptions& options);

// The formats, each in its own .cpp.
Result<RawScene> read_obj(const std::string& path, const ReadOptions& options);
Result<RawScene> read_ply(const std::string& path, const ReadOptions& options);
Result<RawScene> read_cityjson(const std::string& path, const ReadOptions& options);
Result<RawScene> read_citygml(const std::string& path, const ReadOptions& options);
Result<RawScene> read_geojson(const std::string& path, const ReadOptions& options);
Result<RawScene> read_osm(const std::string& path, const ReadOptions& options);
Result<RawScene> read_mitsuba(const std::string& path, const ReadOptions& options);

/// What PROJ understands of the names that files give their coordinate system: "urn:ogc:def:crs:EPSG::6668",
/// "http://www.opengis.net/def/crs/EPSG/0/7415", "urn:ogc:def:crs:OGC:1.3:CRS84", two EPSG codes of a compound.
SourceFrame frame_by_name(const std::string& name);

/// Buildings that were found without a height, for one warning at the end.
struct MissingHeights {
  int from_storeys = 0, by_default = 0, left_out = 0;
  /// The height, or NaN if the building is to be left out; `height_m` and `storeys` may be NaN.
  double resolve(double height_m, double storeys, const ReadOptions& options);
  void tell(RawScene& scene, const ReadOptions& options) const;
};

/// The kind of an object that only has a name: "Ground", "terrain_3" and "Plane" are terrain, "building 7" is a
/// building, "car_2" a vehicle; `otherwise` where nothing fits.
ObjectKind kind_by_name(std::string_view name, ObjectKind otherwise);

}  // namespace canyon::scene
