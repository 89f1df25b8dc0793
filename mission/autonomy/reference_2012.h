#pragma once

#include <memory>

#include "canyon/mission/autonomy/autonomy.h"
#include "canyon/mission/autonomy/local_grid.h"

namespace canyon::mission {

/// [autonomy.choice] of a mission file: how reference_2012 chooses among paths beside the centre line. The one of
/// least cost is driven; it halts where none is free.
struct PathChoiceConfig {
  double horizon_m = 18.0;           ///< how far ahead each is checked
  double stop_margin_m = 3.0;        ///< kept free ahead of the rear axle when halting before an obstacle
  double comfort_clearance_m = 2.0;  ///< closer to an obstacle than this costs
  double blocked_cost_1_m = 4.0;     ///< for every metre of the horizon behind the first obstacle
  double closeness_cost_1_m2 = 1.0;  ///< for every metre driven a metre closer than the comfortable clearance
  double offset_cost_1_m = 0.6;      ///< for every metre beside the centre line
  double change_cost_1_m = 0.8;      ///< for every metre away from the path chosen last
};
void visit(FieldVisitor& f, PathChoiceConfig& c);

/// Keys of reference_2012.
struct Reference2012Parameters {
  double max_offset_m = 3.5;  ///< how far it may leave the street's centre line
  double clearance_m = 1.0;   ///< from its axis to an obstacle
  LocalGridConfig grid;
  PathChoiceConfig choice;
};
void visit(FieldVisitor& f, Reference2012Parameters& c);

/// The autonomy before `reference` (mission/autonomy/reference.h), kept for comparison: keeps a local height grid of
/// what it sees, chooses among paths shifted sideways from the street's centre line the cheapest that is free, follows
/// it by pure pursuit (Coulter 1992), slows for corners, obstacles and waypoints, and decides from its estimate that a
/// waypoint is reached.
std::unique_ptr<Autonomy> make_reference_2012(const ModelParameters& own, const AutonomyConfig& config,
                                              const PriorKnowledge& prior, GpsTime start);

}  // namespace canyon::mission
