#include "canyon/gnss/paths/diffraction/diffraction.h"

namespace canyon::gnss {
namespace {

class Shadows final : public DiffractionModel {
 public:
  void trace(const Eigen::Vector3d&, const PlaneWaves&, const scene::SceneAt&, std::span<SignalPaths>,
             GnssCounters&) const override {}
  bool bends() const override { return false; }
};

std::unique_ptr<DiffractionModel> make_none(const PathParameters&) {
  return std::make_unique<Shadows>();
}

constexpr ModelRow<MakeDiffractionModel> kModels[] = {
    {"none", without_keys<make_none>, "shadows are sharp"},
    {"knife_edge", without_keys<make_knife_edge>, "ITU-R P.526 knife edges at roofs and corners"},
    {"double_knife_edge", without_keys<make_double_knife_edge>, "also over two edges after each other"},
};

}  // namespace

ModelTable<MakeDiffractionModel> diffraction_models() {
  return kModels;
}

}  // namespace canyon::gnss
