#include "canyon/gnss/paths/propagation.h"

#include <algorithm>

#include "canyon/gnss/paths/ground_reflection.h"

namespace canyon::gnss {
namespace {

class Propagation final : public PathModel {
 public:
  Propagation(std::unique_ptr<PathModel> paths, std::unique_ptr<DiffractionModel> diffraction, bool ground_reflection,
              const PathParameters& p, std::unique_ptr<ScatterModel> scatter, std::unique_ptr<ClutterModel> clutter)
      : paths_(std::move(paths)),
        diffraction_(std::move(diffraction)),
        scatter_(std::move(scatter)),
        clutter_(std::move(clutter)),
        ground_reflection_(ground_reflection),
        p_(p) {}

  void trace(const Eigen::Vector3d& p_A_W, const PlaneWaves& waves, const scene::SceneAt& scene,
             std::span<SignalPaths> out, GnssCounters& counters) const override {
    paths_->trace(p_A_W, waves, scene, out, counters);
    if (waves.empty()) return;
    if (ground_reflection_) add_ground_reflections(p_, p_A_W, waves, scene, out, counters);
    diffraction_->trace(p_A_W, waves, scene, out, counters);
    if (scatter_ != nullptr) scatter_->trace(p_A_W, waves, scene, out, counters);
    if (clutter_ != nullptr) clutter_->trace(p_A_W, waves, scene, out, counters);
    for (auto& paths : out)
      std::stable_sort(paths.echoes.begin(), paths.echoes.end(),
                       [](const SignalPath& a, const SignalPath& b) { return a.excess_m < b.excess_m; });
  }

 private:
  std::unique_ptr<PathModel> paths_;
  std::unique_ptr<DiffractionModel> diffraction_;
  std::unique_ptr<ScatterModel> scatter_;
  std::unique_ptr<ClutterModel> clutter_;
  bool ground_reflection_;
  PathParameters p_;
};

}  // namespace

void visit(FieldVisitor& f, PropagationConfig& c) {
  visit_choice(f, "paths", c.paths, "propagation in the scene");
  visit_choice(f, "diffraction", c.diffraction, "what roofs and corners bend");
  visit_choice(f, "scatter", c.scatter, "what walls send elsewhere than a mirror");
  visit_choice(f, "clutter", c.clutter, "what the street has and the scene lacks: poles, trees, vehicles, crowds");
  f.flag("ground_reflection", c.ground_reflection, "the terrain around the antenna reflects");
  f.flag("reflection_borders", c.reflection_borders,
         "specular1 to specular3: a mirror fades out beside its borders, as Kirchhoff's integral over it, and its ways "
         "beside what stands in them; else both end sharply");
  f.number("surface_roughness_m", c.surface_roughness_m, {0.0, 1.0},
           "standard deviation of the reflecting surfaces' height");
}

PathParameters with_borders(const PropagationConfig& c, PathParameters limits) {
  limits.reflection_borders = c.reflection_borders && c.paths.name.starts_with("specular");
  if (limits.reflection_borders)
    limits.weakest_db = limits.weakest_nlos_db = std::min(limits.weakest_db, limits.weakest_nlos_db);
  return limits;
}

Result<std::unique_ptr<PathModel>> make_propagation(const PropagationConfig& config, PathParameters limits) {
  limits.roughness_m = config.surface_roughness_m;
  limits = with_borders(config, std::move(limits));
  CANYON_TRY(auto scatter, config.scatter.make("gnss.scatter", limits));
  limits.scattered_share = scatter->scattered_share();
  if (!limits.scattered_share.scatters) scatter = nullptr;
  CANYON_TRY(auto clutter, config.clutter.make("gnss.clutter", limits));
  if (!clutter->acts()) clutter = nullptr;
  CANYON_TRY(auto paths, config.paths.make("gnss.paths", limits));
  CANYON_TRY(auto diffraction, config.diffraction.make("gnss.diffraction", limits));
  const bool bends = diffraction->bends() && !limits.leave_out.diffraction;
  if (!bends && !config.ground_reflection && scatter == nullptr && clutter == nullptr) return paths;
  if (!bends) {
    CANYON_TRY(diffraction, ModelChoice<diffraction_models>("none").make("gnss.diffraction", limits));
  }
  return make_propagation(std::move(paths), std::move(diffraction), config.ground_reflection, limits,
                          std::move(scatter), std::move(clutter));
}

std::unique_ptr<PathModel> make_propagation(std::unique_ptr<PathModel> paths,
                                            std::unique_ptr<DiffractionModel> diffraction, bool ground_reflection,
                                            const PathParameters& p, std::unique_ptr<ScatterModel> scatter,
                                            std::unique_ptr<ClutterModel> clutter) {
  return std::make_unique<Propagation>(std::move(paths), std::move(diffraction), ground_reflection, p,
                                       std::move(scatter), std::move(clutter));
}

}  // namespace canyon::gnss
