#include "canyon/lidar/lidar_config.h"

namespace canyon::lidar {
namespace {

class SingleRay final : public EchoModel {
 public:
  SingleRay(const LidarConfig& config, std::uint64_t seed) : see_through_(config.see_through, seed) {}

  void trace(const Volley& volley, const scene::SceneAt& scene, const Surfaces& surfaces, Echoes& out) const override {
    thread_local std::vector<scene::HitPacket> hits;
    hits.resize(volley.packets());
    scene.trace(volley.rays, hits, volley.origin_W);
    const std::span<EchoPacket> echoes = out.start(volley.packets());
    for (std::size_t p = 0; p < hits.size(); ++p) surfaces.echoes(volley.rays[p], hits[p], volley.origin_W, echoes[p]);
    if (see_through_.any()) follow_all(volley, hits, scene, surfaces, out);
  }
  std::size_t rays_per_shot() const override { return 1; }

 private:
  void follow_all(const Volley& volley, std::span<const scene::HitPacket> hits, const scene::SceneAt& scene,
                  const Surfaces& surfaces, Echoes& out) const {
    std::vector<Echo> met;
    for (std::size_t shot = 0; shot < volley.shots(); ++shot) {
      const std::size_t p = shot / Volley::kLanes, lane = shot % Volley::kLanes;
      if (!(volley.rays[p].max_m[lane] >= 0)) continue;
      if (!see_through_.leaves() && !surfaces.transparent(out.layer(0)[p].truth[lane].material)) continue;
      see_through_.follow({ray_of(volley.rays[p], lane, volley.origin_W),
                           static_cast<std::uint32_t>(Volley::laser_of(shot)), volley.draw_of(shot), 0},
                          hits[p], lane, scene, surfaces, met);
      out.layer(0)[p].set(lane, {});
      for (const Echo& echo : met) out.insert(shot, echo);
    }
  }

  SeeThrough see_through_;
};

}  // namespace

std::unique_ptr<EchoModel> make_single_ray(const ModelParameters&, const LidarConfig& config, std::uint64_t seed) {
  return std::make_unique<SingleRay>(config, seed);
}

}  // namespace canyon::lidar
