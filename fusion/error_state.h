#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "canyon/fusion/calibration.h"
#include "canyon/fusion/states/state_block.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// Layout of the first nine error states; those of the blocks follow in the order in which they were chosen.
///   theta: right perturbation of R_EU, rad        p, v: additive, in E, m and m/s
/// Every error is truth minus estimate (R = R_hat Exp(theta)).
struct ErrorIndex {
  static constexpr int kTheta = 0, kPosition = 3, kVelocity = 6;
  static constexpr int kMoving = 9;
};

/// Errors, or a covariance, row by row. It has a few rows and columns more than there are states, of zeros, so that a
/// row fills vector registers.
using ErrorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The state of a filter: motion of the IMU, and the values of the state blocks that it carries beside.
class ErrorState {
 public:
  /// `blocks`: rows of state_blocks(), `own` their parameters; throws ProgramError for another name. A block without
  /// states is left out.
  ErrorState(const std::vector<std::string>& blocks, const ModelParameters& own, const StateSetup& setup);

  int size() const { return size_; }
  int padded_size() const { return (size_ + 3) / 4 * 4; }
  /// Where the states of a block begin; -1 if it is not carried.
  int offset(std::string_view block) const;

  struct Member {
    std::string name;
    int offset = 0;
    std::shared_ptr<const StateBlock> block;
  };
  const std::vector<Member>& members() const { return members_; }

  /// What the states feed into the IMU's output while it measures `in`, states counted from the first of all.
  std::span<const Feed> feeds(const Increments& in);
  /// As last asked for.
  std::span<const Feed> feeds() const { return feeds_; }

  /// Begins at `at`, all values of the blocks zero.
  void start(const NavState& at);
  /// Adds an estimated error, of size() or more elements, to nav and values.
  void inject(const Eigen::Ref<const Eigen::VectorXd>& error);
  /// The estimate of a state keeps so much of itself.
  void renew(int state, double kept) { values_[state] *= kept; }
  /// Of the error of a block's state at the start.
  double first_variance(int state) const;
  /// Values over a step: each keeps so much of itself, and an integral grows.
  void fade(const Eigen::Ref<const Eigen::VectorXd>& decay, double dt_s);
  /// `count` values from state `offset` on.
  Eigen::VectorBlock<const Eigen::VectorXd> values(int offset, int count) const {
    return values_.segment(offset, count);
  }
  /// What the values say of the IMU.
  Calibration calibration() const;
  /// What step_calibration() gave last.
  const Calibration& over_step() const { return over_step_; }
  /// The same over a step, in the mean of which a value is `share` of what it is at the start.
  const Calibration& step_calibration(const Eigen::Ref<const Eigen::VectorXd>& share);

  /// State `integral` is the integral of state `of`, counted from the first of all.
  struct Integral {
    int integral = 0, of = 0;
  };
  const std::vector<Integral>& integrals() const { return integrals_; }

  /// Axes of the vehicle in those of the IMU, as the block mounting has them; identity without it.
  const Eigen::Matrix3d& R_UB() const { return R_UB_; }
  /// An error dm of that block is R_UB Exp(J dm).
  const Eigen::Matrix3d& mounting_jacobian() const { return mounting_jacobian_; }
  int mounting() const { return mounting_; }  ///< where the block begins; -1 without it

  /// The pose that the block clone holds; nothing before it is taken, or without it.
  struct ClonedPose {
    GpsTime t;
    Eigen::Quaterniond R_EU;
    Eigen::Vector3d p_EU_E;
  };
  const std::optional<ClonedPose>& clone() const { return clone_; }
  void take_clone() { clone_ = ClonedPose{nav.t, nav.R_EU, nav.p_EU_E}; }

  NavState nav;

 private:
  void calibrate(const Eigen::VectorXd& values, Calibration& imu) const;
  void mount();

  std::vector<Member> members_;
  int size_ = ErrorIndex::kMoving;
  Eigen::VectorXd values_;  ///< of all states; those of nav stay zero
  std::vector<Feed> feeds_;
  Eigen::VectorXd shared_;
  Calibration over_step_;
  std::vector<Integral> integrals_;
  int mounting_ = -1, clone_at_ = -1;
  Eigen::Matrix3d R_UB_ = Eigen::Matrix3d::Identity(), mounting_jacobian_ = Eigen::Matrix3d::Identity();
  std::optional<ClonedPose> clone_;
};

}  // namespace canyon::fusion
