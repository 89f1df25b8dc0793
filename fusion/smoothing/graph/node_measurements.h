#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/fusion/smoothing/graph/graph_layout.h"
#include "canyon/fusion/smoothing/graph/imu_factor.h"

namespace canyon::fusion {

/// One measurement of a node, as a row of measurement_models() makes it.
struct NodeMeasurement {
  std::size_t model = 0;                ///< counted from the first that the filter has
  std::vector<AidingMessage> messages;  ///< in turn; none: of the motion itself
  ImuSample imu;                        ///< the sample that ends at the node
  Eigen::MatrixXd whiten;               ///< of its noise, as it was when the node was made
  bool of_position = false;             ///< of a fix: what robustness guards against
  double weight = 1.0;                  ///< in [0, 1], of the whitened rows: a switch, or a loss's
};

/// The filter's own measurement rows at the nodes of a graph: the same residuals, derivatives and noise. Rows that look
/// at how the unit has moved over some time (`standstill`) have no place at one instant and are left out.
class NodeMeasurements {
 public:
  NodeMeasurements(const FilterConfig& config, const ImuNoise& noise, const LocalFrame& frame,
                   const Eigen::Vector3d& lever_U_B, const Eigen::Vector3d& lever_A_B);

  const ErrorState& state() const { return state_; }
  /// What the filter's rows make of a fix, of odometer samples of which the last ends at the node, and of the motion.
  std::vector<NodeMeasurement> of_fix(const GnssFix& fix, const ImuSample& imu, const GraphLayout& layout,
                                      const GraphNode& node, const Eigen::VectorXd& constants);
  std::vector<NodeMeasurement> of_odometer(const std::vector<OdometerSample>& samples, const ImuSample& imu,
                                           const GraphLayout& layout, const GraphNode& node,
                                           const Eigen::VectorXd& constants);
  std::vector<NodeMeasurement> of_motion(const ImuSample& imu, const GraphLayout& layout, const GraphNode& node,
                                         const Eigen::VectorXd& constants);

  /// What the node says of the IMU, and how it turns in a sample that ends there.
  Calibration calibration(const GraphLayout& layout, const GraphNode& node, const Eigen::VectorXd& constants);
  Eigen::Vector3d angular_rate(const ImuSample& imu, const GraphLayout& layout, const GraphNode& node,
                               const Eigen::VectorXd& constants);

  /// Whitened, without the weight; by_second stays empty.
  FactorRows rows(const NodeMeasurement& m, const GraphLayout& layout, const GraphNode& node,
                  const Eigen::VectorXd& constants);

 private:
  void put(const GraphLayout& layout, const GraphNode& node, const Eigen::VectorXd& constants);
  struct Model {
    std::string name;
    std::unique_ptr<MeasurementModel> model;
  };
  std::optional<Measurement> measure(const NodeMeasurement& m, const GraphLayout& layout, const GraphNode& node,
                                     const Eigen::VectorXd& constants);
  void add(NodeMeasurement m, const GraphLayout& layout, const GraphNode& node, const Eigen::VectorXd& constants,
           std::vector<NodeMeasurement>& to);

  LocalFrame frame_;
  Eigen::Vector3d lever_U_B_, lever_A_B_;
  ErrorState state_;
  Eigen::VectorXd whole_;
  std::vector<Model> models_;
};

}  // namespace canyon::fusion
