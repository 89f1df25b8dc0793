#include "canyon/fusion/smoothing/graph/graph_layout.h"

#include "canyon/core/motion/rotation.h"

namespace canyon::fusion {
namespace {

using Index = ErrorIndex;

Eigen::VectorXd part(const Eigen::VectorXd& values, const std::vector<int>& states) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(states.size()));
  for (std::size_t i = 0; i < states.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = values[states[i] - Index::kMoving];
  return out;
}

}  // namespace

GraphNode moved(const GraphNode& node, const Eigen::Ref<const Eigen::VectorXd>& error) {
  GraphNode out = node;
  out.nav.R_EU = (node.nav.R_EU * so3_exp(error.segment<3>(Index::kTheta))).normalized();
  out.nav.p_EU_E += error.segment<3>(Index::kPosition);
  out.nav.v_EU_E += error.segment<3>(Index::kVelocity);
  out.walking += error.tail(node.walking.size());
  return out;
}

Eigen::VectorXd difference(const GraphNode& from, const GraphNode& to) {
  Eigen::VectorXd out(Index::kMoving + from.walking.size());
  out << so3_log(from.nav.R_EU.conjugate() * to.nav.R_EU), to.nav.p_EU_E - from.nav.p_EU_E,
      to.nav.v_EU_E - from.nav.v_EU_E, to.walking - from.walking;
  return out;
}

GraphLayout::GraphLayout(const ErrorState& state) : states_(state.size()) {
  for (const ErrorState::Member& member : state.members()) {
    for (int i = 0; i < member.block->size(); ++i) {
      if (member.block->process(i).density > 0.0)
        walking_.push_back(member.offset + i);
      else if (member.block->variance(i) > 0.0)
        constant_.push_back(member.offset + i);
    }
  }
}

Eigen::VectorXd GraphLayout::values(const Eigen::VectorXd& walking, const Eigen::VectorXd& constants) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(states_ - Index::kMoving);
  for (std::size_t i = 0; i < walking_.size(); ++i)
    out[walking_[i] - Index::kMoving] = walking[static_cast<Eigen::Index>(i)];
  for (std::size_t i = 0; i < constant_.size(); ++i)
    out[constant_[i] - Index::kMoving] = constants[static_cast<Eigen::Index>(i)];
  return out;
}

Eigen::VectorXd GraphLayout::walking_of(const Eigen::VectorXd& values) const {
  return part(values, walking_);
}

Eigen::VectorXd GraphLayout::constants_of(const Eigen::VectorXd& values) const {
  return part(values, constant_);
}

Eigen::MatrixXd GraphLayout::node_columns(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd out(columns.rows(), node_size());
  out.leftCols<Index::kMoving>() = columns.leftCols<Index::kMoving>();
  for (std::size_t i = 0; i < walking_.size(); ++i)
    out.col(Index::kMoving + static_cast<Eigen::Index>(i)) = columns.col(walking_[i]);
  return out;
}

Eigen::MatrixXd GraphLayout::constant_columns(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd out(columns.rows(), constants());
  for (std::size_t i = 0; i < constant_.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = columns.col(constant_[i]);
  return out;
}

}  // namespace canyon::fusion
