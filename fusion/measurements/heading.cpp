#include <cmath>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/units.h"
#include "canyon/fusion/measurements/body_motion.h"

namespace canyon::fusion {
namespace {

struct HeadingParameters {
  double heading_sigma_floor_deg = 0.05;
};
void visit(FieldVisitor& f, HeadingParameters& p) {
  f.number("heading_sigma_floor_deg", p.heading_sigma_floor_deg, {1e-6, 90}, "lower bound on a heading's 1-sigma");
}

/// Direction of B's x axis over ground from true north, of two antennas in a row along it. Nothing where B points
/// straight up or down, or the message is not finite.
class Heading final : public Copied<MeasurementModel, Heading> {
 public:
  explicit Heading(const HeadingParameters& p) : floor_rad_(p.heading_sigma_floor_deg * kDegree) {}

  std::optional<Measurement> received(const FilterView& filter, const AidingMessage& message, int) override {
    const auto* heading = std::get_if<HeadingSample>(&message);
    if (heading == nullptr || !std::isfinite(heading->heading_rad) || !std::isfinite(heading->sigma_rad)) return {};
    const BodyAttitude body = body_attitude(filter);
    const Eigen::Matrix3d R_NB = filter.frame.R_EW().transpose() * body.R_EB;  // W's axes: north of the frame's origin
    const double east = R_NB(0, 0), north = R_NB(1, 0), level = east * east + north * north;
    if (level < kLeast * kLeast) return {};
    Measurement m(1, filter.state, ErrorIndex::kTheta);
    m.residual[0] = wrap_pi(heading->heading_rad - std::atan2(east, north));
    // d x_W = R [e_x]' theta = R (theta_z e_y - theta_y e_z).
    const Eigen::RowVector3d by_x = Eigen::RowVector3d(north, -east, 0.0) / level;
    Eigen::RowVector3d by_theta = Eigen::RowVector3d::Zero();
    by_theta[1] = -by_x.dot(R_NB.col(2));
    by_theta[2] = by_x.dot(R_NB.col(1));
    m.H = by_theta * body.H;
    m.R(0, 0) = std::pow(std::max(heading->sigma_rad, floor_rad_), 2);
    return m;
  }

 private:
  static constexpr double kLeast = 0.1;  // of the x axis lies in the horizon

  double floor_rad_;
};

}  // namespace

std::unique_ptr<MeasurementModel> make_heading(const ModelParameters& own, const MeasurementSetup&) {
  return std::make_unique<Heading>(own.get<HeadingParameters>());
}

void heading_parameters(ModelParameters& section) {
  section.add<HeadingParameters>();
}

}  // namespace canyon::fusion
