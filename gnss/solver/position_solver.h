#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"

namespace canyon::gnss {

/// A range to a known point.
struct RangeMeasurement {
  Eigen::Vector3d
      p_E;  ///< satellite at transmission, in E of transmission; the solver turns it by the Earth's rotation
  double range_m = 0.0;                  ///< pseudorange with the satellite clock and the corrections applied
  double sigma_m = 1.0;                  ///< > 0, its weight is 1 / sigma^2; errors of its own, independent of others'
  GnssSystem system = GnssSystem::kGps;  ///< each system has a receiver clock of its own (receiver_clocks.h)
  /// 1-sigma, m, of this range's part in one error that all ranges share with the same sign, such as the scale of a
  /// modelled ionosphere. Where any is not 0, that error becomes an unknown with a prior of N(0, 1).
  double shared_m = 0.0;
};

/// Are the ranges consistent with one another? Chi-square test of the weighted residuals.
struct IntegrityTest {
  enum class Status : std::uint8_t {
    kNotTested,  ///< switched off, or no redundancy
    kPassed,
    kRepaired,  ///< passed after some ranges were excluded
    kFailed,    ///< and no exclusion helped, or was possible
  };
  Status status = Status::kNotTested;
  double statistic = kNaN;  ///< sum of (residual / sigma)^2 of the ranges in use
  double threshold = kNaN;  ///< exceeded with the false-alarm probability
  int degrees_of_freedom = 0;
};

struct PositionSolution {
  bool ok = false;
  std::string reason;  ///< why not, in a sentence; empty if ok
  Eigen::Vector3d p_E = Eigen::Vector3d::Constant(kNaN);
  double clock_m = kNaN;  ///< receiver clock of the first system in use, in the order of GnssSystem (GPS first)
  std::array<double, 6> system_clock_m{kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};  ///< by GnssSystem; NaN where not solved
  Eigen::Matrix3d covariance_E = Eigen::Matrix3d::Constant(kNaN);            ///< of p_E from the sigmas, m^2
  /// Sum over the ranges in use of |d p_E / d range| at the weights of this epoch: ranges that move by up to b each, in
  /// whatever direction, move p_E by this times b at most.
  double range_gain = kNaN;
  Dop dop;                          ///< without weights; of the last geometry, also where ok is false and there was one
  std::vector<double> residuals_m;  ///< measured minus fitted, of all ranges, excluded ones too; empty if not ok
  std::vector<bool> used;           ///< false: excluded as faulty; as long as residuals_m
  IntegrityTest integrity;
  int iterations = 0;

  int satellites_used() const {
    int n = 0;
    for (const bool u : used) n += u;
    return n;
  }
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
  double max_gdop = 100.0;               ///< poorer geometry is refused as singular
  std::string fault_exclusion = "none";  ///< a row of fault_exclusions() (fault_exclusion.h)
  double false_alarm = 1e-3;             ///< probability that a fault-free epoch fails the integrity test
  int max_exclusions = 8;
};

using MakePositionSolver = std::unique_ptr<PositionSolver>(const ModelParameters& own,
                                                           const PositionSolverParameters& p);
ModelTable<MakePositionSolver> position_solvers();

/// Iterated weighted least squares for position and one receiver clock per system: three satellites and one more for
/// each system's clock.
std::unique_ptr<PositionSolver> make_least_squares(const PositionSolverParameters& p);
/// The paper's "generic trilateration": ranges only, three unknowns, no receiver clock; needs three satellites. Errors
/// common to all satellites, which a clock would take up, go into the position. GDOP is the PDOP, TDOP does not exist.
std::unique_ptr<PositionSolver> make_trilateration(const PositionSolverParameters& p);

/// DOPs of a geometry: `lines` are unit vectors from the receiver to each satellite in E. With `clock`, the clock is a
/// fourth unknown. NaN throughout if there are fewer satellites than unknowns; infinite where the geometry is singular.
Dop dilution_of_precision(std::span<const Eigen::Vector3d> lines, const Eigen::Matrix3d& R_E_enu, bool clock);
/// The same with a receiver clock for each system (`systems` runs parallel to `lines`). TDOP is that of the first
/// system's clock, in the order of GnssSystem, and GDOP^2 = PDOP^2 + TDOP^2.
Dop dilution_of_precision(std::span<const Eigen::Vector3d> lines, std::span<const GnssSystem> systems,
                          const Eigen::Matrix3d& R_E_enu);

}  // namespace canyon::gnss
