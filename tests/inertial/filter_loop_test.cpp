#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/fusion/consistency.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/tests/inertial/smooth_path.h"

/// Sensor and filter together over many seeded drives: the covariance the filter states must be the one its errors
/// have.
namespace canyon {
namespace {

using fusion::Band;
using fusion::ConsistencyMean;
using fusion::ErrorStateFilter;
using fusion::FilterConfig;

const GpsTime kLoopStart = GpsTime::from_week_sow(1590, 396000.0);
const LocalFrame kFrame(Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0});
const Eigen::Vector3d kAntenna(-0.3, 0.0, 1.2);
constexpr double kFixSigma_m = 0.4;
constexpr double kFixRate_hz = 2.0;

struct DriveSetup {
  std::string sensor = "high_grade_mems";
  std::string errors = "datasheet";
  double rate_hz = 50.0;
  double seconds = 60.0;
  double last_fix_s = 1e9;  ///< fixes are withheld after this
  FilterConfig filter;
};

struct Outcome {
  double pose_nees = 0.0, velocity_nees = 0.0;  ///< at the end, 6 and 3 degrees of freedom
  double position_error_m = 0.0, position_sigma_m = 0.0;
  std::vector<double> nis;  ///< of the fixes, 3 degrees of freedom each
};

Eigen::Vector3d fix_error(std::uint64_t seed, std::int64_t epoch) {
  return kFixSigma_m * RandomStream(seed, "test.fix").normal3(static_cast<std::uint64_t>(epoch));
}

/// Truth disturbed by the filter's own initial uncertainty.
void initialize(ErrorStateFilter& filter, const FilterConfig& c, const KinematicState& truth, std::uint64_t seed) {
  const RandomStream stream(seed, "test.initial");
  const Eigen::Vector3d attitude = stream.normal3(0, 0), position = stream.normal3(0, 1),
                        velocity = stream.normal3(0, 2);
  const double tilt = c.initial_attitude_sigma_deg_roll_pitch * kDegree;
  const double heading = c.initial_attitude_sigma_deg_heading * kDegree;
  const Eigen::Vector3d turn_W(tilt * attitude.x(), tilt * attitude.y(), heading * attitude.z());
  Pose start = truth.X_WB;
  start.R = so3_exp(turn_W) * start.R;
  start.p += c.initial_position_sigma_m * position;
  filter.initialize(truth.t, start, truth.v_WB_W + c.initial_velocity_sigma_m_s * velocity);
}

Outcome drive(const DriveSetup& setup, std::uint64_t seed) {
  const testing::SmoothPath path(kLoopStart);
  inertial::ImuConfig imu_config;
  imu_config.sensor = setup.sensor;
  imu_config.errors = setup.errors;
  imu_config.rate_hz = setup.rate_hz;
  auto imu = *inertial::make_imu(imu_config, seed, kFrame);
  ErrorStateFilter filter(setup.filter, imu->noise(), kFrame, imu_config.lever_arm_m, kAntenna);
  initialize(filter, setup.filter, path.at(kLoopStart), seed);

  Outcome out;
  const auto samples = static_cast<std::int64_t>(setup.seconds * setup.rate_hz);
  const auto per_fix = static_cast<std::int64_t>(setup.rate_hz / kFixRate_hz);
  for (std::int64_t k = 0; k < samples; ++k) {
    filter.predict(imu->sample(k, path.nodes(k, setup.rate_hz, 2)));
    if ((k + 1) % per_fix != 0) continue;
    const GpsTime now = filter.nav_state().t;
    if (now - kLoopStart > setup.last_fix_s) continue;
    GnssFix fix;
    fix.t = now;
    fix.status = FixStatus::kDifferential;
    fix.p_A_E = kFrame.to_E(path.at(now).X_WB * kAntenna) + fix_error(seed, k);
    fix.covariance_E = kFixSigma_m * kFixSigma_m * Eigen::Matrix3d::Identity();
    out.nis.push_back(filter.update(fix).nis);
  }
  const NavEstimate estimate = filter.estimate();
  const KinematicState truth = path.at(estimate.t);
  const Vector6d xi = (estimate.X_WB.inverse() * truth.X_WB).log();
  out.pose_nees = fusion::normalized_squared(xi, estimate.pose_covariance);
  out.velocity_nees =
      fusion::normalized_squared(Eigen::Vector3d(truth.v_WB_W - estimate.v_WB_W), estimate.velocity_covariance_W);
  out.position_error_m = (estimate.X_WB.p - truth.X_WB.p).norm();
  out.position_sigma_m = std::sqrt(estimate.pose_covariance.bottomRightCorner<3, 3>().trace());
  return out;
}

struct Ensemble {
  const char* name = "";
  ConsistencyMean pose, velocity, nis;
  double position_rms_m = 0.0, position_sigma_rms_m = 0.0;
};

constexpr int kLoopRuns = 100;

/// `first_seed`: ensembles of seeds apart from one another's have nothing in common.
Ensemble ensemble(const char* name, const DriveSetup& setup, std::uint64_t first_seed) {
  Ensemble e;
  e.name = name;
  for (int run = 0; run < kLoopRuns; ++run) {
    const Outcome o = drive(setup, first_seed + static_cast<std::uint64_t>(run));
    e.pose.add(o.pose_nees, 6);
    e.velocity.add(o.velocity_nees, 3);
    for (const double nis : o.nis) e.nis.add(nis, 3);
    e.position_rms_m += o.position_error_m * o.position_error_m / kLoopRuns;
    e.position_sigma_rms_m += o.position_sigma_m * o.position_sigma_m / kLoopRuns;
  }
  e.position_rms_m = std::sqrt(e.position_rms_m);
  e.position_sigma_rms_m = std::sqrt(e.position_sigma_rms_m);
  std::printf("%s: NEES per state: pose %.2f, velocity %.2f; NIS %.3f; position RMS %.3f m (stated %.3f)\n", name,
              e.pose.per_state(), e.velocity.per_state(), e.nis.per_state(), e.position_rms_m, e.position_sigma_rms_m);
  return e;
}

DriveSetup chain(const char* errors) {
  DriveSetup setup;
  setup.errors = errors;
  setup.filter.initial_velocity_sigma_m_s = 0.1;
  return setup;
}

/// A unit of 1 % scale factor and 10 mrad of misalignment.
DriveSetup coarse(std::vector<std::string> states) {
  DriveSetup setup;
  setup.sensor = "phidget_3_3_3";
  setup.filter.initial_attitude_sigma_deg_heading = 0.2;
  setup.filter.states = std::move(states);
  return setup;
}

/// The least number that a binomial variable of `n` tries at `p` each exceeds with at most the probability `above`.
int binomial_limit(int n, double p, double above) {
  double probability = std::pow(1.0 - p, n), below = probability;
  int k = 0;
  while (1.0 - below > above) {
    ++k;
    probability *= (n - k + 1.0) / k * p / (1.0 - p);
    below += probability;
  }
  return k;
}

/// Models that are those of the sensor. Of the quantities, each in a band of 95 %, one in twenty lies outside: their
/// number is held against the binomial law at 1 %, and each of them against a band of 99.9 %. Ensembles are apart;
/// within one, innovations are white, and the errors of pose and velocity at the end go together in part, which makes
/// several outside at once a little more likely than that.
TEST(FilterLoop, MatchedModelsAreAsFarOffAsTheySay) {
  DriveSetup coasting;
  coasting.last_fix_s = 30.0;
  const Ensemble all[] = {ensemble("white_only", chain("white_only"), 1),
                          ensemble("datasheet", chain("datasheet"), 1001),
                          ensemble("30 s without fixes", coasting, 2001),
                          ensemble("coarse unit, gains estimated", coarse({"biases", "gains"}), 3001)};
  int outside = 0, quantities = 0;
  for (const Ensemble& e : all)
    for (const auto& [what, mean, dof] :
         {std::tuple{"pose", e.pose, 6}, std::tuple{"velocity", e.velocity, 3}, std::tuple{"NIS", e.nis, 3}}) {
      const double value = mean.per_state() * dof;
      const Band band = fusion::mean_chi_square_band(dof, mean.count(), 0.05),
                 wide = fusion::mean_chi_square_band(dof, mean.count(), 1e-3);
      ++quantities;
      if (!band.contains(value)) {
        ++outside;
        std::printf("  %s, %s: %.3f outside %.3f .. %.3f\n", e.name, what, value / dof, band.low / dof,
                    band.high / dof);
      }
      EXPECT_TRUE(wide.contains(value)) << e.name << ", " << what << ": " << value / dof;
    }
  std::printf("%d of %d outside their 95 %% band\n", outside, quantities);
  EXPECT_LE(outside, binomial_limit(quantities, 0.05, 0.01));
}

/// The chain has errors that the filter has no state for; it is told of them as turn-on bias and misalignment.
TEST(FilterLoop, TheFullChainIsNearlyAsFarOffAsItSays) {
  const Ensemble e = ensemble("full", chain("full"), 1);
  for (const ConsistencyMean& mean : {e.pose, e.velocity, e.nis}) {
    EXPECT_GE(mean.per_state(), 0.7);
    EXPECT_LE(mean.per_state(), 1.5);
  }
}

/// With fixes withheld the estimate drifts.
TEST(FilterCoasting, DriftsWithoutFixes) {
  DriveSetup coasting;
  coasting.last_fix_s = 30.0;
  EXPECT_GT(ensemble("30 s without fixes", coasting, 1).position_rms_m,
            5.0 * ensemble("with fixes", {}, 1).position_rms_m);
}

/// Gain errors that the filter is not told of make it too confident, which is why it estimates them.
TEST(FilterGains, IgnoredScaleFactorsMakeItTooConfident) {
  const Ensemble ignored = ensemble("coarse unit, gains ignored", coarse({"biases"}), 3001);
  EXPECT_GT(ignored.pose.per_state(), fusion::mean_chi_square_band(6, kLoopRuns, 1e-4).high / 6);
}

}  // namespace
}  // namespace canyon
