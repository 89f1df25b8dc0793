#include "canyon/gnss/paths/diffraction/diffraction.h"

#include "canyon/gnss/paths/need/path_question.h"

namespace canyon::gnss {
namespace {

class Shadows final : public DiffractionModel {
 public:
  void trace(const Eigen::Vector3d&, const PlaneWaves&, const scene::SceneAt&, std::span<SignalPaths>,
             GnssCounters&) const override {}
  bool bends() const override { return false; }
};

std::unique_ptr<DiffractionModel> make_sharp_shadows(const PathParameters&) {
  return std::make_unique<Shadows>();
}

std::vector<Need> no_needs(const PathQuestion&) {
  return {};
}

constexpr ModelRow<MakeDiffractionModel> kModels[] = {
    {"none", {without_keys<make_sharp_shadows>, no_needs}, "shadows are sharp"},
    {"knife_edge", {without_keys<make_knife_edge>, diffraction_needs}, "ITU-R P.526 knife edges at roofs and corners"},
    {"double_knife_edge",
     {without_keys<make_double_knife_edge>, diffraction_needs},
     "also over two edges after each other"},
    {"wedge",
     {without_keys<make_wedge>, wedge_needs},
     "uniform theory of diffraction: wedges of their material, finite edges"},
};

}  // namespace

ModelTable<MakeDiffractionModel> diffraction_models() {
  return kModels;
}

}  // namespace canyon::gnss
