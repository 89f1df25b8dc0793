#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/imu_noise.h"
#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"
#include "canyon/core/result.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/smoothing/smoothed_state.h"

namespace canyon::fusion {

/// The filter was made less sure of its motion at an instant, as after a gap (ErrorStateFilter::loosen).
struct Loosening {
  GpsTime t;
  double theta_rad = 0.0, p_m = 0.0, v_m_s = 0.0;
};

/// A run to be smoothed: what a filter is told of it, and its messages, each kind in the order of time. What is
/// referred to outlives the call.
struct SmootherInput {
  const FilterConfig& config;  ///< states, measurements, acceptance, uncertainty at the start
  ImuNoise noise;
  LocalFrame frame;
  Eigen::Vector3d lever_U_B = Eigen::Vector3d::Zero();  ///< IMU in B, m
  Eigen::Vector3d lever_A_B = Eigen::Vector3d::Zero();  ///< antenna in B, m
  GpsTime start;                                        ///< at the beginning of a sample; earlier ones are left out
  Pose X_WB;                                            ///< at the start
  Eigen::Vector3d v_WB_W = Eigen::Vector3d::Zero();
  std::span<const ImuSample> imu;
  std::span<const GnssFix> fixes;
  std::span<const OdometerSample> odometer;
  std::span<const BarometerSample> barometer = {};        ///< not of factor graphs, as all that follow
  std::span<const MagnetometerSample> magnetometer = {};  ///< axes of U
  std::span<const HeadingSample> heading = {};
  std::span<const PoseInMap> poses = {};     ///< in a map that was there before
  std::span<const Loosening> loosened = {};  ///< at the ends of samples
};

/// How far a fix was believed.
struct FixWeight {
  GpsTime t;
  double weight = 1.0;  ///< of its residual: 1 in full, 0 not at all
};

struct Smoothed {
  std::vector<SmoothedState> states;  ///< in the order of time
  std::vector<FixWeight> fixes;       ///< of factor graphs: of each fix that was used
};

/// Makes one trajectory, with covariance, of a whole run. One-level interface; the models are in the table below, each
/// in its own file with its own parameters.
class Smoother {
 public:
  virtual ~Smoother() = default;
  /// An Error if samples do not follow one another, nothing follows the start, or the build has not what it needs.
  virtual Result<Smoothed> smooth(const SmootherInput& run) = 0;
};

/// Rows of the filter's measurements that the smoother has no place for: of a factor graph "barometer",
/// "magnetometer", "heading" and "map_pose". ("standstill" looks at a stretch of time, and graphs do without it.)
std::vector<std::string> not_smoothed_by(std::string_view smoother, const FilterConfig& config);

using MakeSmoother = std::unique_ptr<Smoother>(const ModelParameters& own);
ModelTable<MakeSmoother> smoothers();

/// Makers of the rows of the table in fusion/smoothing/smoothers.cpp, and their parameters, each in the file of its
/// model.
std::unique_ptr<Smoother> make_filter_alone(const ModelParameters& own);
std::unique_ptr<Smoother> make_rts(const ModelParameters& own);
void forward_backward_parameters(ModelParameters& section);
std::unique_ptr<Smoother> make_batch_graph(const ModelParameters& own);
std::unique_ptr<Smoother> make_fixed_lag_graph(const ModelParameters& own);
void graph_parameters(ModelParameters& section);
void fixed_lag_graph_parameters(ModelParameters& section);

}  // namespace canyon::fusion
