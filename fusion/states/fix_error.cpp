#include "canyon/fusion/states/fix_error.h"

#include <Eigen/Eigenvalues>

#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {

void visit(FieldVisitor& f, FixErrorParameters& p) {
  f.number("fix_error_sigma_m", p.fix_error_sigma_m, {1e-6, 1e4}, "1-sigma per axis of the errors of fixes that last");
  f.number("fix_error_scale", p.fix_error_scale, {0, 1000},
           "so many 1-sigmas that a fix states of itself are added to that, in squares");
  f.number("fix_error_power", p.fix_error_power, {0, 4}, "to this power, those 1-sigmas in m");
  f.number("fix_error_tau_s", p.fix_error_tau_s, {1e-3, 1e9}, "their correlation time");
  f.number("fix_error_way_m", p.fix_error_way_m, {1e-3, 1e9}, "way of the antenna over which they change");
}

Eigen::Matrix3d FixErrorParameters::covariance(const Eigen::Matrix3d& stated) const {
  const Eigen::Matrix3d symmetric = 0.5 * (stated + stated.transpose());
  Eigen::Matrix3d grown = fix_error_scale * fix_error_scale * symmetric;
  if (fix_error_power != 1.0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of(symmetric);
    const Eigen::Vector3d powers = of.eigenvalues().cwiseMax(0.0).array().pow(fix_error_power);
    grown = fix_error_scale * fix_error_scale * of.eigenvectors() * powers.asDiagonal() * of.eigenvectors().transpose();
  }
  return fix_error_sigma_m * fix_error_sigma_m * Eigen::Matrix3d::Identity() + grown;
}

Eigen::Matrix3d FixErrorParameters::share(const Eigen::Matrix3d& stated) const {
  if (fix_error_scale == 0.0) return Eigen::Matrix3d::Identity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of(covariance(stated));
  const Eigen::Vector3d roots = of.eigenvalues().cwiseMax(0.0).cwiseSqrt() / fix_error_sigma_m;
  return of.eigenvectors() * roots.asDiagonal() * of.eigenvectors().transpose();
}

namespace {

/// The part of the fixes' errors that lasts from one to the next, as of multipath, along E's axes: a Gauss-Markov
/// process.
class FixError final : public StateBlock {
 public:
  explicit FixError(const FixErrorParameters& p) : p_(p) {}
  int size() const override { return 3; }
  double variance(int) const override { return p_.fix_error_sigma_m * p_.fix_error_sigma_m; }
  StateProcess process(int state) const override {
    return StateProcess::gauss_markov(variance(state), p_.fix_error_tau_s);
  }

 private:
  FixErrorParameters p_;
};

}  // namespace

std::unique_ptr<StateBlock> make_fix_error(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<FixError>(own.get<FixErrorParameters>());
}

void fix_error_parameters(ModelParameters& section) {
  section.add<FixErrorParameters>();
}

}  // namespace canyon::fusion
