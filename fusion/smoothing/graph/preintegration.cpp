#include "canyon/fusion/smoothing/graph/preintegration.h"

#include "canyon/core/check.h"
#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;
using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Rotation and force of one interval in U's axes at its start, as the strapdown row `two_sample` has them, and their
/// derivatives.
struct Step {
  Eigen::Vector3d rotation, dv;
  Columns rotation_by, dv_by;
};

template <class Sample>
Step two_sample_step(const Sample& now, const Sample* before) {
  const Eigen::Vector3d &a = now.in.dtheta_U, &f = now.in.dv_U;
  const Eigen::Matrix3d A = skew(a), F = skew(f);
  const Eigen::Vector3d turned = a.cross(f);
  Step s;
  s.rotation = a;
  s.rotation_by = now.dtheta;
  s.dv = f + 0.5 * turned + a.cross(turned) / 6.0;
  s.dv_by = now.dv + 0.5 * (A * now.dv - F * now.dtheta) + (A * (A * now.dv - F * now.dtheta)) / 6.0 -
            skew(turned) * now.dtheta / 6.0;
  if (before == nullptr) return s;
  const double scale = now.in.dt_s / before->in.dt_s / 12.0;
  const Eigen::Vector3d a0 = scale * before->in.dtheta_U, f0 = scale * before->in.dv_U;
  s.rotation += a0.cross(a);
  s.rotation_by += skew(a0) * now.dtheta - scale * A * before->dtheta;
  s.dv += a0.cross(f) + f0.cross(a);
  s.dv_by += skew(a0) * now.dv - scale * F * before->dtheta + skew(f0) * now.dtheta - scale * A * before->dv;
  return s;
}

}  // namespace

PreintegratedImu PreintegratedImu::moved_to(const Eigen::VectorXd& other) const {
  const Eigen::Matrix<double, 9, 1> change = by_values * (other - values);
  PreintegratedImu out;
  out.dt_s = dt_s;
  out.dR = dR * so3_exp(change.segment<3>(Index::kTheta));
  out.dp = dp + change.segment<3>(Index::kPosition);
  out.dv = dv + change.segment<3>(Index::kVelocity);
  return out;
}

Preintegrator::Preintegrator(const FilterConfig& config, const ImuNoise& noise)
    : state_(filter_parts(config).states, config.own, {.noise = noise}), propagation_(state_, noise) {}

Preintegrator::Sample Preintegrator::calibrated(const ImuSample& raw, const Calibration& known,
                                                const Eigen::VectorXd& share) {
  const Eigen::Index others = state_.size() - Index::kMoving;
  Sample out{.in = known.apply(raw.dt_s, raw.dtheta_U, raw.dv_U),
             .dtheta = Columns::Zero(3, others),
             .dv = Columns::Zero(3, others)};
  for (const Feed& feed : state_.feeds(out.in)) {
    const Eigen::Index at = feed.state - Index::kMoving;
    const double by = -feed.rate * raw.dt_s * share[at];
    if (feed.axis < 3)
      out.dtheta.col(at) += by * known.gyro_inverse.col(feed.axis);
    else
      out.dv.col(at) += by * known.accel_inverse.col(feed.axis - 3);
  }
  return out;
}

PreintegratedImu Preintegrator::integrate(std::span<const ImuSample> samples, const ImuSample* before,
                                          const Eigen::VectorXd& values) {
  const int n = state_.size(), others = n - Index::kMoving;
  CANYON_CHECK(values.size() == others && !samples.empty(), values.size(), " values of ", others, ", ", samples.size(),
               " samples");
  PreintegratedImu out;
  out.values = values;
  out.by_values.setZero(Index::kMoving, others);
  out.kept.setOnes(others);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(n);
  start.tail(others) = values;
  state_.start({});
  state_.inject(start);
  ErrorMatrix P = ErrorMatrix::Zero(state_.padded_size(), state_.padded_size());

  Sample previous;
  if (before != nullptr) previous = calibrated(*before, state_.calibration(), out.kept);
  bool any_before = before != nullptr;
  for (const ImuSample& raw : samples) {
    propagation_.set_interval(raw.dt_s);
    const Calibration known = state_.step_calibration(propagation_.mean_share());
    const Eigen::VectorXd share =
        out.kept.cwiseProduct(propagation_.mean_share().segment(Index::kMoving, others).eval());
    const Sample now = calibrated(raw, known, share);
    const Step step = two_sample_step(now, any_before ? &previous : nullptr);

    propagation_.set_step(state_, now.in, StepJacobian(out.dR, now.in, known));
    propagation_.propagate(P);

    const Eigen::Matrix3d R = out.dR.toRotationMatrix();
    auto theta = out.by_values.middleRows<3>(Index::kTheta);
    const Columns pushed = R * (step.dv_by - skew(step.dv) * theta);
    out.by_values.middleRows<3>(Index::kPosition) +=
        raw.dt_s * (out.by_values.middleRows<3>(Index::kVelocity) + 0.5 * pushed);
    out.by_values.middleRows<3>(Index::kVelocity) += pushed;
    theta = (so3_exp(-step.rotation).toRotationMatrix() * theta + so3_right_jacobian(step.rotation) * step.rotation_by)
                .eval();
    const Eigen::Vector3d push = R * step.dv;
    out.dp += raw.dt_s * (out.dv + 0.5 * push);
    out.dv += push;
    out.dR = (out.dR * so3_exp(step.rotation)).normalized();
    out.dt_s += raw.dt_s;

    state_.fade(propagation_.decay(), raw.dt_s);
    out.kept.array() *= propagation_.decay().segment(Index::kMoving, others).array();
    previous = now;
    any_before = true;
  }
  out.covariance = P.topLeftCorner(n, n);
  return out;
}

}  // namespace canyon::fusion
