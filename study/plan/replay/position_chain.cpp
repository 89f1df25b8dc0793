#include "canyon/study/plan/replay/position_chain.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/observers/fix_response.h"
#include "canyon/mission/run.h"

namespace canyon::study {

namespace {

/// Epochs of poorer geometry than this share of all are measured in full: they cost little and would set every bound.
constexpr double kShareLeftOut = 0.95;

/// What a run tells its filter, and the rows that it writes, in their order.
struct Event {
  GpsTime t;
  bool is_row = false;  ///< else a fix
  GnssFix fix{};
  double gain = 0.0;
};

struct Events final : mission::Recorder {
  std::vector<ImuSample> imu_samples;
  std::vector<Event> events;
  Status imu(const ImuSample& sample) override {
    imu_samples.push_back(sample);
    return Ok{};
  }
  Status gnss(const mission::GnssRow& row) override {
    // One that the filter takes its place from is accepted too, though it corrects nothing.
    if (row.update.accepted) events.push_back({row.fix.t, false, row.fix, row.range_gain});
    return Ok{};
  }
  Status epoch(const mission::NavRow& row) override {
    events.push_back({.t = row.t, .is_row = true});
    return Ok{};
  }
};

double rms_of(const std::vector<double>& values) {
  double square = 0.0;
  for (const double value : values) square += value * value;
  return values.empty() ? 0.0 : std::sqrt(square / static_cast<double>(values.size()));
}

struct Driven {
  mission::MissionConfig config;
  mission::RunRecord record;
  Events events;
};

/// The sensors and the filter alone: nobody looks, and nothing is mapped.
Status drive(const mission::PreparedMission& mission, const Tape& tape, Driven& run) {
  mission::Omissions unread;
  unread.registration = unread.maps = unread.keyframes = true;
  mission::MissionConfig config = run.config;
  config.autonomy.model.name = "route_follower";
  config.autonomy.map = mission::MapPose::kPrior;
  CANYON_TRY(run.record,
             mission::run_mission(mission::without(config, unread), mission, nullptr,
                                  {.tape = &tape, .recorder = &run.events, .autonomy = nullptr, .omissions = &unread}));
  return Ok{};
}

double most_gain_of(const std::vector<Driven>& runs) {
  std::vector<double> gains;
  for (const Driven& run : runs)
    for (const Event& event : run.events.events)
      if (!event.is_row && std::isfinite(event.gain)) gains.push_back(event.gain);
  if (gains.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(kShareLeftOut * static_cast<double>(gains.size() - 1));
  std::nth_element(gains.begin(), gains.begin() + at, gains.end());
  return gains[static_cast<std::size_t>(at)];
}

/// The run's filter once more, with what follows its fixes: raises the rows to what they are moved by.
void follow(const Events& given, double most_gain, const LocalFrame& frame, GpsTime start,
            fusion::ErrorStateFilter& filter, PositionChain& chain) {
  fusion::FixResponse response;
  filter.watch(&response);
  const Eigen::Vector3d up_E = frame.R_EW().col(2);
  auto sample = given.imu_samples.begin();
  std::size_t row = 0;
  for (const Event& event : given.events) {
    throw_if_cancelled();
    for (; sample != given.imu_samples.end() && sample->t - event.t < 0.5 * sample->dt_s; ++sample)
      filter.predict(*sample);
    if (!event.is_row) {
      response.expect(event.gain <= most_gain ? event.gain : 0.0);
      filter.update(event.fix);
      continue;
    }
    const auto moved = response.moved(filter.body_jacobian(), up_E);
    if (row == chain.t_s.size()) {
      chain.t_s.push_back(event.t - start);
      chain.any.push_back(0.0);
      chain.up.push_back(0.0);
    }
    chain.any[row] = std::max(chain.any[row], moved.any_m);
    chain.up[row] = std::max(chain.up[row], moved.up_m);
    ++row;
  }
}

}  // namespace

double PositionChain::rms() const {
  return rms_of(any);
}
double PositionChain::rms_up() const {
  return rms_of(up);
}

Result<PositionChain> position_chain(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                     const Tape& tape, int seeds) {
  std::vector<Driven> runs;
  PositionChain chain;
  for (int k = 0; k < seeds; ++k) {
    Driven run{.config = config, .record = {}, .events = {}};
    run.config.run.seed += k;
    CANYON_TRY_STATUS(drive(mission, tape, run));
    chain.seeds.push_back(run.config.run.seed);
    runs.push_back(std::move(run));
  }
  chain.most_gain = most_gain_of(runs);
  for (const Driven& run : runs) {
    CANYON_TRY(const auto noise, mission::noise_told_to_filter(run.config));
    const LocalFrame& frame = mission.scene->frame();
    fusion::ErrorStateFilter filter(config.fusion, noise, frame, config.imu.lever_arm_m, config.gnss.lever_arm_m);
    filter.initialize(mission.start, run.record.initial_X_WB, run.record.initial_v_WB_W);
    follow(run.events, chain.most_gain, frame, mission.start, filter, chain);
  }
  return chain;
}

}  // namespace canyon::study
