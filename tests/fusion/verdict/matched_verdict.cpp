#include "canyon/tests/fusion/verdict/matched_verdict.h"

#include <algorithm>
#include <regex>

#include "canyon/fusion/verdict/verdict.h"
#include "canyon/tests/fusion/matched_world.h"

namespace canyon::testing {
namespace {

constexpr int kDuration_s = 100;

/// The keys with one of them multiplied.
std::string with_factor(const WrongParameter& wrong, double factor) {
  std::string keys = matched_keys();
  if (wrong.key.empty()) return keys;
  if (!wrong.fallback.empty()) keys += wrong.fallback + "\n";
  const std::regex line("(^|\n)" + wrong.key + " = ([0-9.e-]+)");
  std::smatch found;
  CANYON_CHECK(std::regex_search(keys, found, line), wrong.key);
  return found.prefix().str() + "\n" + wrong.key + " = " + std::to_string(std::stod(found[2]) * factor) +
         found.suffix().str();
}

fusion::VerdictNumbers verdict_of_run(std::uint64_t seed, const std::string& keys, const ImuNoise& told) {
  using Record = fusion::ErrorRecord;
  MatchedWorld world(seed);
  fusion::ErrorStateFilter filter = world.filter(keys, told);
  fusion::PredictionAlone alone;
  alone.follow(filter);
  fusion::InnovationRecord innovations;
  Record errors(Record::navigation());
  fusion::StateRecord states;
  world.told = [&](const fusion::UpdateReport& report) { innovations.add(report); };
  for (int second = 0; second < kDuration_s; ++second) {
    for (int k = 0; k < 100; ++k) world.step(filter);
    const auto found = world.errors(filter);
    const Eigen::MatrixXd P = filter.covariance();
    const Eigen::Matrix3d R_EN = rotation_E_from_enu(geodetic_from_ecef(filter.nav_state().p_EU_E));
    const auto enu = [&](int at) { return (R_EN.transpose() * P.block<3, 3>(at, at) * R_EN).eval(); };
    const Vector3d p = -(R_EN.transpose() * found.at("p"));
    const GpsTime t = filter.nav_state().t;
    errors.add(Record::kAttitude, t, -found.at("theta") / kDegree, P.topLeftCorner<3, 3>() / (kDegree * kDegree));
    errors.add(Record::kPosition, t, p.head<2>(), enu(3).topLeftCorner<2, 2>());
    errors.add(Record::kHeight, t, p.tail<1>(), enu(3).bottomRightCorner<1, 1>());
    errors.add(Record::kVelocity, t, -(R_EN.transpose() * found.at("v")), enu(6));
    states.add(filter, alone);
  }
  return fusion::verdict_numbers({.innovations = &innovations, .errors = &errors, .fixes = nullptr, .states = &states});
}

}  // namespace

std::vector<WrongParameter> wrong_parameters() {
  const std::set<std::string> biases = {"gyro turn-on bias", "accel turn-on bias"};
  return {
      {"noise of the fixes' positions",
       "fix_sigma_scale",
       "fix_covariance = \"inflated\"\nfix_sigma_scale = 1.0",
       nullptr,
       {"position"}},
      {"noise of the fixes' velocities", "fix_velocity_scale", "fix_velocity_scale = 1.0", nullptr, {"velocity"}},
      {"white noise of the gyroscopes",
       "",
       "",
       [](ImuNoise& told, double factor) { told.gyro.white_per_sqrt_hz *= factor; },
       {"roll", "pitch", "yaw", "attitude"}},
      {"white noise of the accelerometers",
       "",
       "",
       [](ImuNoise& told, double factor) { told.accel.white_per_sqrt_hz *= factor; },
       {"east velocity", "north velocity", "vertical velocity"}},
      {"sigma of the biases", "", "",
       [](ImuNoise& told, double factor) {
         told.gyro.turn_on_bias_sigma *= factor;
         told.accel.turn_on_bias_sigma *= factor;
       },
       biases},
      {"noise of the odometer", "odometer_slip_percent", "", nullptr, {"odometer"}},
      {"sigma of the wheel's scale", "wheel_scale_sigma_percent", "", nullptr, {"wheel_scale"}},
      {"sigma of the fixes' lasting error", "fix_error_sigma_m", "", nullptr, {"fix_error", "position"}},
      {"correlation time of the fixes' lasting error", "fix_error_tau_s", "", nullptr, {"fix_error", "position"}},
      {"noise of the barometer", "barometer_sigma_m", "", nullptr, {"barometer"}},
      {"noise of the magnetometer", "magnetometer_sigma_ut", "", nullptr, {"magnetometer"}},
  };
}

std::set<std::string> faults_of_run(std::uint64_t seed, const WrongParameter* wrong, double factor) {
  ImuNoise told = matched_unit();
  if (wrong != nullptr && wrong->unit != nullptr) wrong->unit(told, factor);
  const std::string keys = wrong != nullptr ? with_factor(*wrong, factor) : matched_keys();
  std::set<std::string> out;
  for (const fusion::Finding& finding : fusion::findings(verdict_of_run(seed, keys, told)))
    if (finding.kind != fusion::Finding::Kind::kNotObserved) out.insert(finding.subject);
  return out;
}

bool names(const std::set<std::string>& faults, const WrongParameter& wrong) {
  return std::any_of(faults.begin(), faults.end(),
                     [&](const std::string& subject) { return wrong.subjects.count(subject) > 0; });
}

}  // namespace canyon::testing
