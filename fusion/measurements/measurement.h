#pragma once

#include <memory>
#include <optional>
#include <span>
#include <variant>

#include <Eigen/Core>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"
#include "canyon/fusion/error_state.h"
#include "canyon/fusion/propagation/row_kernels.h"

namespace canyon::fusion {

/// A linearized measurement: measured minus predicted = H error + noise, the errors as in ErrorState. H has the padding
/// of the filter's matrices.
struct Measurement {
  static constexpr int kMost = 6;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMost, kMost>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMost, kMostStates>;

  Vector residual;
  Square R;  ///< covariance of the noise
  Rows H;
  /// Three states of ErrorIndex that it is about: a filter that has lost its way by it is unsure of these.
  int about;
  /// Of the place of something that moves: its speed, and measured minus predicted velocity.
  struct Motion {
    double speed_m_s = 0.0;
    Eigen::Vector3d residual_m_s = Eigen::Vector3d::Zero();
    bool measured = false;  ///< the message has a velocity; else that residual is zero
  };
  std::optional<Motion> motion;

  Measurement(int dimension, const ErrorState& state, int about_states);
  int dimension() const { return static_cast<int>(residual.size()); }
};

/// What a measurement model sees of the filter.
struct FilterView {
  const ErrorState& state;
  const LocalFrame& frame;
  const Eigen::Vector3d& lever_U_B;  ///< IMU in B, m
  const Eigen::Vector3d& lever_A_B;  ///< antenna in B as the filter was told, m
  const Calibration& imu;            ///< as it stood in the last sample
  const Eigen::Vector3d& w_EU_U;     ///< angular rate of the last sample, rad/s
  const Eigen::Vector3d& f_U;        ///< specific force of the last sample, m/s^2
};

/// What reaches the filter beside the IMU.
using AidingMessage = std::variant<GnssFix, GnssEpoch, OdometerSample, BarometerSample, MagnetometerSample,
                                   HeadingSample, RelativePose, PoseInMap>;
/// When the message says that it holds.
GpsTime time_of(const AidingMessage& message);

/// A state of a block that is no longer quite what it was: of its error it keeps so much, and is for the rest as
/// unknown as at the start; with `kept` 0 it begins anew.
struct Renewal {
  int state = 0;
  double kept = 0.0;
};

/// Makes a measurement of a message, or of the motion itself. One-level interface; the models are in the table below,
/// each in its own file with its own parameters.
class MeasurementModel {
 public:
  virtual ~MeasurementModel() = default;
  virtual std::unique_ptr<MeasurementModel> clone() const = 0;
  /// The filter begins anew.
  virtual void start() {}
  /// An IMU sample has been taken in; `in` without its known errors.
  virtual std::optional<Measurement> stepped(const FilterView& /*filter*/, const Increments& /*in*/) { return {}; }
  /// A message is coming, which is taken in so many parts, each after the filter has been corrected by the last.
  virtual int parts(const FilterView& /*filter*/, const AidingMessage& /*message*/) { return 1; }
  /// What that message finds changed, known after parts(), and true before its first part is taken.
  virtual std::span<const Renewal> renewed() const { return {}; }
  /// One part of it; nothing if it is not for this model, or says nothing.
  virtual std::optional<Measurement> received(const FilterView& /*filter*/, const AidingMessage& /*message*/,
                                              int /*part*/) {
    return {};
  }
};

/// What a model is made for.
struct MeasurementSetup {
  const ErrorState& state;
  const ImuNoise& noise;
};

/// `own`: the parameters of all rows of the table.
using MakeMeasurementModel = std::unique_ptr<MeasurementModel>(const ModelParameters& own, const MeasurementSetup& at);
ModelTable<MakeMeasurementModel> measurement_models();

/// Makers of the rows of the table in measurements/measurement_models.cpp, and their parameters, each in the file of
/// its model.
std::unique_ptr<MeasurementModel> make_position(const ModelParameters& own, const MeasurementSetup& at);
void position_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_velocity(const ModelParameters& own, const MeasurementSetup& at);
void velocity_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_ranges(const ModelParameters& own, const MeasurementSetup& at);
void ranges_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_heading(const ModelParameters& own, const MeasurementSetup& at);
void heading_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_barometer(const ModelParameters& own, const MeasurementSetup& at);
void barometer_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_magnetometer(const ModelParameters& own, const MeasurementSetup& at);
void magnetometer_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_relative_pose(const ModelParameters& own, const MeasurementSetup& at);
void relative_pose_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_map_pose(const ModelParameters& own, const MeasurementSetup& at);
void map_pose_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_non_holonomic(const ModelParameters& own, const MeasurementSetup& at);
void non_holonomic_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_standstill(const ModelParameters& own, const MeasurementSetup& at);
void standstill_parameters(ModelParameters& section);
std::unique_ptr<MeasurementModel> make_odometer(const ModelParameters& own, const MeasurementSetup& at);
void odometer_parameters(ModelParameters& section);

}  // namespace canyon::fusion
