#pragma once

#include <memory>
#include <optional>

#include "canyon/core/messages.h"
#include "canyon/mission/autonomy/planning/local_planner.h"

namespace canyon::mission {

/// How it stands with driving on.
struct RecoveryTask {
  double t_s = 0.0;
  bool blocked = false;   ///< it should drive on and may not
  double driven_m = 0.0;  ///< since the start, either way
  const LocalPlan& plan;  ///< made anew with every scan
  MovingBody body;        ///< in O
  Clearances clearances;
  const BlockedCells& blocked_cells;
  const KnownVehicle& vehicle;
};

/// What is done where no way ahead is free. One-level interface; the models are in the table below, each in its own
/// file with its own parameters.
class Recovery {
 public:
  virtual ~Recovery() = default;
  /// None: it has nothing to do, the plan is driven.
  virtual std::optional<DriveCommand> act(const RecoveryTask& task) = 0;
};

using MakeRecovery = std::unique_ptr<Recovery>(const ModelParameters& own);
ModelTable<MakeRecovery> recoveries();

/// Makers of the rows of the table in planning/recoveries.cpp, and their parameters, each in the file of its model.
std::unique_ptr<Recovery> make_back_up(const ModelParameters& own);
double back_up_wait_s(const ModelParameters& own);  ///< how long it stands before it backs up
void back_up_parameters(ModelParameters& section);

}  // namespace canyon::mission
