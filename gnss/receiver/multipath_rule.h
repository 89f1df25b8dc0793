#pragma once

#include <memory>
#include <optional>
#include <span>

#include "canyon/core/model_choice.h"
#include "canyon/gnss/receiver/code_tracking.h"
#include "canyon/gnss/receiver/link_budget.h"

namespace canyon::gnss {

/// What the receiver makes of one satellite's signals. Errors are those of an undisturbed direct signal's measurements.
struct Reception {
  bool tracked = false;
  double error_m = 0.0;  ///< code delay beyond the direct way's
  double cn0_dbhz = 0.0;
  double carrier_error_m = 0.0;       ///< of the carrier range; runs on smoothly while `source` stays
  double range_rate_error_m_s = 0.0;  ///< of the range rate that the carrier's frequency tells
  int source = -1;                    ///< signal whose peak is tracked: -1 = direct, else index of the echo
};

/// How direct and reflected signals together become a range.
class MultipathRule {
 public:
  virtual ~MultipathRule() = default;
  /// `direct`: nullopt if it is blocked. Echoes by growing excess.
  virtual Reception receive(const std::optional<ReceivedSignal>& direct, std::span<const ReceivedSignal> echoes,
                            double wavelength_m) const = 0;
  /// Echoes of a direct signal that are later than this by way, m, make no difference.
  virtual double reach_m() const = 0;
};

struct MultipathParameters {
  double cutoff_m = 45.0;  ///< paper_first_return
  double threshold_dbhz = 25.0;
  CorrelatorDesign design;  ///< correlator
};

using MakeMultipathRule = std::unique_ptr<MultipathRule>(const ModelParameters& own, const MultipathParameters& p);
ModelTable<MakeMultipathRule> multipath_rules();

/// Keys of the reception.
struct ReceptionConfig {
  ModelChoice<multipath_rules> multipath_rule{"paper_first_return"};
  double cutoff_ns = 150.0;  ///< reflections later than this do not disturb a direct signal, nor are they counted

  double cutoff_m() const;
};
void visit(FieldVisitor& f, ReceptionConfig& c);

/// Where an echo's peak leaves the late arm of a correlator; BPSK(1) has the longest chip.
double late_arm_m(const CorrelatorDesign& design);

std::unique_ptr<MultipathRule> make_paper_first_return(const MultipathParameters& p);
std::unique_ptr<MultipathRule> make_correlator(const MultipathParameters& p);

/// NLOS-only reception of the simple rules: the strongest reflection is tracked if it reaches the threshold, its range
/// too long by its excess; otherwise nothing is.
Reception strongest_reflection(std::span<const ReceivedSignal> echoes, double threshold_dbhz, double wavelength_m);

}  // namespace canyon::gnss
