#pragma once

#include <memory>
#include <optional>

#include "canyon/core/messages.h"
#include "canyon/core/model_choice.h"
#include "canyon/mission/autonomy/kept_returns.h"

namespace canyon::mission {

/// How far an autonomy believes its own estimate.
enum class Trust {
  kGood,
  kDoubtful,  ///< drives slowly
  kLost,      ///< for good: it stands and says so
};

/// Whether the estimate moves as the vehicle does. It sees no truth: the estimate, what its wheel counts and what its
/// scans show are held against one another. One-level interface; the models are in the table below, each in its own
/// file with its own parameters.
class SelfCheck {
 public:
  virtual ~SelfCheck() = default;
  virtual void count(const OdometerSample& sample) = 0;
  /// A deskewed scan in L, placed by the estimate of its stamp.
  virtual void see(const LidarScan& scan, const Pose& X_WL, const NavEstimate& estimate) = 0;
  virtual Trust trust() const = 0;
  /// While it is doubtful.
  virtual double speed_limit_m_s() const = 0;
  virtual std::optional<KeptReturns> keeps() const = 0;  ///< of scans; none: nothing
};

/// A row of the table: how it is made, and whether it wants an odometer.
struct SelfCheckMaker {
  std::unique_ptr<SelfCheck> (*make)(const ModelParameters& own);
  bool counts;
};
ModelTable<SelfCheckMaker> self_checks();

/// Makers of the rows of the table in self_check/self_checks.cpp, and their parameters, each in the file of its model.
std::unique_ptr<SelfCheck> make_own_motion(const ModelParameters& own);
void own_motion_parameters(ModelParameters& section);

}  // namespace canyon::mission
