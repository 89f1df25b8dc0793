#include "canyon/lidar/registration/engine/engine_registration.h"

#include "canyon/lidar/registration/engine/aligner.h"
#include "canyon/lidar/registration/engine/covariance_forms.h"
#include "canyon/lidar/registration/engine/surface_cloud.h"

namespace canyon::lidar {
namespace {

class EngineRegistration final : public Registration {
 public:
  EngineRegistration(const EngineKind& kind, const MatchingParameters& matching, const EngineParameters& engine)
      : kind_(kind), matching_(matching), engine_(engine) {}

  std::shared_ptr<const PreparedCloud> prepare(std::span<const Eigen::Vector3f> points) const override {
    return prepare_surfaces(points, matching_.leaf_m);
  }

  RegistrationResult align(const PreparedCloud& source, std::span<const Placed> targets,
                           const Pose& guess) const override {
    return align_with_prior(source, targets, {.X_TS = guess});
  }

  /// One cloud is the target as it is, in its own frame; several are united in the frame of the prior, so that single
  /// precision is spent on what is near and not on map coordinates.
  RegistrationResult align_with_prior(const PreparedCloud& source, std::span<const Placed> targets,
                                      const PosePrior& prior) const override {
    RegistrationResult result;
    result.X_TS = prior.X_TS;
    result.status = RegistrationStatus::kDiverged;
    if (!prior.X_TS.matrix().allFinite()) return result;
    result.status = RegistrationStatus::kTooFewPoints;
    for (const Placed& placed : targets) {
      if (!placed.X_TC.matrix().allFinite()) return result;
    }
    if (targets.empty()) return result;
    const bool single = targets.size() == 1 && targets[0].cloud->tree != nullptr;
    const Pose X_TF = single ? targets[0].X_TC : prior.X_TS;
    const Pose X_FS = X_TF.inverse() * prior.X_TS;
    if (!(X_FS.p.array().abs() < 1e7).all()) {  // nothing of a cloud is so far away
      result.status = RegistrationStatus::kTooLittleOverlap;
      return result;
    }
    const auto cloud = single ? targets[0].cloud : united(targets, X_TF);
    const auto target =
        kind_.voxel_leaves > 0 ? voxel_target(*cloud, kind_.voxel_leaves * matching_.leaf_m) : point_target(cloud);
    result = Aligner(source, *target, kind_.form, matching_, engine_, {X_FS, prior.covariance}).align();
    result.X_TS = result.covariance.allFinite() ? X_TF * result.X_TS : prior.X_TS;
    if (result.surfaces) result.surfaces->X_TS = X_TF * result.surfaces->X_TS;
    return result;
  }

 private:
  std::shared_ptr<const PreparedCloud> united(std::span<const Placed> targets, const Pose& X_TF) const {
    std::vector<PlacedCloud> placed;
    for (const Placed& t : targets) {
      const Pose X_FC = X_TF.inverse() * t.X_TC;
      placed.push_back({t.cloud.get(), X_FC.R.toRotationMatrix(), X_FC.p});
    }
    return unite_surfaces(placed, matching_.leaf_m);
  }

  EngineKind kind_;
  MatchingParameters matching_;
  EngineParameters engine_;
};

}  // namespace

void visit(FieldVisitor& f, EngineParameters& c) {
  f.choice("kernel", c.kernel, model_names(robust_kernels()), "weight of far residuals in the own methods");
  f.number("kernel_width_m", c.kernel_width_m, {1e-3, 100},
           "residual at which the kernel takes effect, at the last reach");
  f.number("start_correspondence_m", c.start_correspondence_m, {0.01, 100},
           "reach of the first rounds of the own methods, on a part of the points; it shrinks to max_correspondence_m");
  f.choice("covariance", c.covariance, model_names(covariance_forms()), "how sure the own methods say they are");
  f.number("point_sigma_m", c.point_sigma_m, {0, 10}, "1-sigma of a point, for the covariances that ask for it");
  f.number("range_bias_m", c.range_bias_m, {0, 10},
           "1-sigma of an error that all ranges of a cloud have in common, likewise");
  f.number("least_overlap", c.least_overlap, {0, 1}, "share of the points that must be matched, for the own methods");
}

void engine_parameters(ModelParameters& section) {
  section.add<MatchingParameters>();
  section.add<EngineParameters>();
}

std::unique_ptr<Registration> make_engine(const EngineKind& kind, const ModelParameters& own) {
  return std::make_unique<EngineRegistration>(kind, own.get<MatchingParameters>(), own.get<EngineParameters>());
}

}  // namespace canyon::lidar
