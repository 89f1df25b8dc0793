#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/messages.h"
#include "gnss/model_table.h"

namespace canyon::gnss {

/// A range to a known point.
struct RangeMeasurement {
  Eigen::Vector3d
      p_E;  ///< satellite at transmission, in E of transmission; the solver turns it by the Earth's rotation
  double range_m = 0.0;                  ///< pseudorange with the satellite clock and the corrections applied
  double sigma_m = 1.0;                  ///< > 0, its weight is 1 / sigma^2
  GnssSystem system = GnssSystem::kGps;  ///< each system has a receiver clock of its own
};

struct PositionSolution {
  bool ok = false;
  std::string reason;  ///< why not, in a sentence; empty if ok
  Eigen::Vector3d p_E = Eigen::Vector3d::Constant(kNaN);
  double clock_m = kNaN;
  Eigen::Matrix3d covariance_E = Eigen::Matrix3d::Constant(kNaN);  ///< of p_E from the sigmas, m^2
  Dop dop;                          ///< without weights; of the last geometry, also where ok is false and there was one
  std::vector<double> residuals_m;  ///< measured minus fitted
  int iterations = 0;
};

/// Ranges to position.
class PositionSolver {
 public:
  virtual ~PositionSolver() = default;
  /// `guess_E` may be as poor as the Earth's centre.
  virtual PositionSolution solve(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E) const = 0;
  /// False if it has no unknown for the receiver clock.
  virtual bool solves_clock() const = 0;
};

struct PositionSolverParameters {
  double max_gdop = 100.0;  ///< poorer geometry is refused as singular
};

using MakePositionSolver = std::unique_ptr<PositionSolver>(const PositionSolverParameters&);
std::span<const ModelRow<MakePositionSolver>> position_solvers();

/// Iterated weighted least squares for position and receiver clock; needs four satellites.
std::unique_ptr<PositionSolver> make_least_squares(const PositionSolverParameters& p);
/// The paper's "generic trilateration": ranges only, three unknowns, no receiver clock; needs three satellites. Errors
/// common to all satellites, which a clock would take up, go into the position. GDOP is the PDOP, TDOP does not exist.
std::unique_ptr<PositionSolver> make_trilateration(const PositionSolverParameters& p);

/// DOPs of a geometry: `lines` are unit vectors from the receiver to each satellite in E. With `clock`, the clock is a
/// fourth unknown. NaN throughout if there are fewer satellites than unknowns; infinite where the geometry is singular.
Dop dilution_of_precision(std::span<const Eigen::Vector3d> lines, const Eigen::Matrix3d& R_E_enu, bool clock);

}  // namespace canyon::gnss
