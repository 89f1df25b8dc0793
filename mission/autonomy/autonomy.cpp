#include "canyon/mission/autonomy/autonomy.h"

#include "canyon/core/check.h"
#include "canyon/mission/autonomy/reference.h"
#include "canyon/mission/autonomy/reference_2012.h"
#include "canyon/mission/autonomy/route_driver.h"

namespace canyon::mission {

namespace {

constexpr ModelRow<MakeAutonomy> kAutonomies[] = {
    {"reference", make_reference, "in exchangeable parts: drives its own body along arcs it can drive, by what it sees",
     parameters_of<ReferenceParameters>},
    {"reference_2012", make_reference_2012,
     "the one of up to 2026-11: points of its rear axle in a grid of heights in W, beside the street by choice",
     parameters_of<Reference2012Parameters>},
    {"route_follower",
     [](const ModelParameters&, const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime start) {
       return make_route_follower(config, prior, start);
     },
     "the centre line, whatever stands there"},
};
constexpr ModelRow<MapPose> kMapPoses[] = {
    {"prior", MapPose::kPrior, "the filter's"},
    {"registered", MapPose::kRegistered, "corrected by the last registered keyframe"},
};

}  // namespace

void visit(FieldVisitor& f, Waypoint& w) {
  f.text("name", w.name, "shown in reports");
  f.vector2("p_m", w.p_m, {-1e5, 1e5}, "x and y in W, metres east and north of the scene's centre");
  f.text("observe", w.observe, "building to stop and look at; makes it a mission waypoint");
}

void visit(FieldVisitor& f, AutonomyConfig& c) {
  visit_choice(f, "model", c.model,
               "which autonomy drives: reference, in exchangeable parts; reference_2012, the one before it; or "
               "route_follower: the centre line, whatever stands there");
  f.choice("map", c.map, ModelTable<MapPose>(kMapPoses),
           "pose it works with: the filter's, or corrected by the last registered keyframe");
  f.number("rate_hz", c.rate_hz, {1, 1000}, "commands per second; each takes effect at the next master step of 10 ms");
  f.number("cruise_m_s", c.cruise_m_s, {0.2, 30}, "speed on a free, straight street");
  f.number("lateral_m_s2", c.lateral_m_s2, {0.1, 10}, "lateral acceleration allowed in corners");
  f.number("braking_m_s2", c.braking_m_s2, {0.1, 10}, "deceleration it plans with");
  f.number("corner_radius_m", c.corner_radius_m, {1, 100}, "radius of the planned turns");
  f.number("hold_s", c.hold_s, {0, 600}, "how long it looks at a building");
  f.number("blind_after_s", c.blind_after_s, {0.1, 60}, "stops when no scan with returns came for this long");
  f.number(
      "call_limit_s", c.call_limit_s, {0.1, 1e4},
      "wall time after which one call of the autonomy counts as never returning, without what the process is stopped "
      "from outside; a sound one comes nowhere near");
  f.list("waypoint", c.waypoints, "places to drive through, in order");
}

const char* name(AutonomyState state) {
  switch (state) {
    case AutonomyState::kDriving:
      return "driving";
    case AutonomyState::kObserving:
      return "observing";
    case AutonomyState::kBlocked:
      return "blocked";
    case AutonomyState::kBlind:
      return "blind";
    case AutonomyState::kDone:
      return "done";
    case AutonomyState::kLost:
      return "lost";
  }
  return "unknown";
}

Result<PriorKnowledge> plan_route(const AutonomyConfig& config, const scene::StreetGraph& streets,
                                  const Eigen::Vector2d& start_m) {
  std::vector<Eigen::Vector2d> polyline{start_m};
  std::vector<std::size_t> corner;  // index into polyline of each waypoint
  Eigen::Vector2d from = start_m;
  for (std::size_t i = 0; i < config.waypoints.size(); ++i) {
    const Waypoint& waypoint = config.waypoints[i];
    const auto leg = streets.route(from, waypoint.p_m);
    if (leg.empty())
      return Error{.key = "autonomy.waypoint[" + std::to_string(i + 1) + "]",
                   .what = "no street leads to waypoint \"" + waypoint.name + "\"",
                   .expected = "a waypoint that the streets connect with the one before"};
    polyline.insert(polyline.end(), leg.begin(), leg.end());
    from = waypoint.p_m;
    corner.push_back(polyline.size() - 1);
  }
  PriorKnowledge prior{.route = Path(polyline, config.corner_radius_m)};
  if (prior.route.empty())
    return Error{.key = "autonomy.waypoint[1], vehicle.start_m",
                 .what = "start and waypoints are one place",
                 .expected = "a way to drive"};
  // Waypoints come in order: each is looked for from the one before on, near where the unrounded streets would put it.
  double s_m = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < config.waypoints.size(); ++i) {
    double leg_m = 0.0;
    for (; at < corner[i]; ++at) leg_m += (polyline[at + 1] - polyline[at]).norm();
    s_m = prior.route.project(config.waypoints[i].p_m, s_m, std::min(prior.route.length_m(), s_m + leg_m + 1.0));
    prior.waypoint_s_m.push_back(s_m);
  }
  return prior;
}

ModelTable<MakeAutonomy> autonomy_models() {
  return kAutonomies;
}

std::unique_ptr<Autonomy> make_autonomy(const AutonomyConfig& config, const PriorKnowledge& prior, GpsTime start) {
  return model_row(autonomy_models(), config.model.name).make(config.model.own, config, prior, start);
}

}  // namespace canyon::mission
