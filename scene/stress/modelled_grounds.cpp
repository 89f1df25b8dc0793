// Ground of an elevation model under a scene from files: its heights in W, its cells, and the most triangles it may
// have.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/scene/file_frame.h"
#include "canyon/scene/ground/ground_plan.h"
#include "canyon/scene/ground/ground_surface.h"
#include "canyon/scene/ground/imported_ground.h"
#include "canyon/scene/importers/assemble.h"
#include "canyon/scene/stress/made_scenes.h"
#include "canyon/scene/stress/subjects.h"

namespace canyon::scene {
namespace {

using Eigen::Vector2d;
using stress::kHalfUlp;
using stress::kInfinity;
using stress::Looks;

/// An elevation model of one height, 83 m, from 10 E to 10.03 E and 47 N to 47.03 N, at a path of its own.
class OneHeight {
 public:
  OneHeight()
      : path((std::filesystem::temp_directory_path() / ("canyon-one-height-" + std::to_string(::getpid()) + ".asc"))
                 .string()) {
    std::ofstream file(path);
    file << "ncols 4\nnrows 4\nxllcorner 10\nyllcorner 47\ncellsize 0.01\n";
    for (int k = 0; k < 16; ++k) file << "83 ";
  }
  ~OneHeight() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  OneHeight(const OneHeight&) = delete;
  OneHeight& operator=(const OneHeight&) = delete;

  const std::string path;
};

/// About W's origin at 60 m, 5 m of undulation: the model's ground lies 28 m higher, less what the Earth curves away,
/// d^2 / 2 R; R of any direction within 0.7 % of 6371 km, which is 3e-4 m at 700 m. Cells as of a plan of such heights,
/// as many triangles as were foretold. There may be that many and no fewer: less is refused in words that say how many
/// there would be and what makes them fewer.
StressFigure ground_of_a_model() {
  Looks looks;
  const OneHeight model;
  ImportConfig config;
  config.terrain = model.path, config.crs = "EPSG:4326", config.file = "houses.obj";
  config.margin_m = 45.0;
  FileFrame at;
  at.frame = LocalFrame({47.015 * kDegree, 10.015 * kDegree, 60.0});
  at.undulation_m = 5.0;
  std::vector<RawScene> scenes(1);
  GroundDetail detail;
  for (const Vector2d& corner : {Vector2d(-310.0, -200.0), Vector2d(300.0, 170.0)}) {
    RawFootprint f;
    f.object = scenes[0].add_object("house", ObjectKind::kBuilding), f.height_m = 9.0;
    f.rings = {{corner, corner + Vector2d(12, 0), corner + Vector2d(12, 8), corner + Vector2d(0, 8)}};
    for (std::size_t k = 0; k < 4; ++k) detail.add(f.rings[0][k], f.rings[0][(k + 1) % 4]);
    scenes[0].footprints.push_back(f);
  }
  ImportedScene out;
  out.parts = made::nothing();
  const auto made = ImportedGround(config, at, kMaxTriangles).make(scenes, out);
  // Without PROJ no model can be placed.
  if (!made.ok() && made.error().str().find("CANYON_WITH_PROJ") != std::string::npos) return {0.0, 1.0};
  looks.right(made.ok());
  if (!made.ok()) return looks.figure();
  const auto curved = [](const Vector2d& p) { return std::optional<double>(28.0 - p.squaredNorm() / (2.0 * 6371e3)); };
  const GroundWish wish{{-310.0 - 45.0, -200.0 - 45.0}, {312.0 + 45.0, 178.0 + 45.0}, 5.0, 45.0};
  const GroundPlan plan(wish, detail, curved, 1e6);
  const GroundMesh expected(plan);
  const double triangles = 2.0 * plan.cells() + triangles_of(scenes[0]);
  looks.near(out.report.predicted.triangles, triangles, 1e-6);
  looks.right(out.parts.mesh.vertices.size() == expected.places.size() &&
              out.parts.mesh.triangles.size() == expected.triangles.size());
  if (out.parts.mesh.vertices.size() != expected.places.size()) return looks.figure();
  for (std::size_t i = 0; i < expected.places.size(); ++i) {
    const auto v = out.parts.mesh.vertices[i].cast<double>();
    looks.near((v.head<2>() - expected.places[i]).norm(), 0.0, 2.0 * kHalfUlp * 512.0);
    looks.near(v.z(), *curved(expected.places[i]), 3e-4);
  }
  looks.right(out.report.ground == std::filesystem::path(model.path).filename().string());
  looks.right(out.parts.objects.size() == 1 && out.parts.objects[0].kind == ObjectKind::kTerrain);
  for (const auto& m : out.parts.mesh.material) looks.right(out.parts.materials[m].name == "asphalt");
  // Just as many, and one fewer.
  ImportedScene again{made::nothing(), {}}, fewer = again, far_fewer = again;
  const auto limit = static_cast<std::int64_t>(triangles);
  looks.right(ImportedGround(config, at, limit).make(scenes, again).ok());
  looks.right(again.parts.mesh.vertices == out.parts.mesh.vertices);
  const auto refused = ImportedGround(config, at, limit - 1).make(scenes, fewer);
  looks.right(!refused.ok() &&
              refused.error().str() == "houses.obj: a scene of about " + cost_text({triangles}) +
                                           ", expected larger cells (scene.ground_cell_m), less around "
                                           "it (scene.margin_m), a part of it (scene.radius_m), or "
                                           "scene.max_triangles above " +
                                           std::to_string(limit - 1));
  // Of far fewer the plan need not be made to its end: more than that, and refused.
  const auto cut = ImportedGround(config, at, limit / 20).make(scenes, far_fewer);
  looks.right(!cut.ok() && far_fewer.report.predicted.triangles > static_cast<double>(limit) / 20.0);
  looks.right(far_fewer.report.predicted.triangles < triangles && far_fewer.parts.mesh.triangles.empty());
  // A model of elsewhere covers nothing.
  at.frame = LocalFrame({47.015 * kDegree, 12.0 * kDegree, 60.0});
  ImportedScene elsewhere{made::nothing(), {}};
  const auto bare = ImportedGround(config, at, kMaxTriangles).make(scenes, elsewhere);
  looks.right(!bare.ok() && bare.error().str().find("does not cover the scene, expected an elevation model of the same "
                                                    "place") != std::string::npos);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> modelled_ground_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "ground of an elevation model, and how much of it there may be",
           .why = "an undulation with the other sign, a limit of triangles for one of cells, a plan that is cut short",
           .expected = "one height less what the Earth curves away; a plan of such heights; limits just so",
           .unit = "of the bound"});
  rows.add("modelled_grounds/of_one_height", ground_of_a_model);
  return rows.take();
}

}  // namespace canyon::scene
