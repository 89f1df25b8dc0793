#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

struct AntennaLeverParameters {
  double antenna_lever_sigma_m = 0.1;
};
void visit(FieldVisitor& f, AntennaLeverParameters& p) {
  f.number("antenna_lever_sigma_m", p.antenna_lever_sigma_m, {1e-6, 100},
           "1-sigma per axis of the antenna's place in the vehicle, where it is estimated");
}

/// What the antenna's place in B, m, is off the one that the filter was told: a constant. Without turns it cannot be
/// told from the vehicle's own place.
class AntennaLever final : public StateBlock {
 public:
  explicit AntennaLever(const AntennaLeverParameters& p) : sigma_m_(p.antenna_lever_sigma_m) {}
  int size() const override { return 3; }
  double variance(int) const override { return sigma_m_ * sigma_m_; }

 private:
  double sigma_m_;
};

}  // namespace

std::unique_ptr<StateBlock> make_antenna_lever(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<AntennaLever>(own.get<AntennaLeverParameters>());
}

void antenna_lever_parameters(ModelParameters& section) {
  section.add<AntennaLeverParameters>();
}

}  // namespace canyon::fusion
