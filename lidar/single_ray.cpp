#include "lidar/echo_model.h"

namespace canyon::lidar {
namespace {

class SingleRay final : public EchoModel {
 public:
  void trace(const Volley& volley, const scene::SceneAt& scene, const Surfaces& surfaces,
             EchoList& out) const override {
    thread_local std::vector<scene::HitPacket> hits;
    hits.resize(volley.packets());
    scene.trace(volley.rays, hits);
    out.echoes.resize(volley.shots());
    out.first.resize(volley.shots() + 1);
    std::uint32_t count = 0;
    std::size_t shot = 0;
    for (const scene::HitPacket& hit : hits) {
      for (std::size_t lane = 0; lane < Volley::kLanes; ++lane) {
        out.first[shot++] = count;
        if (hit.triangle[lane] == scene::Hit::kMiss) continue;
        out.echoes[count++] = {.range_m = hit.range_m[lane],
                               .reflectivity = surfaces.reflectivity(hit.triangle[lane], hit.cos_incidence[lane]),
                               .cos_incidence = hit.cos_incidence[lane],
                               .triangle = hit.triangle[lane]};
      }
    }
    out.first[shot] = count;
    out.echoes.resize(count);
  }
  std::size_t rays_per_shot() const override { return 1; }
};

}  // namespace

std::unique_ptr<EchoModel> make_single_ray(const LidarConfig&, std::uint64_t) {
  return std::make_unique<SingleRay>();
}

}  // namespace canyon::lidar
