#include "canyon/fusion/states/velocity_error.h"

#include <Eigen/Eigenvalues>

#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {

void visit(FieldVisitor& f, VelocityErrorParameters& p) {
  f.number("velocity_error_scale", p.velocity_error_scale, {0, 1000},
           "1-sigma of the errors of fixes' velocities that last, in those that a fix states");
  f.number("velocity_error_up_scale", p.velocity_error_up_scale, {0.01, 1000},
           "further factor on their vertical part, on which delays have the same sign all round");
  f.number("velocity_error_tau_s", p.velocity_error_tau_s, {1e-3, 1e9}, "their correlation time");
}

Eigen::Matrix3d VelocityErrorParameters::share(const Eigen::Matrix3d& stated, const Eigen::Vector3d& up_E) const {
  const Eigen::Matrix3d stretch =
      velocity_error_scale * (Eigen::Matrix3d::Identity() + (velocity_error_up_scale - 1.0) * up_E * up_E.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of(stretch * (0.5 * (stated + stated.transpose())) * stretch);
  return of.eigenvectors() * of.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * of.eigenvectors().transpose();
}

namespace {

class VelocityError final : public StateBlock {
 public:
  explicit VelocityError(const VelocityErrorParameters& p) : tau_s_(p.velocity_error_tau_s) {}
  int size() const override { return 3; }
  double variance(int) const override { return 1.0; }
  StateProcess process(int) const override { return StateProcess::gauss_markov(1.0, tau_s_); }

 private:
  double tau_s_;
};

}  // namespace

std::unique_ptr<StateBlock> make_velocity_error(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<VelocityError>(own.get<VelocityErrorParameters>());
}

void velocity_error_parameters(ModelParameters& section) {
  section.add<VelocityErrorParameters>();
}

}  // namespace canyon::fusion
