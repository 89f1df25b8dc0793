#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/fusion/measurements/measurement.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/drawn_numbers.h"

/// What rows of measurements are shown, a vehicle that drives at 8 m/s and a fix beside it, and where their cases are
/// collected.
namespace canyon::fusion {

inline const LocalFrame kPlaceFrame(Geodetic{48.0 * kDegree, 11.0 * kDegree, 500.0});
inline const GpsTime kThen = GpsTime::from_week_sow(1700, 2000.0);

/// A filter's view without a filter: what it stands on may be changed between two messages.
class SeenState {
 public:
  explicit SeenState(const std::vector<std::string>& blocks, const std::string& keys = "")
      : config_(configured(keys)), state(blocks, config_.own, {.noise = noise}) {
    NavState nav;
    nav.t = kThen;
    nav.R_EU =
        Eigen::Quaterniond(kPlaceFrame.R_EW()) * rotation_from({.yaw_rad = 0.6, .pitch_rad = 0.0, .roll_rad = 0.0});
    nav.p_EU_E = kPlaceFrame.to_E({10.0, 20.0, 3.0});
    nav.v_EU_E = nav.R_EU * Eigen::Vector3d(8.0, 0.0, 0.0);
    state.start(nav);
  }
  std::unique_ptr<MeasurementModel> model(const std::string& row) const {
    auto made = model_row(measurement_models(), row).make(config_.own, {.state = state, .noise = noise});
    made->start();
    return made;
  }
  FilterView view() const {
    return {.state = state,
            .frame = kPlaceFrame,
            .lever_U_B = lever_U,
            .lever_A_B = lever_A,
            .imu = imu,
            .w_EU_U = w,
            .f_U = f};
  }
  /// All states beside motion.
  void set(const std::string& block, const Eigen::VectorXd& values) {
    Eigen::VectorXd e = Eigen::VectorXd::Zero(state.padded_size());
    const int at = state.offset(block);
    e.segment(at, values.size()) = values - state.values(at, static_cast<int>(values.size()));
    state.inject(e);
  }

 private:
  FilterConfig config_;

 public:
  ImuNoise noise;
  ErrorState state;
  Calibration imu;
  Eigen::Vector3d w = Eigen::Vector3d::Zero(), f = Eigen::Vector3d(0.0, 0.0, 9.81), lever_U = Eigen::Vector3d::Zero(),
                  lever_A = Eigen::Vector3d::Zero();
};

inline GnssFix some_fix(const SeenState& seen) {
  GnssFix fix;
  fix.t = kThen;
  fix.status = FixStatus::kSingle;
  fix.p_A_E = seen.state.nav.p_EU_E + Eigen::Vector3d(1.0, -2.0, 0.5);
  DrawnNumbers draw(5);
  fix.covariance_E = draw.positive(3, 0.2);
  fix.covariance_E(0, 1) += 0.02;  // not quite symmetric, as of text
  return fix;
}

/// Rows of the one mechanism that these cases have in common.
inline StressRows measured_rows() {
  StressRows rows;
  rows.of({StressGroup::kData, "rows of measurements over several messages",
           "a mean that goes on, a limit of another unit, a floor that is a ceiling",
           "when they measure and what they state, by hand: roundings", "of the bound"});
  return rows;
}

}  // namespace canyon::fusion
