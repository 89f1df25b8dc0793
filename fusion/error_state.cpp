#include "canyon/fusion/error_state.h"

#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {

using Index = ErrorIndex;

ErrorState::ErrorState(const std::vector<std::string>& blocks, const ModelParameters& own, const StateSetup& setup) {
  for (const std::string& name : blocks) {
    auto block = model_row(state_blocks(), name).make(own, setup);
    if (block == nullptr) continue;
    const int offset = size_;
    size_ += block->size();
    for (int i = 0; i < block->size(); ++i)
      if (const int of = block->integral_of(i); of >= 0) integrals_.push_back({offset + i, offset + of});
    members_.push_back({name, offset, std::move(block)});
  }
  mounting_ = offset("mounting");
  clone_at_ = offset("clone");
  values_.setZero(padded_size());
  shared_ = values_;
}

int ErrorState::offset(std::string_view block) const {
  for (const Member& member : members_)
    if (member.name == block) return member.offset;
  return -1;
}

std::span<const Feed> ErrorState::feeds(const Increments& in) {
  feeds_.clear();
  for (const Member& member : members_) {
    const auto first = feeds_.size();
    member.block->feed(in, feeds_);
    for (auto i = first; i < feeds_.size(); ++i) feeds_[i].state += member.offset;
  }
  return feeds_;
}

void ErrorState::start(const NavState& at) {
  nav = at;
  values_.setZero();
  clone_.reset();
  mount();
}

void ErrorState::mount() {
  if (mounting_ < 0) return;
  const Eigen::Vector3d m = values_.segment<3>(mounting_);
  R_UB_ = so3_exp(m).toRotationMatrix();
  mounting_jacobian_ = so3_right_jacobian(m);
}

void ErrorState::inject(const Eigen::Ref<const Eigen::VectorXd>& error) {
  const Eigen::Vector3d theta = error.segment<3>(Index::kTheta);
  nav.R_EU = (nav.R_EU * so3_exp(theta)).normalized();
  nav.p_EU_E += error.segment<3>(Index::kPosition);
  nav.v_EU_E += error.segment<3>(Index::kVelocity);
  const int parameters = size_ - Index::kMoving;
  values_.segment(Index::kMoving, parameters) += error.segment(Index::kMoving, parameters);
  mount();
  if (!clone_) return;
  const Eigen::Vector3d then = error.segment<3>(clone_at_);
  clone_->R_EU = (clone_->R_EU * so3_exp(then)).normalized();
  clone_->p_EU_E += error.segment<3>(clone_at_ + 3);
  values_.segment<6>(clone_at_).setZero();
}

double ErrorState::first_variance(int state) const {
  for (const Member& member : members_)
    if (state >= member.offset && state < member.offset + member.block->size())
      return member.block->variance(state - member.offset);
  return 0.0;
}

void ErrorState::fade(const Eigen::Ref<const Eigen::VectorXd>& decay, double dt_s) {
  for (const Integral& i : integrals_) values_[i.integral] += dt_s * values_[i.of];
  values_.array() *= decay.array();
}

Calibration ErrorState::calibration() const {
  Calibration imu;
  calibrate(values_, imu);
  return imu;
}

const Calibration& ErrorState::step_calibration(const Eigen::Ref<const Eigen::VectorXd>& share) {
  shared_.array() = values_.array() * share.array();
  calibrate(shared_, over_step_);
  return over_step_;
}

void ErrorState::calibrate(const Eigen::VectorXd& values, Calibration& imu) const {
  imu.gyro_bias.setZero();
  imu.accel_bias.setZero();
  for (const Member& member : members_)
    member.block->calibrate({values.data() + member.offset, static_cast<std::size_t>(member.block->size())}, imu);
}

}  // namespace canyon::fusion
