#include <algorithm>
#include <cmath>
#include <string>

#include "canyon/core/process/progress.h"
#include "canyon/scene/city/furniture.h"

namespace canyon::scene::city {
namespace {

constexpr double kPavementPiece_m = 3.0;
// Gives no radio back, as the ground gives none: the vehicle's roof stands in its way (missions/fidelities.toml). To
// light it is as bright as concrete.
constexpr char kPavement[] = "absorber";

int pieces_of(double length_m) {
  return std::max(1, static_cast<int>(std::ceil(length_m / kPavementPiece_m)));
}

/// One side of a block, from corner to corner of its outline and of what lies kSidewalk_m within it, in short pieces
/// that follow the ground: the kerb's face, the top, and the face towards the block.
void add_side(const Eigen::Vector2d outer[2], const Eigen::Vector2d inner[2], double height_m, const Terrain& terrain,
              MeshBuilder& mesh) {
  const std::uint16_t pavement = mesh.material(kPavement);
  const int pieces = pieces_of((outer[1] - outer[0]).norm());
  const auto place = [&](const Eigen::Vector2d line[2], int i, double above_m) {
    const Eigen::Vector2d p = line[0] + (line[1] - line[0]) * i / pieces;
    return Eigen::Vector3d(p.x(), p.y(), terrain.height(p.x(), p.y()) + above_m);
  };
  constexpr double kBelow_m = 0.2;  // as the ground between two places may be lower than the line that joins them
  for (int i = 0; i < pieces; ++i) {
    const Eigen::Vector3d a = place(outer, i, height_m), b = place(outer, i + 1, height_m);
    const Eigen::Vector3d c = place(inner, i + 1, height_m), d = place(inner, i, height_m);
    mesh.quad(place(outer, i, -kBelow_m), place(outer, i + 1, -kBelow_m), b, a, pavement);
    mesh.quad(a, b, c, d, pavement);
    mesh.quad(place(inner, i + 1, -kBelow_m), place(inner, i, -kBelow_m), d, c, pavement);
  }
}

}  // namespace

double pavement_triangles(const Plan& plan) {
  double triangles = 0.0;
  for (const Block& block : plan.blocks)
    triangles += 6.0 * 2.0 * (pieces_of(block.kerb.width()) + pieces_of(block.kerb.depth()));
  return triangles;
}

void add_pavements(const CityConfig& config, const Plan& plan, const Terrain& terrain, SceneParts& parts) {
  MeshBuilder mesh(parts);
  for (std::size_t b = 0; b < plan.blocks.size(); ++b) {
    throw_if_cancelled();
    mesh.begin_object("pavement " + std::to_string(b + 1), ObjectKind::kOther);
    const Rectangle kerb = plan.blocks[b].kerb, land = kerb.inset(kSidewalk_m);
    const auto outer = rectangle(kerb.x0, kerb.y0, kerb.x1, kerb.y1);
    const auto inner = rectangle(land.x0, land.y0, land.x1, land.y1);
    for (std::size_t side = 0; side < 4; ++side) {
      const std::size_t next = (side + 1) % 4;
      const Eigen::Vector2d from_to[2] = {outer[side], outer[next]}, within[2] = {inner[side], inner[next]};
      add_side(from_to, within, config.kerb_height_m, terrain, mesh);
    }
  }
}

}  // namespace canyon::scene::city
