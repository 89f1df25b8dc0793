#include "canyon/study/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "canyon/core/process/progress.h"
#include "canyon/gnss/sensor/sensor_need.h"
#include "canyon/study/plan/corridor.h"
#include "canyon/study/plan/readers.h"
#include "canyon/study/plan/tolerated.h"

namespace canyon::study {

namespace {

std::string stretch(double start_m, double end_m) {
  char text[48];
  std::snprintf(text, sizeof text, "%.0f-%.0f m", start_m, end_m);
  return text;
}

/// Neighbouring pieces of which the same was found are one line; the reason is that of the first.
void add_piece(const std::vector<Need>& needs, const RouteSegment& segment, std::vector<PlannedEffect>& effects) {
  for (const Need& need : needs) {
    PlannedEffect* last = nullptr;
    for (PlannedEffect& effect : effects)
      if (effect.need.effect == need.effect) last = &effect;
    if (last != nullptr && last->need.verdict == need.verdict && std::abs(last->end_m - segment.start_m) < 1e-6)
      last->end_m = segment.end_m;
    else
      effects.push_back({.need = need, .segment = {}, .start_m = segment.start_m, .end_m = segment.end_m});
  }
}

/// The lines of one effect after each other, effects in the order in which they were first spoken of.
std::vector<PlannedEffect> by_effect(const std::vector<PlannedEffect>& pieces) {
  std::vector<PlannedEffect> out;
  std::vector<std::string> done;
  for (const PlannedEffect& first : pieces) {
    bool known = false;
    for (const std::string& effect : done) known = known || effect == first.need.effect;
    if (known) continue;
    done.push_back(first.need.effect);
    for (const PlannedEffect& piece : pieces)
      if (piece.need.effect == first.need.effect) out.push_back(piece);
  }
  for (PlannedEffect& effect : out) effect.segment = stretch(effect.start_m, effect.end_m);
  return out;
}

}  // namespace

Result<Plan> make_plan(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                       const PlanRequest& request) {
  Plan plan{.mission = config.run.name,
            .fidelity = request.fidelity,
            .outputs = request.outputs,
            .half_width_m = request.half_width_m,
            .tolerances = request.tolerances,
            .effects = {},
            .figure_bounds = {},
            .epoch_t_s = {},
            .epoch_bound_m = {},
            .tape_hash = {},
            .seeds = {},
            .omissions = {}};
  const std::vector<Need> readers = reader_needs(config, mission, request.outputs, request.open_loop);
  leave_out_unread(readers, plan.omissions);
  for (const Need& need : readers) plan.effects.push_back({.need = need, .segment = "whole run"});

  const std::vector<RouteSegment> corridor = corridor_of(mission, request.half_width_m);
  const std::vector<scene::SweptRoom> moving = mission.traffic.swept();
  CANYON_TRY(const auto around, gnss::GnssSurroundings::make(config.gnss, *mission.scene, moving, mission.start,
                                                             mission.start + mission.time_limit_s, corridor));
  plan.omissions.corridor_until_s = mission.time_limit_s;
  std::vector<PlannedEffect> pieces;
  for (const RouteSegment& segment : corridor) {
    throw_if_cancelled();
    const std::vector<Need> needs = gnss::gnss_needs(config.gnss, around, segment);
    add_piece(needs, segment, pieces);
    plan.omissions.corridor.push_back({segment, gnss::omissions_of(needs), {}});
  }
  if (plan.omissions.unkept_rays) {
    const auto clear = lidar::clearances(*mission.scene, moving, corridor);
    for (std::size_t i = 0; i < clear.size(); ++i) plan.omissions.corridor[i].around = clear[i];
  }
  CANYON_TRY_STATUS(
      leave_out_tolerated(gnss::gnss_range_needs(config.gnss, around), config, mission, request.open_loop, plan));
  // A corridor in which nothing is left out needs no watching.
  const auto keeps_all = [](const mission::PlannedPlace& place) {
    return place.paths == gnss::PathOmissions{} && place.around.clear_m <= 0.0;
  };
  if (!plan.omissions.moves() && std::all_of(plan.omissions.corridor.begin(), plan.omissions.corridor.end(), keeps_all))
    plan.omissions.corridor.clear();
  for (PlannedEffect& effect : by_effect(pieces)) plan.effects.push_back(std::move(effect));
  return plan;
}

}  // namespace canyon::study
