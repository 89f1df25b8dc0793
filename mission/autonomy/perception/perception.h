#pragma once

#include <memory>

#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"
#include "canyon/mission/autonomy/kept_returns.h"
#include "canyon/mission/autonomy/perception/blocked_cells.h"

namespace canyon::mission {

/// What an autonomy makes of its scans: where it cannot drive. One-level interface; the models are in the table below,
/// each in its own file with its own parameters.
class Perception {
 public:
  virtual ~Perception() = default;
  virtual KeptReturns keeps() const = 0;
  /// A deskewed scan, L and B as placed in the local frame O at its stamp. False: so few returns that it is as good as
  /// none.
  virtual bool see(const LidarScan& scan, const Pose& X_OL, const Pose& X_OB, double t_s) = 0;
  virtual const BlockedCells& blocked() const = 0;
  /// How far from B the last scan had returns in a direction in O, m, ground or not.
  virtual double seen_m(const Eigen::Vector2d& direction_O) const = 0;
};

using MakePerception = std::unique_ptr<Perception>(const ModelParameters& own, const KnownVehicle& vehicle);
ModelTable<MakePerception> perceptions();

/// Makers of the rows of the table in perception/perceptions.cpp, and their parameters, each in the file of its model.
std::unique_ptr<Perception> make_ground_grid(const ModelParameters& own, const KnownVehicle& vehicle);
void ground_grid_parameters(ModelParameters& section);

}  // namespace canyon::mission
