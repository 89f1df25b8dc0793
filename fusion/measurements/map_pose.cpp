#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/measurements/pose_residual.h"

namespace canyon::fusion {
namespace {

struct MapPoseParameters {
  double map_pose_scale = 1.0;
};
void visit(FieldVisitor& f, MapPoseParameters& p) {
  f.number("map_pose_scale", p.map_pose_scale, {0.01, 1000}, "factor on the 1-sigma of a pose in the map");
}

/// The pose of a scan registered to a map that was there before. A map made on the run itself holds this filter's own
/// errors, and would count its information twice: relative_pose is for that.
class PoseInMapMeasurement final : public Copied<MeasurementModel, PoseInMapMeasurement> {
 public:
  explicit PoseInMapMeasurement(const MapPoseParameters& p) : scale_(p.map_pose_scale * p.map_pose_scale) {}

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int) override {
    const auto* pose = std::get_if<PoseInMap>(&message);
    if (pose == nullptr || !pose->covariance.allFinite()) return {};
    const BodyPose body = body_pose(filter);
    const Pose measured_E = filter.frame.X_EW() * pose->X_WB;
    return pose_residual(filter.state, body.X_EB, body.H, measured_E, scale_ * pose->covariance);
  }

 private:
  double scale_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_map_pose(const ModelParameters& own, const MeasurementSetup&) {
  return std::make_unique<PoseInMapMeasurement>(own.get<MapPoseParameters>());
}

void map_pose_parameters(ModelParameters& section) {
  section.add<MapPoseParameters>();
}

}  // namespace canyon::fusion
