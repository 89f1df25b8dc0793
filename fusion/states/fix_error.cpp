#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

struct FixErrorParameters {
  double fix_error_sigma_m = 3.0;
  double fix_error_tau_s = 10.0;
};
void visit(FieldVisitor& f, FixErrorParameters& p) {
  f.number("fix_error_sigma_m", p.fix_error_sigma_m, {1e-6, 1e4}, "1-sigma per axis of the errors of fixes that last");
  f.number("fix_error_tau_s", p.fix_error_tau_s, {1e-3, 1e9}, "their correlation time");
}

/// The part of the fixes' errors that lasts from one to the next, as of multipath, along E's axes, m: a Gauss-Markov
/// process.
class FixError final : public StateBlock {
 public:
  explicit FixError(const FixErrorParameters& p) : p_(p) {}
  int size() const override { return 3; }
  double variance(int) const override { return p_.fix_error_sigma_m * p_.fix_error_sigma_m; }
  StateProcess process(int state) const override {
    return StateProcess::gauss_markov(variance(state), p_.fix_error_tau_s);
  }

 private:
  FixErrorParameters p_;
};

}  // namespace

std::unique_ptr<StateBlock> make_fix_error(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<FixError>(own.get<FixErrorParameters>());
}

void fix_error_parameters(ModelParameters& section) {
  section.add<FixErrorParameters>();
}

}  // namespace canyon::fusion
