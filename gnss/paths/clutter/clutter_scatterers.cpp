#include "canyon/gnss/paths/clutter/clutter_scatterers.h"

#include <cmath>

namespace canyon::gnss {
namespace {

constexpr double kHighest_m = 5.0;

}  // namespace

ClutterScatterer ClutterScatterers::make(const scene::Scene& scene, int x, int y) const {
  ClutterScatterer out;
  out.id = static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 | static_cast<std::uint32_t>(y);
  out.p_W.x() = (x + draws_.uniform(0, out.id)) * cell_m_;
  out.p_W.y() = (y + draws_.uniform(1, out.id)) * cell_m_;
  const auto ground = scene.ground(out.p_W.x(), out.p_W.y());
  out.p_W.z() = (ground ? ground->height_m : 0.0) + kHighest_m * draws_.uniform(2, out.id);
  const double half = std::sqrt(0.5);
  out.co = {half * draws_.normal(3, out.id), half * draws_.normal(4, out.id)};
  out.cross = {half * draws_.normal(5, out.id), half * draws_.normal(6, out.id)};
  return out;
}

void ClutterScatterers::near(const scene::Scene& scene, const Eigen::Vector3d& p_W, double radius_m,
                             std::vector<ClutterScatterer>& out) const {
  const std::scoped_lock lock(mutex_);
  if (scene_ != &scene) {
    made_.clear();
    scene_ = &scene;
  }
  const auto cell = [&](double v_m) { return static_cast<int>(std::floor(v_m / cell_m_)); };
  out.clear();
  for (int x = cell(p_W.x() - radius_m); x <= cell(p_W.x() + radius_m); ++x) {
    for (int y = cell(p_W.y() - radius_m); y <= cell(p_W.y() + radius_m); ++y) {
      auto at = made_.find({x, y});
      if (at == made_.end()) {
        at = made_.emplace(std::pair(x, y), make(scene, x, y)).first;
        at->second.number = static_cast<std::uint32_t>(made_.size() - 1);
      }
      if ((at->second.p_W - p_W).head<2>().squaredNorm() < radius_m * radius_m) out.push_back(at->second);
    }
  }
}

}  // namespace canyon::gnss
