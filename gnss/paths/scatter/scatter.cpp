#include "canyon/gnss/paths/scatter/scatter.h"

#include "canyon/gnss/paths/need/path_question.h"

namespace canyon::gnss {
namespace {

class Mirrors final : public ScatterModel {
 public:
  void trace(const Eigen::Vector3d&, const PlaneWaves&, const scene::SceneAt&, std::span<SignalPaths>,
             GnssCounters&) const override {}
  ScatteredShare scattered_share() const override { return {}; }
};

std::unique_ptr<ScatterModel> make_no_scatter(const PathParameters&) {
  return std::make_unique<Mirrors>();
}

std::vector<Need> no_scatter_needs(const PathQuestion&) {
  return {};
}

constexpr ModelRow<MakeScatterModel> kScatterRows[] = {
    {"none", {without_keys<make_no_scatter>, no_scatter_needs}, "walls are mirrors"},
    {"directive",
     {make_directive_scatter, scatter_needs},
     "effective roughness with a lobe about the mirror's direction, in tiles",
     directive_scatter_parameters},
};

}  // namespace

ModelTable<MakeScatterModel> scatter_models() {
  return kScatterRows;
}

}  // namespace canyon::gnss
