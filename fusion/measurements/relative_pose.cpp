#include <cmath>

#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/measurements/pose_residual.h"

namespace canyon::fusion {
namespace {

struct RelativePoseParameters {
  double relative_pose_scale = 1.0;
};
void visit(FieldVisitor& f, RelativePoseParameters& p) {
  f.number("relative_pose_scale", p.relative_pose_scale, {0.01, 1000},
           "factor on the 1-sigma of motion between two scans");
}

/// The vehicle now (source) in the vehicle as it was when the clone was taken (target). Nothing of other instants.
class RelativePoseMeasurement final : public Copied<MeasurementModel, RelativePoseMeasurement> {
 public:
  explicit RelativePoseMeasurement(const RelativePoseParameters& p)
      : scale_(p.relative_pose_scale * p.relative_pose_scale) {}

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int) override {
    const auto* relative = std::get_if<RelativePose>(&message);
    const auto& clone = filter.state.clone();
    if (relative == nullptr || !relative->covariance.allFinite() || !clone ||
        std::abs(relative->target - clone->t) > kSame_s || std::abs(relative->source - filter.state.nav.t) > kSame_s)
      return {};
    const BodyPose now = body_pose(filter), then = cloned_body_pose(filter);
    const Pose X_TS = then.X_EB.inverse() * now.X_EB;
    const PoseRows H = now.H - adjoint(X_TS.inverse()) * then.H;
    return pose_residual(filter.state, X_TS, H, relative->X_TS, scale_ * relative->covariance);
  }

 private:
  static constexpr double kSame_s = 1e-3;

  double scale_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_relative_pose(const ModelParameters& own, const MeasurementSetup&) {
  return std::make_unique<RelativePoseMeasurement>(own.get<RelativePoseParameters>());
}

void relative_pose_parameters(ModelParameters& section) {
  section.add<RelativePoseParameters>();
}

}  // namespace canyon::fusion
