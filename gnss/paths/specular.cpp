#include <algorithm>

#include "canyon/gnss/paths/diffraction/mirror_borders.h"
#include "canyon/gnss/paths/image_search.h"
#include "canyon/gnss/paths/path_model.h"

namespace canyon::gnss {
namespace {

class Specular final : public PathModel {
 public:
  Specular(int order, const PathParameters& p)
      : order_(std::min(order, p.leave_out.most_reflections)), p_(p), visibility_(make_visibility(p)) {
    if (p.reflection_borders) largest_nu_ = largest_border_nu(std::min(p.weakest_db, p.weakest_nlos_db));
  }

  void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    visibility_->trace(p_A_W, waves, scene, out, counters);
    if (order_ == 0) return;
    find_images(order_, p_, largest_nu_, p_A_W, waves, scene, out, counters);
    for (auto& paths : out)
      std::stable_sort(paths.echoes.begin(), paths.echoes.end(),
                       [](const SignalPath& a, const SignalPath& b) { return a.excess_m < b.excess_m; });
  }

 private:
  int order_;
  PathParameters p_;
  double largest_nu_ = 0.0;
  std::unique_ptr<PathModel> visibility_;
};

}  // namespace

std::unique_ptr<PathModel> make_specular1(const PathParameters& p) {
  return std::make_unique<Specular>(1, p);
}

std::unique_ptr<PathModel> make_specular2(const PathParameters& p) {
  return std::make_unique<Specular>(2, p);
}

std::unique_ptr<PathModel> make_specular3(const PathParameters& p) {
  return std::make_unique<Specular>(3, p);
}

}  // namespace canyon::gnss
