#include "canyon/study/plan/plan_file.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/process/version.h"
#include "canyon/study/plan/tolerated.h"

namespace canyon::study {

namespace {

constexpr const char *kKind = "canyon-plan-4", *kAnyKind = "canyon-plan-";

/// Of all that a plan depends on but the scene's own geometry: the keys, and what stands in the files that they name.
std::string mission_hash(const mission::MissionConfig& config, const mission::PreparedMission& mission) {
  mission::MissionConfig copy = config;
  copy.run.seed = 0;
  std::string text = fields_as_json([&copy](FieldVisitor& f) { visit(f, copy); });
  for (const mission::InputFile& file : mission.files) text += file.sha256;
  return sha256_hex(text);
}

Json place_json(const mission::PlannedPlace& place) {
  Json points = Json::array();
  for (const Eigen::Vector3d& p : place.segment.points_W) points.push_back({p.x(), p.y(), p.z()});
  const gnss::PathOmissions& paths = place.paths;
  return {{"start_m", place.segment.start_m},
          {"end_m", place.segment.end_m},
          {"half_width_m", place.segment.half_width_m},
          {"low_m", place.segment.low_m},
          {"high_m", place.segment.high_m},
          {"no_occlusion", paths.occlusion},
          {"no_foliage", paths.foliage},
          {"no_diffraction", paths.diffraction},
          {"most_reflections", paths.most_reflections},
          {"clear_m", place.around.clear_m},
          {"ground_slope", place.around.ground_slope},
          {"points_m", points}};
}

/// Throws nlohmann's exceptions where something is missing or of another type.
mission::PlannedPlace place_of(const nlohmann::json& json) {
  mission::PlannedPlace place;
  RouteSegment& segment = place.segment;
  segment.start_m = json.at("start_m");
  segment.end_m = json.at("end_m");
  segment.half_width_m = json.at("half_width_m");
  segment.low_m = json.at("low_m");
  segment.high_m = json.at("high_m");
  place.paths.occlusion = json.at("no_occlusion");
  place.paths.foliage = json.at("no_foliage");
  place.paths.diffraction = json.at("no_diffraction");
  place.paths.most_reflections = json.at("most_reflections");
  place.around.clear_m = json.at("clear_m");
  place.around.ground_slope = json.at("ground_slope");
  for (const auto& p : json.at("points_m")) segment.points_W.emplace_back(p.at(0), p.at(1), p.at(2));
  return place;
}

Json ranges_json(const gnss::RangeOmissions& ranges) {
  const gnss::DelayOmissions& delays = ranges.delays;
  return {{"ionosphere", delays.ionosphere},       {"ionosphere_difference", delays.ionosphere_difference},
          {"troposphere", delays.troposphere},     {"troposphere_difference", delays.troposphere_difference},
          {"ephemeris", delays.ephemeris},         {"bound_m", ranges.bound_m},
          {"most_gain", or_null(ranges.most_gain)}};
}

/// Throws nlohmann's exceptions where something is missing or of another type.
gnss::RangeOmissions ranges_of(const nlohmann::json& json) {
  gnss::RangeOmissions ranges;
  ranges.delays = {.ionosphere = json.at("ionosphere"),
                   .ionosphere_difference = json.at("ionosphere_difference"),
                   .troposphere = json.at("troposphere"),
                   .troposphere_difference = json.at("troposphere_difference"),
                   .ephemeris = json.at("ephemeris")};
  ranges.bound_m = json.at("bound_m");
  if (const auto& gain = json.at("most_gain"); !gain.is_null()) ranges.most_gain = gain;
  return ranges;
}

/// What is left out beyond a bound of 0 has a tolerance that it was made for, and a finite gain to watch.
bool sound(const Plan& plan) {
  const gnss::RangeOmissions& ranges = plan.omissions.ranges;
  if (!(ranges.bound_m >= 0.0) || !(ranges.most_gain >= 0.0)) return false;
  if (ranges.bound_m > 0.0 && !std::isfinite(ranges.most_gain)) return false;
  if (plan.omissions.moves() && plan.tolerances.empty()) return false;
  for (const auto& [figure, tolerance] : plan.tolerances) {
    const auto bound = plan.figure_bounds.find(figure);
    if (!(tolerance > 0.0) || (bound != plan.figure_bounds.end() && !(bound->second <= tolerance))) return false;
  }
  if (plan.omissions.moves() && (plan.outputs != std::vector<Output>{Output::kPosition} || plan.tape_hash.empty()))
    return false;
  return check_reached(plan.tolerances, "").ok() && plan.epoch_t_s.size() == plan.epoch_bound_m.size();
}

bool sound(const mission::PlannedPlace& place) {
  const RouteSegment& s = place.segment;
  return !s.points_W.empty() && s.half_width_m >= 0.0 && s.low_m <= s.high_m && place.paths.most_reflections >= 0;
}

/// False for what no plan says. Throws nlohmann's exceptions where something is missing or of another type.
bool fill(const nlohmann::json& json, Plan& plan) {
  plan.mission = json.at("mission");
  plan.fidelity = json.at("fidelity");
  plan.half_width_m = json.at("half_width_m");
  std::vector<std::string> outputs;
  for (const auto& output : json.at("outputs")) outputs.push_back(output);
  auto known = outputs_of(outputs, "");
  if (!known) return false;
  plan.outputs = *std::move(known);
  const auto& out = json.at("leave_out");
  plan.omissions.registration = out.at("registration");
  plan.omissions.maps = out.at("maps");
  plan.omissions.keyframes = out.at("keyframes");
  plan.omissions.autonomy = out.at("autonomy");
  plan.omissions.unkept_rays = out.at("unkept_rays");
  plan.omissions.corridor_until_s = out.at("corridor_until_s");
  for (const auto& place : out.at("corridor")) plan.omissions.corridor.push_back(place_of(place));
  plan.omissions.ranges = ranges_of(out.at("ranges"));
  plan.omissions.strapdown = {.coning = out.at("strapdown").at("coning"),
                              .earth_rate = out.at("strapdown").at("earth_rate")};
  for (const auto& asked : json.at("tolerances")) {
    const std::string figure = asked.at("figure");
    plan.tolerances[figure] = asked.at("tolerance");
    plan.figure_bounds[figure] = asked.at("bound");
  }
  const auto& bounds = json.at("position_bounds");
  plan.tape_hash = bounds.at("tape_hash");
  for (const auto& seed : bounds.at("seeds")) plan.seeds.push_back(seed);
  for (const auto& t : bounds.at("t_s")) plan.epoch_t_s.push_back(t);
  for (const auto& bound : bounds.at("position_m")) plan.epoch_bound_m.push_back(bound);
  for (const auto& line : json.at("effects")) {
    PlannedEffect effect;
    effect.need.effect = line.at("effect");
    const std::string verdict = line.at("verdict");
    for (const Verdict v : {Verdict::kNeeded, Verdict::kNotNeeded})
      if (verdict == canyon::name(v)) effect.need.verdict = v;
    effect.need.reason = line.at("reason");
    if (const auto& bound = line.at("bound"); !bound.is_null()) effect.need.bound = bound;
    effect.need.bound_unit = line.at("bound_unit");
    for (const auto& [figure, move] : line.at("moves").items()) effect.moves[figure] = move;
    effect.segment = line.at("segment");
    effect.start_m = line.at("start_m");
    effect.end_m = line.at("end_m");
    plan.effects.push_back(std::move(effect));
  }
  return true;
}

Status check(const nlohmann::json& json, const std::string& path, const mission::MissionConfig& config,
             const mission::PreparedMission& mission) {
  const std::string version = json_string(json, "version");
  if (version != kVersion)
    return Error{.file = path,
                 .what = "is a plan of canyon " + (version.empty() ? std::string("of no version") : version),
                 .expected = std::string("one of canyon ") + kVersion + ": make it again with canyon plan --write"};
  if (json_string(json, "scene_hash") != mission.scene->hash())
    return Error{.file = path,
                 .what = "is a plan for another scene",
                 .expected = "one for the scene of this mission (" + mission.scene->hash().substr(0, 12) + "…)"};
  if (json_string(json, "mission_hash") != mission_hash(config, mission))
    return Error{.file = path,
                 .what = "is a plan for another mission (\"" + json_string(json, "mission") + "\", fidelity " +
                         json_string(json, "fidelity") + ")",
                 .expected = "one for this mission and fidelity, of the same keys but [run] seed and the same files"};
  return Ok{};
}

/// Bounds hold along one motion, and where an estimate moves nobody.
Status check_tape_of(const Plan& plan, const std::string& path, const Tape* tape) {
  if (tape == nullptr)
    return Error{.file = path,
                 .what = "lets the estimate move within a tolerance, and in a closed loop the vehicle with it",
                 .expected = "--open-loop, or a plan made without --tolerance"};
  if (const std::string hash = tape_hash(*tape); hash != plan.tape_hash)
    return Error{
        .file = path,
        .what = "has bounds that hold along another tape (" + plan.tape_hash.substr(0, 12) + "…, not " +
                hash.substr(0, 12) + "…)",
        .expected = "the mission's own route with the seed that the plan was made for, and --seeds for others"};
  return Ok{};
}

}  // namespace

Json effects_json(const Plan& plan) {
  Json effects = Json::array();
  for (const PlannedEffect& effect : plan.effects) {
    const Need& need = effect.need;
    const bool left_out = need.verdict == Verdict::kNotNeeded, bounded = left_out || need.bound > 0.0;
    effects.push_back({{"effect", need.effect},
                       {"segment", effect.segment},
                       {"needed", need.verdict != Verdict::kNotNeeded},
                       {"verdict", canyon::name(need.verdict)},
                       {"reason", need.reason},
                       {"bound", bounded ? Json(need.bound) : Json(nullptr)},
                       {"bound_unit", need.bound_unit},
                       {"moves", effect.moves},
                       {"saved_cpu_s", left_out ? or_null(effect.saved_cpu_s) : Json(0.0)},
                       {"start_m", effect.start_m},
                       {"end_m", effect.end_m}});
  }
  return effects;
}

Json tolerances_json(const Plan& plan) {
  Json out = Json::array();
  for (const auto& [figure, tolerance] : plan.tolerances) {
    const auto bound = plan.figure_bounds.find(figure);
    out.push_back({{"figure", figure},
                   {"tolerance", tolerance},
                   {"bound", bound == plan.figure_bounds.end() ? 0.0 : bound->second}});
  }
  return out;
}

Json position_bounds_json(const Plan& plan) {
  return {{"tape_hash", plan.tape_hash},
          {"seeds", plan.seeds},
          {"t_s", plan.epoch_t_s},
          {"position_m", plan.epoch_bound_m}};
}

Json left_out_json(const Plan& plan) {
  Json out = Json::array();
  for (const PlannedEffect& effect : plan.effects)
    if (effect.need.verdict == Verdict::kNotNeeded)
      out.push_back({{"effect", effect.need.effect}, {"segment", effect.segment}, {"reason", effect.need.reason}});
  return out;
}

std::string plan_text(const Plan& plan, const mission::MissionConfig& config, const mission::PreparedMission& mission) {
  Json outputs = Json::array(), corridor = Json::array();
  for (const Output output : plan.outputs) outputs.push_back(name(output));
  for (const mission::PlannedPlace& place : plan.omissions.corridor) corridor.push_back(place_json(place));
  const Json json{
      {"kind", kKind},
      {"version", kVersion},
      {"mission", plan.mission},
      {"fidelity", plan.fidelity},
      {"mission_hash", mission_hash(config, mission)},
      {"scene_hash", mission.scene->hash()},
      {"outputs", outputs},
      {"half_width_m", plan.half_width_m},
      {"tolerances", tolerances_json(plan)},
      {"position_bounds", position_bounds_json(plan)},
      {"effects", effects_json(plan)},
      {"leave_out",
       {{"registration", plan.omissions.registration},
        {"maps", plan.omissions.maps},
        {"keyframes", plan.omissions.keyframes},
        {"autonomy", plan.omissions.autonomy},
        {"unkept_rays", plan.omissions.unkept_rays},
        {"ranges", ranges_json(plan.omissions.ranges)},
        {"strapdown",
         {{"coning", plan.omissions.strapdown.coning}, {"earth_rate", plan.omissions.strapdown.earth_rate}}},
        {"corridor_until_s", plan.omissions.corridor_until_s},
        {"corridor", corridor}}}};
  return json_text(json, 1) + "\n";
}

Result<Plan> read_plan(const std::string& path, const mission::MissionConfig& config,
                       const mission::PreparedMission& mission, const Tape* tape) {
  CANYON_TRY(const std::string text, read_text_file(path));
  CANYON_TRY(const nlohmann::json json, parse_json(text, path));
  const Error no_plan{.file = path, .what = "is no plan", .expected = "a file of canyon plan --write"};
  const std::string kind = json.is_object() ? json_string(json, "kind") : std::string();
  if (kind != kKind && kind.starts_with(kAnyKind))
    return Error{.file = path,
                 .what = "is a plan of the form " + kind,
                 .expected = std::string(kKind) + ": make it again with canyon plan --write"};
  if (kind != kKind) return no_plan;
  CANYON_TRY_STATUS(check(json, path, config, mission));
  Plan plan;
  try {
    if (!fill(json, plan)) return no_plan;
  } catch (const nlohmann::json::exception&) {
    return no_plan;
  }
  const auto& corridor = plan.omissions.corridor;
  const auto sound_place = [](const mission::PlannedPlace& place) { return sound(place); };
  if (!sound(plan) || !std::all_of(corridor.begin(), corridor.end(), sound_place) ||
      !mission::can_leave_out(config, plan.omissions))
    return no_plan;
  if (plan.omissions.moves()) CANYON_TRY_STATUS(check_tape_of(plan, path, tape));
  if (plan.omissions.autonomy && tape == nullptr)
    return Error{.file = path,
                 .what = "is a plan for an open loop, in which nobody drives",
                 .expected = "--open-loop, or a plan made without it"};
  return plan;
}

}  // namespace canyon::study
