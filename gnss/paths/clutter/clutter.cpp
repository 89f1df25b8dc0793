#include "canyon/gnss/paths/clutter/clutter.h"

#include "canyon/gnss/paths/need/path_question.h"

namespace canyon::gnss {
namespace {

class AsTheSceneSays final : public ClutterModel {
 public:
  void trace(const Eigen::Vector3d&, const PlaneWaves&, const scene::SceneAt&, std::span<SignalPaths>,
             GnssCounters&) const override {}
  bool acts() const override { return false; }
};

std::unique_ptr<ClutterModel> make_no_clutter(const PathParameters&) {
  return std::make_unique<AsTheSceneSays>();
}

std::vector<Need> no_clutter_needs(const PathQuestion&) {
  return {};
}

constexpr ModelRow<MakeClutterModel> kClutterRows[] = {
    {"none", {without_keys<make_no_clutter>, no_clutter_needs}, "nothing stands in the street but what the scene has"},
    {"street",
     {make_street_clutter, clutter_needs},
     "what the scene lacks: shading in two states (ITU-R P.681), scatterers fixed to the ground, traffic",
     street_clutter_parameters},
};

}  // namespace

ModelTable<MakeClutterModel> clutter_models() {
  return kClutterRows;
}

}  // namespace canyon::gnss
