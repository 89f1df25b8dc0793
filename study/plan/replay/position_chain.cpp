#include "canyon/study/plan/replay/position_chain.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/observers/fix_response.h"
#include "canyon/fusion/observers/step_response.h"
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

/// What the integrator's effects do, step by step and row by row.
class StrapdownChain {
 public:
  StrapdownChain(std::span<const fusion::StrapdownEffect> effects, const Eigen::Vector3d& up_E)
      : effects_(effects), up_E_(up_E), turned_rad_(effects.size(), 0.0), any_m_(effects.size(), 0.0), up_m_(any_m_) {}

  /// Before the filter takes the sample.
  void expect(const fusion::ErrorStateFilter& filter, const ImuSample& sample) {
    const fusion::Increments now = filter.calibration().apply(sample.dt_s, sample.dtheta_U, sample.dv_U);
    const fusion::StrapdownStep step{.dt_s = now.dt_s,
                                     .dt_before_s = before_.dt_s,
                                     .dtheta_U = now.dtheta_U,
                                     .dv_U = now.dv_U,
                                     .dtheta_before_U = before_.dtheta_U,
                                     .dv_before_U = before_.dv_U,
                                     .R_EU = filter.nav_state().R_EU.toRotationMatrix(),
                                     .v_EU_E = filter.nav_state().v_EU_E};
    std::vector<fusion::StepMove> moves;
    for (std::size_t i = 0; i < effects_.size(); ++i) {
      moves.push_back(effects_[i].of_step(step));
      turned_rad_[i] += moves.back().theta_U.norm();
    }
    response.expect(std::move(moves));
    before_ = now;
    time_s_ += now.dt_s;
  }
  /// Raises the row to what it is moved by.
  void row(const fusion::ErrorStateFilter& filter, std::size_t row, PositionChain& chain) {
    for (std::size_t i = 0; i < effects_.size(); ++i) {
      const Eigen::Vector3d moved_E = response.moved_E(i, filter.body_jacobian());
      const Eigen::Matrix3d by_chance_E = response.by_chance_E(i, filter.body_jacobian());
      const double up_by_chance_m2 = up_E_.dot(by_chance_E * up_E_);
      any_m_[i] = std::max(any_m_[i], moved_E.norm());
      up_m_[i] = std::max(up_m_[i], std::abs(up_E_.dot(moved_E)));
      PositionChain::Strapdown& all = chain.strapdown[i];
      if (row == all.any.size()) {
        all.any.push_back(0.0);
        all.up.push_back(0.0);
      }
      all.any[row] = std::max(all.any[row], kMargin * any_m_[i] + kChance * std::sqrt(by_chance_E.trace()));
      all.up[row] = std::max(all.up[row], kMargin * up_m_[i] + kChance * std::sqrt(up_by_chance_m2));
    }
  }
  void finish(const ImuNoise& noise, PositionChain& chain) const {
    for (std::size_t i = 0; i < effects_.size(); ++i) {
      PositionChain::Strapdown& all = chain.strapdown[i];
      if (turned_rad_[i] < all.turned_rad) continue;
      all.turned_rad = turned_rad_[i];
      all.need = fusion::strapdown_need(effects_[i], turned_rad_[i], time_s_, noise);
    }
  }

  fusion::StepResponse response;

 private:
  static constexpr double kMargin = 2.0;
  static constexpr double kChance = 5.0;  // sigmas: one row in a million

  std::span<const fusion::StrapdownEffect> effects_;
  Eigen::Vector3d up_E_;
  fusion::Increments before_;
  double time_s_ = 0.0;
  std::vector<double> turned_rad_, any_m_, up_m_;
};

/// The run's filter once more, with what its integrator could leave out. A watcher of its own, so another filter.
void follow_steps(const Events& given, const LocalFrame& frame, fusion::ErrorStateFilter& filter,
                  std::span<const fusion::StrapdownEffect> effects, const ImuNoise& noise, PositionChain& chain) {
  StrapdownChain steps(effects, frame.R_EW().col(2));
  chain.strapdown.resize(effects.size());
  filter.watch(&steps.response);
  auto sample = given.imu_samples.begin();
  std::size_t row = 0;
  for (const Event& event : given.events) {
    throw_if_cancelled();
    for (; sample != given.imu_samples.end() && sample->t - event.t < 0.5 * sample->dt_s; ++sample) {
      steps.expect(filter, *sample);
      filter.predict(*sample);
    }
    if (event.is_row)
      steps.row(filter, row++, chain);
    else
      filter.update(event.fix);
  }
  steps.finish(noise, chain);
}

}  // namespace

double rms_of(const std::vector<double>& values) {
  double square = 0.0;
  for (const double value : values) square += value * value;
  return values.empty() ? 0.0 : std::sqrt(square / static_cast<double>(values.size()));
}

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
    fusion::ErrorStateFilter once_more = filter;
    follow(run.events, chain.most_gain, frame, mission.start, filter, chain);
    chain.steps = std::max(chain.steps, static_cast<std::int64_t>(run.events.imu_samples.size()));
    const auto& integrator = model_row(fusion::strapdown_models(), config.fusion.integrator);
    if (integrator.make.effects != nullptr)
      follow_steps(run.events, frame, once_more, integrator.make.effects(), noise, chain);
  }
  return chain;
}

}  // namespace canyon::study
