#pragma once

#include <span>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/solver/carrier_smoothing.h"
#include "canyon/gnss/solver/position_config.h"
#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/solver/pvt_filter.h"
#include "canyon/gnss/solver/weighting.h"

namespace canyon::gnss {

/// Smoothing of either band's codes by their own carriers.
struct BandSmoothing {
  explicit BandSmoothing(double time_constant_s) : first(time_constant_s), second(time_constant_s) {}
  CarrierSmoothing first, second;
};

/// When a fix is not given out, and what is said of those that are.
struct FixOutput {
  const RangeErrorReport* errors = nullptr;  ///< none: the solution's own covariance
  int fewest_satellites = 0;
  double accuracy_limit_m = 0.0;  ///< 0: no limit
};

/// What a receiver knows and uses.
struct ReceiverParts {
  const Constellation& constellation;
  const ReceiverMode& mode;
  const PositionSolver& solver;
  const RangeWeighting& weighting;
  double max_gdop = 100.0;      ///< of a velocity
  Eigen::Vector3d guess_E;      ///< rough position, used while there is no fix; some kilometres are good enough
  PvtFilter* filter = nullptr;  ///< of position, velocity and time; without one each epoch is solved by itself
  BandSmoothing* smoothing = nullptr;
  FixOutput output{};
};

/// The receiver's own work, from pseudoranges to a fix: completes the observations (satellite position, velocity,
/// clock, correction, sigma, used) and solves them. `inputs` runs parallel to epoch.observations; its receivers_view is
/// filled in. `corrections` gets what was subtracted, `last` the epoch's own least squares. The fix carries the time
/// `t` and not the receiver clock's reading epoch.t: a receiver corrects its own time tag with the clock that it
/// solves. With a filter the fix is the filter's: it begins with a least squares of its own, and once it runs it is
/// given all satellites, few or many, whatever the epoch's own solution made of them, and tests each against what it
/// expects. In a mode that needs a base, ranges that it does not correct are completed, with a sigma that is NaN, and
/// not used; `last` is then of the others alone.
GnssFix compute_fix(const ReceiverParts& receiver, GpsTime t, GnssEpoch& epoch, std::span<CorrectionInput> inputs,
                    std::vector<Correction>& corrections, PositionSolution* last = nullptr);

/// Whether ranges that move by up to bound_m each leave every decision of this epoch as it is: which satellites are
/// used, and that there is a fix. The square root of the chi-square statistic moves by bound_m sqrt(sum 1 / sigma^2) at
/// most, since a residual's projection shortens it; what weights and geometry change on the way from a poorer guess
/// is within 1 % of it. An epoch that has been repaired by exclusions, or has no fix, never holds.
bool decisions_hold(const PositionSolution& solution, const GnssEpoch& epoch, double bound_m, double max_gdop);

}  // namespace canyon::gnss
