// A receiver by itself among tall buildings, its ranges filtered one by one: Berlin, Potsdamer Platz (smartLoc), GPS
// and GLONASS.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "canyon/core/config/config.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/timeline/filter_timeline.h"
#include "canyon/gnss/single_point/recorded_data.h"
#include "canyon/gnss/single_point/single_point.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::study {
namespace {

struct TruePoint {
  GpsTime t;
  Eigen::Vector3d p_E;
};

/// Lines "point3 seconds x y z ...", counted from 126641.7 s of week 1900 (the data's MANIFEST).
std::vector<TruePoint> read_truth(const std::string& path) {
  std::vector<TruePoint> out;
  std::ifstream in(path);
  std::string line, word;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    double t_s = 0.0;
    TruePoint point;
    if (!(fields >> word >> t_s >> point.p_E.x() >> point.p_E.y() >> point.p_E.z())) continue;
    point.t = GpsTime::from_week_sow(1900, 126641.7 + t_s);
    out.push_back(point);
  }
  return out;
}

double horizontal_m(const Eigen::Vector3d& p_E, const Eigen::Vector3d& truth_E) {
  return (rotation_E_from_enu(geodetic_from_ecef(truth_E)).transpose() * (p_E - truth_E)).head<2>().norm();
}

/// Of all instants of the truth, those without a position as 1 km off.
struct Errors {
  double median_m = 0.0, p95_m = 0.0;
  int missing = 0;
};
Errors errors_of(std::vector<double> off_m) {
  Errors out;
  for (double& e : off_m) {
    if (std::isfinite(e)) continue;
    ++out.missing;
    e = 1e3;
  }
  std::sort(off_m.begin(), off_m.end());
  out.median_m = off_m[off_m.size() / 2];
  out.p95_m = off_m[static_cast<std::size_t>(0.95 * static_cast<double>(off_m.size()))];
  return out;
}

/// A car: 1 m/s^2 in a second, in any direction.
ImuNoise car() {
  ImuNoise n;
  n.accel.white_per_sqrt_hz = 1.0;
  return n;
}

/// Epochs of the same observations: solved each by itself, and by the receiver's own Kalman filter, which corrects the
/// ranges of those too that have no position of their own.
struct Solved {
  gnss::SinglePointResult alone, kalman;
};

Errors filtered(const Solved& solved, const std::vector<TruePoint>& truth, const std::string& keys) {
  const auto first = std::find_if(solved.alone.epochs.begin(), solved.alone.epochs.end(),
                                  [](const auto& e) { return e.fix.status != FixStatus::kNone; });
  const LocalFrame frame(geodetic_from_ecef(first->fix.p_A_E));
  fusion::ErrorStateFilter filter(
      fusion::configured("initial_position_sigma_m = 30\ninitial_velocity_sigma_m_s = 5\n"
                         "initial_attitude_sigma_deg_roll_pitch = 1e-6\ninitial_attitude_sigma_deg_heading = 1e-6\n" +
                         keys),
      car(), frame, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  filter.initialize(first->fix.t, Pose{}, Eigen::Vector3d::Zero());
  fusion::FilterTimeline timeline(filter, {});
  std::vector<double> off_m;
  auto at = truth.begin();
  const auto note = [&](const TruePoint& point) {
    off_m.push_back(horizontal_m(timeline.filter().nav_state().p_EU_E, point.p_E));
  };
  for (; at != truth.end() && first->fix.t - at->t > 0.05; ++at) off_m.push_back(kNaN);
  for (auto i = static_cast<std::size_t>(first - solved.alone.epochs.begin()); i < solved.kalman.epochs.size(); ++i) {
    const auto& epoch = solved.kalman.epochs[i];
    const GpsTime t = epoch.fix.t;
    for (; at != truth.end() && t - at->t > 0.05; ++at) {
      timeline.coast(at->t);
      note(*at);
    }
    timeline.coast(t);
    timeline.add(fusion::AidingMessage(epoch.epoch));
    timeline.add(fusion::AidingMessage(solved.alone.epochs[i].fix));
    for (; at != truth.end() && std::abs(at->t - t) <= 0.05; ++at) note(*at);
  }
  for (; at != truth.end(); ++at) off_m.push_back(kNaN);
  return errors_of(off_m);
}

Errors of_fixes(const gnss::SinglePointResult& solved, const std::vector<TruePoint>& truth) {
  std::vector<double> off_m;
  for (const TruePoint& point : truth) {
    double off = kNaN;
    for (const auto& e : solved.epochs)
      if (std::abs(e.fix.t - point.t) < 0.05 && e.fix.status != FixStatus::kNone)
        off = horizontal_m(e.fix.p_A_E, point.p_E);
    off_m.push_back(off);
  }
  return errors_of(off_m);
}

/// What 12 m (median) and 40 m (95 %) are asked of. The median is missed: the lasting errors' sizes are those of
/// simulated streets (range_errors.h), fixed before this drive was looked at, and the echoes of Potsdamer Platz are
/// later: 33 m in the median where streets of the built-in kind give 11 m (docs/fusion.md).
TEST(UrbanRanges, EveryInstantHasAPositionInBerlin) {
  CANYON_REAL_DATA(observations, "gnss/urban_berlin/Berlin_Potsdamer_Platz.obs.gz");
  CANYON_REAL_DATA(gps, "gnss/urban_berlin/brdc1580.16n");
  CANYON_REAL_DATA(glonass, "gnss/urban_berlin/brdc1580.16g");
  CANYON_REAL_DATA(truth_file, "gnss/urban_berlin/Berlin_Potsdamer_Platz_GT.txt");
  const std::vector<TruePoint> truth = read_truth(truth_file);
  gnss::SinglePointConfig config;
  config.systems = "GR";
  config.smoothing_s = 0.0;  // what a reflection adds would last
  const auto data = gnss::read_recorded_data(
      {.observations = observations, .navigation = {gps, glonass}, .sp3 = {}, .antex = {}, .ionex = {}}, config);
  ASSERT_TRUE(data.ok()) << data.error().str();
  const auto solve = [&](const char* estimator) {
    gnss::SinglePointConfig c = config;
    const auto node = ConfigNode::parse(std::string("estimator = \"") + estimator + "\"", "test");
    EXPECT_TRUE(read_config(&*node, "", c).ok());
    return gnss::solve_observations(data->observations, data->inputs(), c);
  };
  const auto alone = solve("least_squares"), kalman = solve("kalman");
  ASSERT_TRUE(alone.ok()) << alone.error().str();
  ASSERT_TRUE(kalman.ok()) << kalman.error().str();
  const Solved solved{*alone, *kalman};

  const auto print = [&](const char* what, const Errors& e) {
    std::printf("%-44s median %.1f m, 95 %% %.1f m, %d of %zu missing\n", what, e.median_m, e.p95_m, e.missing,
                truth.size());
    return e;
  };
  const Errors single = print("single point", of_fixes(solved.alone, truth));
  const Errors receiver = print("receiver's own Kalman filter", of_fixes(solved.kalman, truth));
  const auto with = [&](const char* what, const std::string& keys) {
    return print(what, filtered(solved, truth, keys));
  };
  const Errors loose = with("loosely",
                            "measurements = [\"position\"]\nstates = [\"fix_error\"]\nacceptance = \"student_t\"\n"
                            "fix_error_sigma_m = 3\nfix_error_scale = 0\nfix_error_tau_s = 10");
  const std::string ranges = "measurements = [\"ranges\"]\nacceptance = ",
                    clock = "states = [\"receiver_clock\"]\n" + ranges,
                    lasting = "states = [\"receiver_clock\", \"range_errors\"]\n" + ranges;
  const Errors as_white = with("ranges, errors as white, accept_all", clock + "\"accept_all\"");
  with("ranges, errors as white, student_t", clock + "\"student_t\"");
  with("ranges, errors that last, accept_all", lasting + "\"accept_all\"");
  with("ranges, errors that last, gate of 3 sigma", lasting + "\"gate\"\ngate_sigma = 3.0");
  const Errors tight = with("ranges, errors that last, student_t", lasting + "\"student_t\"");
  EXPECT_GT(single.missing, 0);
  EXPECT_EQ(tight.missing, 0);
  EXPECT_LT(tight.p95_m, 40.0);
  for (const Errors& other : {single, receiver, loose, as_white}) {
    EXPECT_LT(tight.median_m, other.median_m);
    EXPECT_LT(tight.p95_m, other.p95_m);
  }
}

}  // namespace
}  // namespace canyon::study
