#include "canyon/fusion/states/range_errors.h"

#include <algorithm>
#include <cmath>

#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {

void visit(FieldVisitor& f, RangeErrorsParameters& p) {
  f.integer("range_error_slots", p.range_error_slots, {1, 48}, "satellites whose lasting error is estimated at a time");
  f.number("range_error_sigma_m", p.range_error_sigma_m, {1e-3, 1e3},
           "1-sigma of what lasts of a pseudorange's error, at 45 dB-Hz and above");
  f.number("range_error_decade_db", p.range_error_decade_db, {1, 1e3}, "by so much less C/N0 it is ten times as large");
  f.number("range_error_most_m", p.range_error_most_m, {1e-3, 1e4}, "but never larger than this");
  f.number("range_error_mean", p.range_error_mean, {0, 10},
           "its mean, in units of what the 1-sigma is above that of 45 dB-Hz: echoes are late");
  f.number("range_error_tau_s", p.range_error_tau_s, {1e-3, 1e9}, "its correlation time for an antenna at rest");
  f.number("range_error_way_m", p.range_error_way_m, {1e-3, 1e9}, "way of the antenna over which it changes");
}

double RangeErrorsParameters::growth(double cn0_dbhz) const {
  const double below_db = std::max(kClearCn0Dbhz - cn0_dbhz, 0.0),
               most = std::max(range_error_most_m / range_error_sigma_m, 1.0);
  return std::min(std::pow(10.0, below_db / range_error_decade_db), most);
}

double RangeErrorsParameters::mean_m(double cn0_dbhz) const {
  return range_error_mean * std::max(sigma_m(cn0_dbhz) - range_error_sigma_m, 0.0);
}

namespace {

/// What lasts of the pseudoranges' errors, satellite by satellite, in units of its 1-sigma at the C/N0 of the moment: a
/// Gauss-Markov process, so that an error grows and shrinks with what is received of the satellite.
class RangeErrors final : public StateBlock {
 public:
  explicit RangeErrors(const RangeErrorsParameters& p) : p_(p) {}
  int size() const override { return static_cast<int>(p_.range_error_slots); }
  double variance(int) const override { return 1.0; }
  StateProcess process(int) const override { return StateProcess::gauss_markov(1.0, p_.range_error_tau_s); }

 private:
  RangeErrorsParameters p_;
};

}  // namespace

std::unique_ptr<StateBlock> make_range_errors(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<RangeErrors>(own.get<RangeErrorsParameters>());
}

void range_errors_parameters(ModelParameters& section) {
  section.add<RangeErrorsParameters>();
}

}  // namespace canyon::fusion
