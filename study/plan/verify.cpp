#include "canyon/study/plan/verify.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "canyon/core/math/median.h"
#include "canyon/core/process/progress.h"
#include "canyon/gnss/paths/need/path_question.h"
#include "canyon/study/plan/replay/replay.h"
#include "canyon/study/plan/replay/run_pair.h"
#include "canyon/study/plan/replay/tape_pieces.h"
#include "canyon/study/plan/verify_ranges.h"

namespace canyon::study {

namespace {

constexpr const char* kAllPaths = "all of these together";
constexpr const char* kUnread = "what nobody reads, together";

/// The effects of places that the plan leaves out somewhere, and all of them at once.
std::vector<std::string> effects_of_places(const Plan& plan) {
  std::vector<std::string> names;
  for (const PlannedEffect& line : plan.effects) {
    const bool known = std::find(names.begin(), names.end(), line.need.effect) != names.end();
    if (!line.whole_run() && line.need.verdict == Verdict::kNotNeeded && !known) names.push_back(line.need.effect);
  }
  if (names.size() > 1) names.emplace_back(kAllPaths);
  return names;
}

/// The largest that the plan's lines promise of an effect; of all of them together, their sum.
double bound_of(const Plan& plan, const std::string& effect) {
  std::map<std::string, double> bounds;
  for (const PlannedEffect& line : plan.effects)
    if (!line.whole_run() && line.need.verdict == Verdict::kNotNeeded &&
        (effect == kAllPaths || line.need.effect == effect))
      bounds[line.need.effect] = std::max(bounds[line.need.effect], line.need.bound);
  double sum = 0.0;
  for (const auto& [name, bound] : bounds) sum += bound;
  return sum;
}

Result<VerifiedEffect> verify_place_effect(GnssReplay& replay, const Plan& plan, const std::string& effect,
                                           const std::vector<gnss::GnssOutput>& full) {
  VerifiedEffect found{.effect = effect, .bound = bound_of(plan, effect)};
  const auto& corridor = plan.omissions.corridor;
  CANYON_TRY(const auto sensor, replay.sensor());
  for (std::size_t k = 0; k < full.size(); ++k) {
    throw_if_cancelled();
    const GnssReplay::Epoch& epoch = replay.epochs()[k];
    gnss::PathOmissions leave_out;
    if (epoch.place < corridor.size()) {
      const gnss::PathOmissions& all = corridor[epoch.place].paths;
      leave_out = effect == kAllPaths ? all : only(effect.c_str(), all);
    }
    const gnss::GnssOutput output = replay.measure(*sensor, epoch, leave_out);
    ++found.replayed;
    if (leave_out == gnss::PathOmissions{}) continue;
    ++found.epochs;
    const double difference = difference_m(full[k], output);
    found.violations += difference > found.bound ? 1 : 0;
    found.largest_difference = std::max(found.largest_difference, difference);
  }
  return found;
}

Status verify_places(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
                     const Plan& plan, std::int64_t epochs, Verification& verification) {
  const std::vector<std::string> effects = effects_of_places(plan);
  if (effects.empty() || plan.omissions.corridor.empty()) return Ok{};
  GnssReplay replay(config, mission, tape, plan.omissions, epochs);
  CANYON_TRY(const auto sensor, replay.sensor());
  std::vector<gnss::GnssOutput> full;
  for (const GnssReplay::Epoch& epoch : replay.epochs()) {
    throw_if_cancelled();
    full.push_back(replay.measure(*sensor, epoch, {}));
  }
  for (const std::string& effect : effects) {
    CANYON_TRY(VerifiedEffect found, verify_place_effect(replay, plan, effect, full));
    verification.effects.push_back(std::move(found));
  }
  return Ok{};
}

Status verify_unread(mission::MissionConfig config, const mission::PreparedMission& mission, const Tape& tape,
                     const Plan& plan, std::int64_t epochs, Verification& verification) {
  mission::Omissions unread = plan.omissions;
  if (!unread.unkept_rays) unread.corridor.clear();
  for (mission::PlannedPlace& place : unread.corridor) place.paths = {};
  if (unread.ranges.bound_m > 0.0) unread.ranges = {};
  unread.strapdown = {};
  if (!unread.any()) return Ok{};
  VerifiedEffect found{.effect = kUnread, .kind = Verified::kReaders};
  config.time.limit_s = 0.0;  // a piece is as long as it is
  for (std::int64_t before = -1; found.epochs < epochs && found.epochs > before;) {
    before = found.epochs;
    const double rows_s = config.run.epoch_rate_hz + config.gnss.rate_hz;
    for (const Tape& piece : spread_pieces(tape, static_cast<double>(epochs - found.epochs) / rows_s + 1.0)) {
      throw_if_cancelled();
      CANYON_TRY(const RunPair pair, drive_pair(config, mission, piece, unread));
      found.epochs += pair.epochs;
      found.violations += pair.violations;
      ++config.run.seed;
    }
  }
  found.replayed = found.epochs;
  if (found.violations > 0) found.largest_difference = kNaN;
  verification.effects.push_back(std::move(found));
  return Ok{};
}

}  // namespace

const char* name(Verified kind) {
  switch (kind) {
    case Verified::kPlaces:
      return "places";
    case Verified::kRanges:
      return "ranges";
    case Verified::kEstimates:
      return "estimates";
    case Verified::kReaders:
      break;
  }
  return "readers";
}

std::int64_t Verification::epochs(Verified kind) const {
  std::int64_t most = 0;
  for (const VerifiedEffect& effect : effects)
    if (effect.kind == kind) most = std::max(most, effect.epochs);
  return most;
}

std::int64_t Verification::epochs() const {
  return std::max(epochs(Verified::kPlaces), epochs(Verified::kRanges)) + epochs(Verified::kEstimates) +
         epochs(Verified::kReaders);
}

std::int64_t Verification::violations() const {
  std::int64_t sum = 0;
  for (const VerifiedEffect& effect : effects) sum += effect.violations;
  return sum;
}

double Verification::tightness(bool of_position) const {
  std::vector<double> ratios;
  for (const VerifiedEffect& effect : effects)
    if (effect.of_position == of_position && effect.bound > 0.0 && effect.largest_difference > 0.0)
      ratios.push_back(effect.bound / effect.largest_difference);
  return ratios.empty() ? kNaN : median(std::move(ratios));
}

Result<Verification> verify_plan(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                 const Tape& tape, const Plan& plan, std::int64_t epochs) {
  Verification verification;
  CANYON_TRY_STATUS(verify_unread(config, mission, tape, plan, epochs, verification));
  CANYON_TRY_STATUS(verify_places(config, mission, tape, plan, epochs, verification));
  CANYON_TRY_STATUS(verify_ranges(config, mission, tape, plan, epochs, verification));
  return verification;
}

}  // namespace canyon::study
