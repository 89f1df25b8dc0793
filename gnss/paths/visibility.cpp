#include "canyon/gnss/paths/path_model.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

class Visibility final : public PathModel {
 public:
  explicit Visibility(const PathOmissions& leave_out) : leave_out_(leave_out) {}

  void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    for (std::size_t i = 0; i < out.size(); ++i) {
      SignalPaths& paths = out[i];
      paths.echoes.clear();
      paths.line_of_sight = leave_out_.occlusion || !scene.blocked_towards(p_A_W, waves.direction_W(i));
      paths.direct = paths.line_of_sight ? 1.0 : 0.0;
      const bool shaded = paths.line_of_sight && !leave_out_.foliage;
      paths.foliage_m = shaded ? scene.foliage_m(p_A_W, waves.direction_W(i)) : 0.0;
    }
    if (leave_out_.occlusion) return;
    counters.occlusion_rays += static_cast<std::int64_t>(out.size());
    counters.path_searches += static_cast<std::int64_t>(out.size());
  }

 private:
  PathOmissions leave_out_;
};

}  // namespace

std::unique_ptr<PathModel> make_visibility(const PathParameters& p) {
  return std::make_unique<Visibility>(p.leave_out);
}

}  // namespace canyon::gnss
