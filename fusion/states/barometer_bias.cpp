#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

struct BarometerBiasParameters {
  double barometer_bias_sigma_m = 50.0;
  double barometer_bias_tau_s = 7200.0;
};
void visit(FieldVisitor& f, BarometerBiasParameters& p) {
  f.number("barometer_bias_sigma_m", p.barometer_bias_sigma_m, {1e-3, 1e4},
           "1-sigma of weather, sensor and geoid in the barometer's height");
  f.number("barometer_bias_tau_s", p.barometer_bias_tau_s, {1, 1e9}, "its correlation time");
}

/// What the height of the standard atmosphere at the measured pressure is above the ellipsoidal one, m: weather, the
/// sensor's own offset and the geoid, as a Gauss-Markov process.
class BarometerBias final : public StateBlock {
 public:
  explicit BarometerBias(const BarometerBiasParameters& p) : p_(p) {}
  int size() const override { return 1; }
  double variance(int) const override { return p_.barometer_bias_sigma_m * p_.barometer_bias_sigma_m; }
  StateProcess process(int state) const override {
    return StateProcess::gauss_markov(variance(state), p_.barometer_bias_tau_s);
  }

 private:
  BarometerBiasParameters p_;
};

}  // namespace

std::unique_ptr<StateBlock> make_barometer_bias(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<BarometerBias>(own.get<BarometerBiasParameters>());
}

void barometer_bias_parameters(ModelParameters& section) {
  section.add<BarometerBiasParameters>();
}

}  // namespace canyon::fusion
