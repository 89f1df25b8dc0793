#include "canyon/fusion/verdict/state_record.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/earth/earth.h"

namespace canyon::fusion {
namespace {

constexpr const char* kXyz[3] = {"x", "y", "z"};
constexpr double kMostRecorded = 1e6;  // sigma

std::string name_in(const ErrorState::Member& member, int i) {
  const int n = member.block->size();
  const bool of_triads = n == 6 || n == 18;
  const std::string triad = of_triads ? (2 * i < n ? "gyro " : "accel ") : "";
  if (n == 1) return member.name;
  if (n == 3) return member.name + " " + kXyz[i];
  const char* const bias = member.name == "turn_on_biases"  ? "turn-on bias "
                           : member.name == "in_run_biases" ? "in-run bias "
                                                            : "bias ";
  if (n == 6) return triad + bias + kXyz[i % 3];
  if (n == 18) {
    const int row = i % 9 / 3, column = i % 3;
    return triad + (row == column ? std::string("scale ") + kXyz[row]
                                  : std::string("misalignment ") + kXyz[row] + kXyz[column]);
  }
  return member.name + " " + std::to_string(i + 1);
}

/// Variances, those of position and velocity along east, north, up.
Eigen::VectorXd variances(const Eigen::MatrixXd& P, const Eigen::Matrix3d& R_EN) {
  Eigen::VectorXd out = P.diagonal();
  for (const int at : {ErrorIndex::kPosition, ErrorIndex::kVelocity})
    out.segment<3>(at) = (R_EN.transpose() * P.block<3, 3>(at, at) * R_EN).diagonal();
  return out;
}

}  // namespace

void PredictionAlone::follow(ErrorStateFilter& filter) {
  const int n = filter.state().size(), padded = filter.state().padded_size();
  P_ = ErrorMatrix::Zero(padded, padded);
  P_.topLeftCorner(n, n) = filter.covariance();
  filter.watch(this);
}

void PredictionAlone::predicted(ErrorPropagation& step) {
  constexpr double kUnknown = 1e20;
  if (!(P_.diagonal().head<ErrorIndex::kMoving>().maxCoeff() < kUnknown)) return;
  step.propagate(P_);
}

std::vector<StateName> state_names(const ErrorState& state) {
  std::vector<StateName> out = {
      {"attitude", "roll"},          {"attitude", "pitch"},          {"attitude", "yaw"},
      {"position", "east position"}, {"position", "north position"}, {"position", "height"},
      {"velocity", "east velocity"}, {"velocity", "north velocity"}, {"velocity", "vertical velocity"}};
  for (const ErrorState::Member& member : state.members())
    for (int i = 0; i < member.block->size(); ++i) out.push_back({member.name, name_in(member, i)});
  return out;
}

void StateRecord::add(const ErrorStateFilter& filter, const PredictionAlone& alone) {
  const GpsTime t = filter.nav_state().t;
  if (states_.empty()) {
    first_ = t;
    for (StateName& name : state_names(filter.state())) {
      StateHistory state;
      state.block = std::move(name.block);
      state.name = std::move(name.name);
      states_.push_back(std::move(state));
    }
    with_prior_.assign(states_.size(), false);
    for (const ErrorState::Member& member : filter.state().members())
      for (int i = 0; i < member.block->size(); ++i)
        with_prior_[static_cast<std::size_t>(member.offset + i)] =
            member.name != "clone" && member.block->integral_of(i) < 0;
  }
  const Eigen::Matrix3d R_EN = rotation_E_from_enu(geodetic_from_ecef(filter.nav_state().p_EU_E));
  const Eigen::VectorXd now = variances(filter.covariance(), R_EN),
                        before = variances(alone.covariance().topLeftCorner(now.size(), now.size()), R_EN);
  for (Eigen::Index i = 0; i < now.size(); ++i) {
    StateHistory& state = states_[static_cast<std::size_t>(i)];
    if (state.block == "clone" || !(before[i] > 0.0)) continue;
    state.share = std::sqrt(std::clamp(now[i] / before[i], 0.0, 1.0));
    state.least_share = std::min(state.least_share, state.share);
    if (state.share > kObserved) continue;
    if (!state.halved_after_s) state.halved_after_s = t - first_;
    if (!with_prior_[static_cast<std::size_t>(i)]) continue;
    const double z = filter.value(static_cast<int>(i)) / std::sqrt(before[i] - now[i]);
    state.estimate.add(t, Eigen::VectorXd::Constant(1, std::clamp(z, -kMostRecorded, kMostRecorded)));
  }
  keep_shares(t - first_);
}

/// Where there is no room for another one every second goes, and half as many are kept from then on.
void StateRecord::keep_shares(double elapsed_s) {
  if (looks_++ % every_ != 0) return;
  if (times_s_.size() == kInstants) {
    const auto thin = [](std::vector<double>& series) {
      for (std::size_t i = 1; 2 * i < series.size(); ++i) series[i] = series[2 * i];
      series.resize((series.size() + 1) / 2);
    };
    thin(times_s_);
    for (StateHistory& state : states_) thin(state.shares);
    every_ *= 2;
    if ((looks_ - 1) % every_ != 0) return;
  }
  times_s_.push_back(elapsed_s);
  for (StateHistory& state : states_) state.shares.push_back(state.share);
}

}  // namespace canyon::fusion
