#include "canyon/study/plan/replay/position_chain.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/mission/run.h"

namespace canyon::study {

namespace {

/// Epochs of poorer geometry than this share of all are measured in full: they cost little and would set every bound.
constexpr double kShareLeftOut = 0.95;

struct Rows final : mission::Recorder {
  std::vector<ImuSample> imu_samples;
  std::vector<mission::GnssRow> fixes;
  Status imu(const ImuSample& sample) override {
    imu_samples.push_back(sample);
    return Ok{};
  }
  Status gnss(const mission::GnssRow& row) override {
    if (row.update.dimension > 0) fixes.push_back(row);
    return Ok{};
  }
};

double rms_of(const std::vector<double>& values) {
  double square = 0.0;
  for (const double value : values) square += value * value;
  return values.empty() ? 0.0 : std::sqrt(square / static_cast<double>(values.size()));
}

/// The sensors and the filter alone: nobody looks, and nothing is mapped.
Result<mission::RunRecord> drive(mission::MissionConfig config, const mission::PreparedMission& mission,
                                 const Tape& tape, Rows& rows) {
  mission::Omissions unread;
  unread.registration = unread.maps = unread.keyframes = true;
  config.autonomy.model.name = "route_follower";
  config.autonomy.map = mission::MapPose::kPrior;
  return mission::run_mission(mission::without(config, unread), mission, nullptr,
                              {.tape = &tape, .recorder = &rows, .autonomy = nullptr, .omissions = &unread});
}

double most_gain_of(const std::vector<mission::GnssRow>& fixes) {
  std::vector<double> gains;
  for (const mission::GnssRow& row : fixes)
    if (std::isfinite(row.range_gain)) gains.push_back(row.range_gain);
  if (gains.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(kShareLeftOut * static_cast<double>(gains.size() - 1));
  std::nth_element(gains.begin(), gains.begin() + at, gains.end());
  return gains[static_cast<std::size_t>(at)];
}

/// The run's filter once more, with what follows its fixes.
void follow(fusion::ErrorStateFilter& filter, const LocalFrame& frame, GpsTime start, const Rows& rows,
            PositionChain& chain) {
  fusion::FixResponse response;
  filter.watch(&response);
  const Eigen::Vector3d up_E = frame.R_EW().col(2);
  const auto moved = [&] { return response.moved(filter.body_jacobian(), up_E); };
  auto sample = rows.imu_samples.begin();
  for (const mission::GnssRow& row : rows.fixes) {
    throw_if_cancelled();
    for (; sample != rows.imu_samples.end() && sample->t - row.fix.t < 0.5 * sample->dt_s; ++sample)
      filter.predict(*sample);
    if (!chain.any.empty()) {
      const auto before = moved();
      chain.any.back() = std::max(chain.any.back(), before.any_m);
      chain.up.back() = std::max(chain.up.back(), before.up_m);
    }
    const double gain = row.range_gain <= chain.most_gain ? row.range_gain : 0.0;
    response.expect(gain);
    filter.update(row.fix);
    const auto after = moved();
    chain.fix_t_s.push_back(row.fix.t - start);
    chain.fix.push_back(gain);
    chain.any.push_back(after.any_m);
    chain.up.push_back(after.up_m);
  }
}

}  // namespace

double PositionChain::rms() const {
  return rms_of(any);
}
double PositionChain::rms_up() const {
  return rms_of(up);
}

double PositionChain::most_after(double t_s) const {
  const auto next = std::upper_bound(fix_t_s.begin(), fix_t_s.end(), t_s + 1e-6);
  return next == fix_t_s.begin() ? 0.0 : any[static_cast<std::size_t>(next - fix_t_s.begin() - 1)];
}

Result<PositionChain> position_chain(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                     const Tape& tape) {
  Rows rows;
  CANYON_TRY(const auto record, drive(config, mission, tape, rows));
  CANYON_TRY(const auto noise, mission::noise_told_to_filter(config));
  PositionChain chain;
  chain.most_gain = most_gain_of(rows.fixes);
  fusion::ErrorStateFilter filter(config.fusion, noise, mission.scene->frame(), config.imu.lever_arm_m,
                                  config.gnss.lever_arm_m);
  filter.initialize(mission.start, record.initial_X_WB, record.initial_v_WB_W);
  follow(filter, mission.scene->frame(), mission.start, rows, chain);
  return chain;
}

}  // namespace canyon::study
