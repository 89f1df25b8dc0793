#include "lidar/echo_model.h"

namespace canyon::lidar {
namespace {

class SingleRay final : public EchoModel {
 public:
  void trace(const Volley& volley, const scene::SceneAt& scene, const Surfaces& surfaces, Echoes& out) const override {
    thread_local std::vector<scene::HitPacket> hits;
    hits.resize(volley.packets());
    scene.trace(volley.rays, hits, volley.origin_W);
    const std::span<EchoPacket> echoes = out.start(volley.packets());
    constexpr std::size_t kAhead = 2;  // packets
    for (std::size_t p = 0; p < hits.size(); ++p) {
      if (p + kAhead < hits.size())
        for (const std::uint32_t triangle : hits[p + kAhead].triangle) scene.prefetch_surface(triangle);
      for (std::size_t lane = 0; lane < Volley::kLanes; ++lane) echoes[p].set(lane, surfaces.echo(hits[p], lane));
    }
  }
  std::size_t rays_per_shot() const override { return 1; }
};

}  // namespace

std::unique_ptr<EchoModel> make_single_ray(const LidarConfig&, std::uint64_t) {
  return std::make_unique<SingleRay>();
}

}  // namespace canyon::lidar
