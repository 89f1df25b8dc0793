#include "canyon/gnss/paths/path_model.h"

#include <algorithm>

#include "canyon/gnss/paths/need/path_question.h"

namespace canyon::gnss {
namespace {

class OpenSky final : public PathModel {
 public:
  void trace(const Eigen::Vector3d&, const PlaneWaves&, const scene::SceneAt&, std::span<SignalPaths> out,
             GnssCounters&) const override {
    std::fill(out.begin(), out.end(), SignalPaths{});
  }
};

std::unique_ptr<PathModel> make_none(const PathParameters&) {
  return std::make_unique<OpenSky>();
}

template <int Order>
std::vector<Need> needs_of_specular(const PathQuestion& question) {
  return specular_needs(Order, question);
}

std::vector<Need> no_needs(const PathQuestion&) {
  return {};
}

constexpr ModelRow<MakePathModel> kModels[] = {
    {"none", {without_keys<make_none>, no_needs}, "every satellite above the mask is clear, nothing reflects"},
    {"visibility",
     {without_keys<make_visibility>, needs_of_specular<0>},
     "occlusion rays against the scene, nothing reflects"},
    {"specular1",
     {without_keys<make_specular1>, needs_of_specular<1>},
     "occlusion and single specular reflections off the scene's facets"},
    {"specular2", {without_keys<make_specular2>, needs_of_specular<2>}, "occlusion and up to two specular reflections"},
    {"specular3",
     {without_keys<make_specular3>, needs_of_specular<3>},
     "occlusion and up to three specular reflections"},
    {"launching",
     {make_configured_launching},
     "rays launched from the antenna, up to two reflections; approximate",
     launching_parameters},
};

}  // namespace

ModelTable<MakePathModel> path_models() {
  return kModels;
}

}  // namespace canyon::gnss
