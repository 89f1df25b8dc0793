#include "canyon/fusion/smoothing/graph/node_measurements.h"

#include <utility>

#include "canyon/core/check.h"

namespace canyon::fusion {
namespace {

/// Longer than any row waits between two looks at the motion.
constexpr double kWaited_s = 1e6;

}  // namespace

NodeMeasurements::NodeMeasurements(const FilterConfig& config, const ImuNoise& noise, const LocalFrame& frame,
                                   const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B)
    : frame_(frame),
      lever_U_B_(lever_U_B),
      lever_A_B_(lever_A_B),
      state_(filter_parts(config).states, config.own, {.noise = noise}),
      whole_(Eigen::VectorXd::Ones(state_.padded_size())) {
  for (const std::string& name : filter_parts(config).measurements)
    models_.push_back(
        {name, model_row(measurement_models(), name).make(config.own, {.state = state_, .noise = noise})});
}

void NodeMeasurements::put(const GraphLayout& layout, const GraphNode& node, const Eigen::VectorXd& constants) {
  Eigen::VectorXd error = Eigen::VectorXd::Zero(state_.size());
  error.tail(state_.size() - ErrorIndex::kMoving) = layout.values(node.walking, constants);
  state_.start(node.nav);
  state_.inject(error);
}

Calibration NodeMeasurements::calibration(const GraphLayout& layout, const GraphNode& node,
                                          const Eigen::VectorXd& constants) {
  put(layout, node, constants);
  return state_.calibration();
}

Eigen::Vector3d NodeMeasurements::angular_rate(const ImuSample& imu, const GraphLayout& layout, const GraphNode& node,
                                               const Eigen::VectorXd& constants) {
  const Increments in = calibration(layout, node, constants).apply(imu.dt_s, imu.dtheta_U, imu.dv_U);
  return in.dtheta_U / in.dt_s - node.nav.R_EU.conjugate() * earth_rate_E();
}

std::optional<Measurement> NodeMeasurements::measure(const NodeMeasurement& m, const GraphLayout& layout,
                                                     const GraphNode& node, const Eigen::VectorXd& constants) {
  put(layout, node, constants);
  const Calibration& known = state_.step_calibration(whole_);
  Increments in = known.apply(m.imu.dt_s, m.imu.dtheta_U, m.imu.dv_U);
  state_.feeds(in);
  const Eigen::Vector3d w_EU_U = in.dtheta_U / in.dt_s - node.nav.R_EU.conjugate() * earth_rate_E(),
                        f_U = in.dv_U / in.dt_s;
  const FilterView view{.state = state_,
                        .frame = frame_,
                        .lever_U_B = lever_U_B_,
                        .lever_A_B = lever_A_B_,
                        .imu = known,
                        .w_EU_U = w_EU_U,
                        .f_U = f_U};
  MeasurementModel& model = *models_[m.model].model;
  model.start();
  if (m.messages.empty()) {
    in.dt_s = kWaited_s;
    return model.stepped(view, in);
  }
  std::optional<Measurement> out;
  for (const AidingMessage& message : m.messages) out = model.received(view, message, 0);
  return out;
}

void NodeMeasurements::add(NodeMeasurement m, const GraphLayout& layout, const GraphNode& node,
                           const Eigen::VectorXd& constants, std::vector<NodeMeasurement>& to) {
  const std::optional<Measurement> made = measure(m, layout, node, constants);
  if (!made) return;
  m.whiten = whitening(made->R, 1e-9);
  to.push_back(std::move(m));
}

std::vector<NodeMeasurement> NodeMeasurements::of_fix(const GnssFix& fix, const ImuSample& imu,
                                                      const GraphLayout& layout, const GraphNode& node,
                                                      const Eigen::VectorXd& constants) {
  std::vector<NodeMeasurement> out;
  for (std::size_t i = 0; i < models_.size(); ++i)
    add({.model = i, .messages = {fix}, .imu = imu, .whiten = {}, .of_position = models_[i].name == "position"}, layout,
        node, constants, out);
  return out;
}

std::vector<NodeMeasurement> NodeMeasurements::of_odometer(const std::vector<OdometerSample>& samples,
                                                           const ImuSample& imu, const GraphLayout& layout,
                                                           const GraphNode& node, const Eigen::VectorXd& constants) {
  std::vector<NodeMeasurement> out;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    // The fewest samples, from the last backwards, of which the row makes a measurement.
    for (std::size_t count = 1; count <= samples.size(); ++count) {
      NodeMeasurement m{.model = i, .messages = {}, .imu = imu, .whiten = {}};
      m.messages.assign(samples.end() - static_cast<std::ptrdiff_t>(count), samples.end());
      const std::size_t before = out.size();
      add(std::move(m), layout, node, constants, out);
      if (out.size() > before) break;
    }
  }
  return out;
}

std::vector<NodeMeasurement> NodeMeasurements::of_motion(const ImuSample& imu, const GraphLayout& layout,
                                                         const GraphNode& node, const Eigen::VectorXd& constants) {
  std::vector<NodeMeasurement> out;
  for (std::size_t i = 0; i < models_.size(); ++i)
    if (models_[i].name != "standstill")
      add({.model = i, .messages = {}, .imu = imu, .whiten = {}}, layout, node, constants, out);
  return out;
}

FactorRows NodeMeasurements::rows(const NodeMeasurement& m, const GraphLayout& layout, const GraphNode& node,
                                  const Eigen::VectorXd& constants) {
  const std::optional<Measurement> made = measure(m, layout, node, constants);
  CANYON_CHECK(made.has_value(), models_[m.model].name, " no longer measures at ", node.nav.t.iso());
  FactorRows out;
  out.residual = m.whiten * made->residual;
  const Eigen::MatrixXd H = -m.whiten * made->H.leftCols(state_.size());
  out.by_first = layout.node_columns(H);
  out.by_constants = layout.constant_columns(H);
  return out;
}

}  // namespace canyon::fusion
