#include <nlohmann/json.hpp>

#include "canyon/core/output/printed.h"
#include "canyon/study/loops/closed_map.h"
#include "canyon/study/tables/text_table.h"

namespace canyon::study {
namespace {

/// A relation of less weight than this is switched off.
constexpr double kOff = 0.5;

struct Tally {
  int closing = 0, wrong = 0, wrong_believed = 0, believed = 0;
};

Tally tally_of(const ClosedMap& closed) {
  Tally out;
  for (const JudgedClosure& one : closed.closures) {
    if (!one.trial.closes) continue;
    const bool wrong = one.beyond_bound, believed = one.weight >= kOff;
    ++out.closing;
    out.wrong += wrong;
    out.believed += believed;
    out.wrong_believed += wrong && believed;
  }
  return out;
}

Json placed_json(const PlacedMap& placed) {
  return {{"keyframe_rms_m", or_null(placed.keyframe_rms_m)},
          {"keyframe_rms_deg", or_null(placed.keyframe_rms_deg)},
          {"map_error_rms_m", or_null(placed.map.map_error_rms_m)},
          {"map_error_up_rms_m", or_null(placed.map.map_error_up_rms_m)},
          {"map_points", placed.map.points}};
}

Json closure_json(const JudgedClosure& one) {
  return {{"source", one.trial.source},
          {"target", one.trial.target},
          {"status", row_of(lidar::registration_statuses(), one.trial.status).name},
          {"overlap", or_null(one.trial.overlap)},
          {"open", one.trial.open},
          {"closes", one.trial.closes},
          {"weight", one.weight},
          {"off_m", or_null(one.off_m)},
          {"off_deg", or_null(one.off_deg)},
          {"beyond_bound", one.beyond_bound}};
}

}  // namespace

Json closed_map_json(const ClosedMap& closed) {
  const Tally tally = tally_of(closed);
  Json out = {{"mission", closed.mission},
              {"fidelity", closed.fidelity},
              {"seed", closed.seed},
              {"keyframes", closed.keyframes},
              {"way_m", closed.way_m}};
  out["closures"] = {{"tried", closed.closures.size()},
                     {"closing", tally.closing},
                     {"believed", tally.believed},
                     {"beyond_bound", tally.wrong},
                     {"beyond_bound_believed", tally.wrong_believed}};
  for (const PlacedMap& placed : closed.placed) out["placed"][placed.name] = placed_json(placed);
  out["graph"] = {{"iterations", closed.graph.iterations},
                  {"converged", closed.graph.converged},
                  {"initial_cost", or_null(closed.graph.initial_cost)},
                  {"final_cost", or_null(closed.graph.final_cost)}};
  out["trials"] = Json::array();
  for (const JudgedClosure& one : closed.closures) out["trials"].push_back(closure_json(one));
  return out;
}

std::string closed_map_table(const ClosedMap& closed) {
  const Tally tally = tally_of(closed);
  std::string out = printed("%s, seed %lld: %zu keyframes on %.0f m\n", closed.fidelity.c_str(),
                            static_cast<long long>(closed.seed), closed.keyframes, closed.way_m);
  out += printed(
      "earlier places looked at %zu times: %d close (%d beyond their own 99.9 %% bound, by truth), the graph "
      "believes %d (%d of those)\n\n",
      closed.closures.size(), tally.closing, tally.wrong, tally.believed, tally.wrong_believed);
  TextTable table({"keyframes, m", "degrees", "map, m", "its height, m"});
  for (const PlacedMap& placed : closed.placed)
    table.line(placed.name, {fixed(placed.keyframe_rms_m, 3), fixed(placed.keyframe_rms_deg, 3),
                             fixed(placed.map.map_error_rms_m, 3), fixed(placed.map.map_error_up_rms_m, 3)});
  out += table.str();
  if (closed.closures.empty()) out += "No keyframe comes by an earlier place: there is no loop to close.\n";
  return out;
}

}  // namespace canyon::study
