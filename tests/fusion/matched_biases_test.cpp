// Biases that wander, in states apart or merged into one per axis, and the pose at an earlier instant: the filter is as
// far off as it says.
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include <gtest/gtest.h>

#include "canyon/core/motion/rotation.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/driven_truth.h"
#include "canyon/tests/fusion/nees_bands.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using testing::DrivenTruth;

constexpr int kBiasRuns = 100, kBiasEpochs = 20;
constexpr double kBiasEpoch_s = 5.0;
/// Samples between fixes, and between clones: never cloned at an epoch, where both poses were one.
constexpr int kFixEvery = 50, kCloneEvery = 270;
constexpr double kBiasFix_m = 0.3, kBiasVelocity_m_s = 0.1, kTurned_rad = 1e-3, kMoved_m = 0.02;

enum class Kept { kApart, kMerged };

std::string bias_keys(Kept kept) {
  return std::string("states = [") + (kept == Kept::kApart ? "\"turn_on_biases\", \"in_run_biases\"" : "\"biases\"") +
         R"(, "clone"]
measurements = ["position", "velocity", "relative_pose"]
acceptance = "accept_all"
initial_attitude_sigma_deg_roll_pitch = 0.2
initial_attitude_sigma_deg_heading = 0.5
initial_position_sigma_m = 1.0
initial_velocity_sigma_m_s = 0.2
fix_velocity_floor_m_s = 1e-3
)";
}

ImuNoise wandering_unit() {
  ImuNoise n;
  n.gyro = {
      .white_per_sqrt_hz = 5e-5, .turn_on_bias_sigma = 2e-4, .in_run_bias_sigma = 2e-4, .in_run_bias_tau_s = 20.0};
  n.accel = {
      .white_per_sqrt_hz = 1e-3, .turn_on_bias_sigma = 1e-2, .in_run_bias_sigma = 1e-2, .in_run_bias_tau_s = 20.0};
  return n;
}

/// A bias as its block has it: a constant and a process, or a process of both their variances with the driving noise of
/// the second (fusion/states/biases.cpp).
struct Wandering {
  double constant = 0.0, sigma = 0.0, tau_s = 1.0;
};
Wandering law(const TriadNoise& n, Kept kept) {
  if (kept == Kept::kApart) return {n.turn_on_bias_sigma, n.in_run_bias_sigma, n.in_run_bias_tau_s};
  const double sigma = std::hypot(n.turn_on_bias_sigma, n.in_run_bias_sigma), ratio = sigma / n.in_run_bias_sigma;
  return {0.0, sigma, n.in_run_bias_tau_s * ratio * ratio};
}

class BiasWorld {
 public:
  BiasWorld(std::uint64_t seed, Kept kept)
      : kept_(kept),
        stream_(seed, "test.wandering"),
        truth_(seed, 0.3 + 0.05 * static_cast<double>(seed)),
        laws_{law(wandering_unit().gyro, kept), law(wandering_unit().accel, kept)} {
    truth_.gyro_per_sqrt_hz = wandering_unit().gyro.white_per_sqrt_hz;
    truth_.accel_per_sqrt_hz = wandering_unit().accel.white_per_sqrt_hz;
    for (int i = 0; i < 6; ++i) {
      constant_[i] = of(i).constant * draw();
      wandering_[i] = of(i).sigma * draw();
    }
  }

  ErrorStateFilter filter() {
    ErrorStateFilter out(configured(bias_keys(kept_)), wandering_unit(), DrivenTruth::frame(), Vector3d::Zero(),
                         Vector3d::Zero());
    Pose X = truth_.X_WB();
    X.R = so3_exp(Vector3d(0.2 * kDegree * draw(), 0.2 * kDegree * draw(), 0.5 * kDegree * draw())) * X.R;
    X.p += vector(1.0);
    out.initialize(truth_.state().t, X, truth_.v_W() + vector(0.2));
    clone(out);
    return out;
  }

  void step(ErrorStateFilter& filter) {
    ImuSample s = truth_.step();
    const Vector6d before = wandering_;
    for (int i = 0; i < 6; ++i) {
      const double kept = std::exp(-s.dt_s / of(i).tau_s);
      wandering_[i] = kept * wandering_[i] + of(i).sigma * std::sqrt(1.0 - kept * kept) * draw();
    }
    const Vector6d mean = constant_ + 0.5 * (before + wandering_);
    s.dtheta_U += mean.head<3>() * s.dt_s;
    s.dv_U += mean.tail<3>() * s.dt_s;
    filter.predict(s);
    ++k_;
    if (k_ % kFixEvery == 0) fix(filter);
    if (k_ % kCloneEvery == 0) {
      relative(filter);
      clone(filter);
    }
  }

  /// Errors, truth minus estimate, by name, and where they begin.
  struct Part {
    int at = 0;
    Eigen::VectorXd error;
  };
  std::map<std::string, Part> errors(const ErrorStateFilter& filter) const {
    const NavState &n = filter.nav_state(), &t = truth_.state();
    const auto& held = *filter.state().clone();
    Vector6d of_clone;
    of_clone << so3_log(held.R_EU.conjugate() * cloned_.R_EU), cloned_.p_EU_E - held.p_EU_E;
    const auto block = [&](const char* name, const Eigen::VectorXd& value) {
      Part out{filter.offset(name), value};
      for (int i = 0; i < out.error.size(); ++i) out.error[i] -= filter.value(out.at + i);
      return out;
    };
    std::map<std::string, Part> out{{"theta", {ErrorIndex::kTheta, so3_log(n.R_EU.conjugate() * t.R_EU)}},
                                    {"p", {ErrorIndex::kPosition, t.p_EU_E - n.p_EU_E}},
                                    {"v", {ErrorIndex::kVelocity, t.v_EU_E - n.v_EU_E}},
                                    {"clone", {filter.offset("clone"), of_clone}}};
    if (kept_ == Kept::kMerged) {
      out["biases"] = block("biases", wandering_);
    } else {
      out["turn_on_biases"] = block("turn_on_biases", constant_);
      out["in_run_biases"] = block("in_run_biases", wandering_);
    }
    Part all{0, Eigen::VectorXd(filter.covariance().rows())};
    for (const auto& [name, part] : out) all.error.segment(part.at, part.error.size()) = part.error;
    out["all"] = all;
    return out;
  }

 private:
  const Wandering& of(int i) const { return laws_[static_cast<std::size_t>(i / 3)]; }
  double draw() { return stream_.normal(0, n_++); }
  Vector3d vector(double sigma) { return sigma * Vector3d(draw(), draw(), draw()); }

  void clone(ErrorStateFilter& filter) {
    filter.take_clone();
    cloned_ = truth_.state();
  }
  void fix(ErrorStateFilter& filter) {
    GnssFix out = truth_.fix(vector(kBiasFix_m), kBiasFix_m);
    out.v_A_E = truth_.state().v_EU_E + vector(kBiasVelocity_m_s);
    out.velocity_covariance_E = kBiasVelocity_m_s * kBiasVelocity_m_s * Eigen::Matrix3d::Identity();
    filter.update(out);
  }
  void relative(ErrorStateFilter& filter) {
    const Pose then{cloned_.R_EU, cloned_.p_EU_E}, now{truth_.state().R_EU, truth_.state().p_EU_E};
    RelativePose out{.source = truth_.state().t, .target = cloned_.t, .X_TS = then.inverse() * now};
    Vector6d sigma;
    sigma << Vector3d::Constant(kTurned_rad), Vector3d::Constant(kMoved_m);
    out.covariance = sigma.cwiseAbs2().asDiagonal();
    const Vector3d turned = vector(kTurned_rad), moved = vector(kMoved_m);  // in the source's own axes
    out.X_TS = out.X_TS * Pose{so3_exp(turned), moved};
    filter.update(AidingMessage(out));
  }

  Kept kept_;
  RandomStream stream_;
  std::uint64_t n_ = 0;
  DrivenTruth truth_;
  std::array<Wandering, 2> laws_;
  Vector6d constant_, wandering_;
  NavState cloned_;
  int k_ = 0;
};

class MatchedBiases : public ::testing::TestWithParam<Kept> {};

TEST_P(MatchedBiases, EveryBlockIsAsFarOffAsItSays) {
  testing::BlockNees nees(kBiasEpochs);
  for (int run = 0; run < kBiasRuns; ++run) {
    BiasWorld world(static_cast<std::uint64_t>(run) + 1, GetParam());
    ErrorStateFilter filter = world.filter();
    for (int epoch = 0; epoch < kBiasEpochs; ++epoch) {
      for (int k = 0; k < static_cast<int>(100 * kBiasEpoch_s); ++k) world.step(filter);
      const Eigen::MatrixXd P = filter.covariance();
      for (const auto& [name, part] : world.errors(filter)) {
        const auto n = part.error.size();
        nees.add(name, epoch, normalized_squared(part.error, P.block(part.at, part.at, n, n)), static_cast<int>(n));
      }
    }
  }
  nees.expect_in_bands(kBiasRuns);
}

INSTANTIATE_TEST_SUITE_P(States, MatchedBiases, ::testing::Values(Kept::kApart, Kept::kMerged),
                         [](const auto& test) { return test.param == Kept::kApart ? "apart" : "merged"; });

}  // namespace
}  // namespace canyon::fusion
