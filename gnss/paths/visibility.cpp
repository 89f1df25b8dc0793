#include "gnss/paths/path_model.h"

namespace canyon::gnss {
namespace {

class Visibility final : public PathModel {
 public:
  void trace(const Eigen::Vector3d& p_A_W, std::span<const Eigen::Vector3d> directions_W, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = SignalPaths{};
      out[i].line_of_sight = !scene.blocked_towards(p_A_W, directions_W[i]);
      if (out[i].line_of_sight)
        out[i].foliage_m = scene.foliage_m(p_A_W, directions_W[i]);
      else
        out[i].direct = 0.0;
    }
    counters.occlusion_rays += static_cast<std::int64_t>(out.size());
  }
};

}  // namespace

std::unique_ptr<PathModel> make_visibility(const PathParameters&) {
  return std::make_unique<Visibility>();
}

}  // namespace canyon::gnss
