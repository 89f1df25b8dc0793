#include "canyon/study/plan/replay/run_pair.h"

#include <algorithm>
#include <cstring>

#include "canyon/mission/run.h"
#include "canyon/study/plan/replay/replay.h"

namespace canyon::study {

namespace {

/// The rows that are compared, and no clouds.
class Rows final : public mission::Recorder {
 public:
  Status epoch(const mission::NavRow& row) override {
    nav.push_back(row);
    return Ok{};
  }
  Status gnss(const mission::GnssRow& row) override {
    fixes.push_back(row.fix);
    return Ok{};
  }
  std::vector<mission::NavRow> nav;
  std::vector<GnssFix> fixes;
};

/// The same bits, which undefined values may have too.
template <class Values>
bool same(const Values& a, const Values& b) {
  return std::memcmp(a.data(), b.data(), sizeof(typename Values::Scalar) * static_cast<std::size_t>(a.size())) == 0;
}
bool same(const Pose& a, const Pose& b) {
  return same(a.p, b.p) && same(a.R.coeffs(), b.R.coeffs());
}

bool same_command(const mission::NavRow& a, const mission::NavRow& b) {
  return a.command.speed_m_s == b.command.speed_m_s && a.command.curvature_1_m == b.command.curvature_1_m &&
         a.waypoint == b.waypoint && a.state == b.state;
}

bool same(const mission::NavRow& a, const mission::NavRow& b) {
  return a.t == b.t && same(a.X_WB_true, b.X_WB_true) && a.true_speed_m_s == b.true_speed_m_s &&
         same(a.estimate.X_WB, b.estimate.X_WB) && same(a.estimate.v_WB_W, b.estimate.v_WB_W) &&
         same(a.estimate.pose_covariance, b.estimate.pose_covariance) &&
         same(a.estimate.velocity_covariance_W, b.estimate.velocity_covariance_W) &&
         same(a.estimate.gyro_bias_U, b.estimate.gyro_bias_U) && same(a.estimate.accel_bias_U, b.estimate.accel_bias_U);
}

template <class Row, class Same>
void compare(const std::vector<Row>& a, const std::vector<Row>& b, const Same& equal, RunPair& pair) {
  const std::size_t both = std::min(a.size(), b.size()), all = std::max(a.size(), b.size());
  pair.epochs += static_cast<std::int64_t>(all);
  pair.violations += static_cast<std::int64_t>(all - both);
  for (std::size_t i = 0; i < both; ++i) pair.violations += equal(a[i], b[i]) ? 0 : 1;
}

}  // namespace

Result<RunPair> drive_pair(mission::MissionConfig config, const mission::PreparedMission& mission, const Tape& tape,
                           const mission::Omissions& omissions, double limit_s) {
  if (limit_s < tape.duration_s())
    config.time.limit_s = config.time.limit_s > 0.0 ? std::min(config.time.limit_s, limit_s) : limit_s;
  RunPair pair;
  Rows full, planned;
  CANYON_TRY(const auto whole,
             mission::run_mission(config, mission, nullptr, {.tape = &tape, .recorder = &full, .autonomy = nullptr}));
  CANYON_TRY(const auto less,
             mission::run_mission(mission::without(config, omissions), mission, nullptr,
                                  {.tape = &tape, .recorder = &planned, .autonomy = nullptr, .omissions = &omissions}));
  pair.simulated_s = whole.simulated_s;
  pair.full = whole.clock;
  pair.planned = less.clock;
  compare(
      full.nav, planned.nav,
      [&](const auto& a, const auto& b) { return same(a, b) && (omissions.autonomy || same_command(a, b)); }, pair);
  for (std::size_t i = 0; i < std::max(full.nav.size(), planned.nav.size()); ++i) {
    if (i < std::min(full.nav.size(), planned.nav.size()))
      pair.apart.push_back(
          {full.nav[i].t - mission.start, (full.nav[i].estimate.X_WB.p - planned.nav[i].estimate.X_WB.p).norm()});
    else
      pair.apart.push_back({kNaN, std::numeric_limits<double>::infinity()});
  }
  compare(
      full.fixes, planned.fixes, [](const GnssFix& a, const GnssFix& b) { return study::same(a, b); }, pair);
  return pair;
}

}  // namespace canyon::study
