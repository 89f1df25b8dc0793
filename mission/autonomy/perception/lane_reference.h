#pragma once

#include <memory>
#include <optional>

#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"
#include "canyon/mission/autonomy/kept_returns.h"
#include "canyon/mission/autonomy/path.h"
#include "canyon/mission/autonomy/perception/blocked_cells.h"

namespace canyon::mission {

/// What is known of where the street is.
struct LaneTask {
  const Path& route;  ///< in W: the street's middle, as it is told beforehand
  double s_m = 0.0;   ///< where the vehicle is along it
  Eigen::Vector2d from_O_to_W{0, 0};
  PlanPose body;         ///< in O
  double sigma_m = 0.0;  ///< 1-sigma of the estimate across the vehicle's axis, as the filter says
  double dt_s = 0.0;     ///< since the last time
  const BlockedCells& blocked;
  const LidarScan* scan = nullptr;  ///< the last one, deskewed; null: none
  const Pose* X_OL = nullptr;       ///< L as placed in O at its stamp
  const Pose* X_OB = nullptr;       ///< B likewise
};

/// Where the lane's middle is: how far left of the route, which is known in W, while the vehicle is not. One-level
/// interface; the models are in the table below, each in its own file with its own parameters.
class LaneReference {
 public:
  virtual ~LaneReference() = default;
  /// What it needs of the scans, if it looks at them itself.
  virtual std::optional<KeptReturns> keeps() const { return std::nullopt; }
  virtual double middle_m(const LaneTask& task) = 0;
};

using MakeLaneReference = std::unique_ptr<LaneReference>(const ModelParameters& own);
ModelTable<MakeLaneReference> lane_references();

/// Makers of the rows of the table in perception/lane_references.cpp, and their parameters, each in the file of its
/// model.
std::unique_ptr<LaneReference> make_seen_street(const ModelParameters& own);
void seen_street_parameters(ModelParameters& section);
std::unique_ptr<LaneReference> make_seen_kerbs(const ModelParameters& own);
void seen_kerbs_parameters(ModelParameters& section);

}  // namespace canyon::mission
