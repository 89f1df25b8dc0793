#include "canyon/study/plan/tolerated.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>

#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/progress.h"
#include "canyon/fusion/strapdown.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/mission/route_tape.h"
#include "canyon/study/plan/replay/position_chain.h"
#include "canyon/study/plan/replay/replay.h"

namespace canyon::study {

namespace {

constexpr std::int64_t kToleratedEpochs = 200;  // that a saving is measured at
constexpr int kRepeats = 3;                     // of which the fastest counts

/// What leaving out an effect moves the rows of a run by: `times` these.
struct Moves {
  const std::vector<double>&any, &up;
  double times;
};
Moves moves_of(const PositionChain& chain, const Need& need) {
  for (const PositionChain::Strapdown& of_steps : chain.strapdown)
    if (of_steps.need.effect == need.effect) return {of_steps.any, of_steps.up, 1.0};
  return {chain.any, chain.up, need.bound};
}

double most(const Moves& moves) {
  return moves.any.empty() ? 0.0 : moves.times * *std::max_element(moves.any.begin(), moves.any.end());
}
double rms(const Moves& moves) {
  return moves.times * rms_of(moves.any);
}
double rms_up(const Moves& moves) {
  return moves.times * rms_of(moves.up);
}

/// Figures of the estimate's error, and what moves them at most where the estimate is moved: an RMS by the RMS of the
/// moves, the largest error and a percentile by the largest of them.
struct Reached {
  const char* figure;
  double (*moved)(const Moves&);
};
constexpr Reached kReached[] = {
    {"position_error_rms_m", rms},       {"position_error_e_rms_m", rms}, {"position_error_n_rms_m", rms},
    {"position_error_up_rms_m", rms_up}, {"position_error_p95_m", most},  {"position_error_max_m", most},
};

const Reached* reached(const std::string& figure) {
  for (const Reached& row : kReached)
    if (figure == row.figure) return &row;
  return nullptr;
}

template <class... Values>
std::string text(const char* format, Values... values) {
  char out[200];
  std::snprintf(out, sizeof out, format, values...);
  return out;
}

/// CPU time and counted work of all epochs of the replay without these delays.
struct Cost {
  double cpu_s = std::numeric_limits<double>::infinity();
  std::int64_t work = 0;
};
Result<Cost> cost_of(GnssReplay& replay, const gnss::DelayOmissions& leave_out) {
  Cost cost;
  for (int k = 0; k < kRepeats; ++k) {
    throw_if_cancelled();
    CANYON_TRY(const auto sensor, replay.sensor());
    sensor->leave_out(gnss::RangeOmissions{.delays = leave_out});
    CpuAccount account;
    {
      const ChargeCpu charge(&account);
      for (const auto& epoch : replay.epochs()) replay.measure(*sensor, epoch, {});
    }
    cost.cpu_s = std::min(cost.cpu_s, account.seconds());
    cost.work = sensor->counters().delays_computed;
  }
  return cost;
}

/// What leaving out each saves: work at the replayed epochs, which decides, and CPU time over the nominal mission.
Status measure(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
               std::vector<PlannedEffect>& candidates) {
  GnssReplay replay(config, mission, tape, {}, kToleratedEpochs);
  const double times = mission.nominal_s * config.gnss.rate_hz / static_cast<double>(kToleratedEpochs);
  CANYON_TRY(const Cost full, cost_of(replay, {}));
  for (PlannedEffect& candidate : candidates) {
    CANYON_TRY(const Cost less, cost_of(replay, gnss::delays_of({candidate.need})));
    candidate.saved_work = full.work - less.work;
    candidate.saved_cpu_s = std::max(0.0, times * (full.cpu_s - less.cpu_s));
  }
  return Ok{};
}

/// The figure that does not allow this much more, or of which nothing is known; null: all do.
const char* exceeded(const Plan& plan, const PlannedEffect& candidate) {
  for (const auto& [figure, tolerance] : plan.tolerances) {
    const auto so_far = plan.figure_bounds.find(figure);
    const double sum = (so_far == plan.figure_bounds.end() ? 0.0 : so_far->second) + candidate.moves.at(figure);
    if (!(sum <= tolerance)) return reached(figure)->figure;
  }
  return nullptr;
}

/// Of the kinds of bounds that there are, in words.
std::string moved(const Need& need) {
  return text(need.bound_unit == "m" ? "moves a range by up to %.2g m" : "turns the attitude by up to %.2g deg/h",
              need.bound);
}

void keep(PlannedEffect& effect, const std::string& why) {
  effect.need.verdict = Verdict::kNeeded;
  effect.need.reason = moved(effect.need) + why + "; " + effect.need.reason;
  effect.saved_cpu_s = kNaN;
}

/// Why no tolerance bounds what comes of a moved estimate; empty: they do.
std::string beyond_tolerances(const Plan& plan, bool open_loop) {
  if (!open_loop) return "undecidable in a closed loop: what is believed of the position moves the vehicle";
  for (const Output output : plan.outputs)
    if (output != Output::kPosition)
      return std::string("and nothing bounds what --for ") + name(output) + " makes of a moved estimate";
  return {};
}

}  // namespace

Status check_reached(const FigureValues& tolerances, const std::string& option) {
  for (const auto& [figure, tolerance] : tolerances) {
    if (reached(figure) != nullptr) continue;
    std::string known;
    for (const Reached& row : kReached) known += (known.empty() ? "" : ", ") + std::string(row.figure);
    return Error{.file = option,
                 .key = figure,
                 .what = "no bound reaches this figure, so nothing could be left out for it",
                 .expected = "one of " + known};
  }
  return Ok{};
}

void choose_within_tolerances(const PositionChain& chain, std::vector<PlannedEffect>& candidates, Plan& plan) {
  // By counted work, so that the same mission has the same plan each time. Of equal savings per bound the smaller bound
  // first.
  const auto per_move = [&](const PlannedEffect& candidate) {
    const double most_m = most(moves_of(chain, candidate.need));
    return most_m > 0.0 ? static_cast<double>(candidate.saved_work) / most_m : 0.0;
  };
  std::stable_sort(candidates.begin(), candidates.end(), [&](const PlannedEffect& a, const PlannedEffect& b) {
    const double of_a = per_move(a), of_b = per_move(b);
    return of_a != of_b ? of_a > of_b : a.need.bound < b.need.bound;
  });
  std::vector<Need> chosen;
  gnss::RangeOmissions& ranges = plan.omissions.ranges;
  for (PlannedEffect& candidate : candidates) {
    for (const auto& [figure, tolerance] : plan.tolerances)
      candidate.moves[figure] = reached(figure)->moved(moves_of(chain, candidate.need));
    if (candidate.saved_work <= 0) {
      keep(candidate, ", and leaving it out saves no work");
      continue;
    }
    if (const char* figure = exceeded(plan, candidate)) {
      keep(candidate, text(", %s by %.2g: more than is left of the tolerance", figure, candidate.moves.at(figure)));
      continue;
    }
    for (const auto& [figure, move] : candidate.moves) plan.figure_bounds[figure] += move;
    const Moves moves = moves_of(chain, candidate.need);
    plan.epoch_bound_m.resize(moves.any.size(), 0.0);
    for (std::size_t i = 0; i < moves.any.size(); ++i) plan.epoch_bound_m[i] += moves.times * moves.any[i];
    if (&moves.any == &chain.any) ranges.bound_m += candidate.need.bound;
    chosen.push_back(candidate.need);
  }
  if (chosen.empty()) return;
  ranges.delays = ranges.delays | gnss::delays_of(chosen);
  if (ranges.bound_m > 0.0) ranges.most_gain = chain.most_gain;
  plan.omissions.strapdown = fusion::strapdown_omissions_of(chosen);
  plan.epoch_t_s = chain.t_s;
  plan.seeds = chain.seeds;
}

namespace {

/// What fusion::FixResponse follows: estimates linear in the positions of the fixes, corrected beside them by nothing
/// but what the replay of the filter has, which is the IMU.
bool answers_to_positions_alone(const fusion::FilterConfig& filter) {
  const std::vector<std::string> measurements = fusion::filter_parts(filter).measurements;
  return fusion::takes_all(filter) && std::all_of(measurements.begin(), measurements.end(), [](const std::string& row) {
           return row == "position" || row == "non_holonomic";
         });
}

/// Why nothing that acts can be held against the tolerances, if there are any; empty: it can.
std::string undecided(const fusion::FilterConfig& filter, const Plan& plan, bool open_loop) {
  if (!answers_to_positions_alone(filter))
    return "the filter measures with more than the fixes' positions, or decides what it makes of each";
  return plan.tolerances.empty() ? "" : beyond_tolerances(plan, open_loop);
}

std::span<const fusion::StrapdownEffect> strapdown_effects(const fusion::FilterConfig& filter) {
  const auto& row = model_row(fusion::strapdown_models(), filter.integrator);
  return row.make.effects != nullptr ? row.make.effects() : std::span<const fusion::StrapdownEffect>{};
}

/// What the filter's integrator can leave out. What it saves is a term in each step, over as many epochs as the savings
/// of delays are counted at; nothing that a clock shows (docs/plan.md).
void add_strapdown(const mission::MissionConfig& config, const PositionChain& chain,
                   std::vector<PlannedEffect>& candidates) {
  const auto steps =
      static_cast<std::int64_t>(static_cast<double>(kToleratedEpochs) * config.imu.rate_hz / config.gnss.rate_hz);
  for (const PositionChain::Strapdown& effect : chain.strapdown)
    candidates.push_back(
        {.need = effect.need, .segment = "whole run", .saved_work = chain.steps > 0 ? steps : 0, .saved_cpu_s = 0.0});
}

}  // namespace

Status leave_out_tolerated(const std::vector<Need>& needs, const mission::MissionConfig& config,
                           const mission::PreparedMission& mission, bool open_loop, Plan& plan) {
  std::vector<PlannedEffect> candidates, lines;
  const std::string why_not = undecided(config.fusion, plan, open_loop);
  for (const Need& need : needs) {
    PlannedEffect line{.need = need, .segment = "whole run"};
    const bool acts = line.need.verdict == Verdict::kNotNeeded && need.bound > 0.0;
    if (acts && !why_not.empty()) {
      line.need.verdict = Verdict::kUndecidable;
      line.need.reason = moved(need) + ", " + why_not;
    }
    const bool left_out = line.need.verdict == Verdict::kNotNeeded, free = left_out && need.bound <= 0.0;
    if (free) plan.omissions.ranges.delays = plan.omissions.ranges.delays | gnss::delays_of({line.need});
    if (left_out && !free && plan.tolerances.empty()) keep(line, ", and no tolerance is given");
    const bool candidate = left_out && !free && !plan.tolerances.empty();
    (candidate ? candidates : lines).push_back(std::move(line));
  }
  if (!plan.tolerances.empty() && why_not.empty()) {
    CANYON_TRY(const Tape tape, mission::drive_route(config, mission));
    CANYON_TRY(const PositionChain chain, position_chain(config, mission, tape));
    CANYON_TRY_STATUS(measure(config, mission, tape, candidates));
    add_strapdown(config, chain, candidates);
    choose_within_tolerances(chain, candidates, plan);
    if (plan.omissions.moves()) plan.tape_hash = tape_hash(tape);
  } else {
    for (const fusion::StrapdownEffect& effect : strapdown_effects(config.fusion))
      lines.push_back(
          {.need = {.effect = effect.name,
                    .reason = why_not.empty() ? "known along a tape alone, and no tolerance is given" : why_not},
           .segment = "whole run"});
  }
  for (PlannedEffect& line : lines) plan.effects.push_back(std::move(line));
  for (PlannedEffect& line : candidates) plan.effects.push_back(std::move(line));
  return Ok{};
}

}  // namespace canyon::study
