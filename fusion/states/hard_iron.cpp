#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

struct HardIronParameters {
  double hard_iron_sigma_ut = 5.0;
};
void visit(FieldVisitor& f, HardIronParameters& p) {
  f.number("hard_iron_sigma_ut", p.hard_iron_sigma_ut, {1e-6, 1e4},
           "1-sigma per axis of the vehicle's own magnetic field, where it is estimated");
}

/// The field of the vehicle's iron in U, microtesla: a constant. It is seen where the vehicle turns.
class HardIron final : public StateBlock {
 public:
  explicit HardIron(const HardIronParameters& p) : sigma_ut_(p.hard_iron_sigma_ut) {}
  int size() const override { return 3; }
  double variance(int) const override { return sigma_ut_ * sigma_ut_; }

 private:
  double sigma_ut_;
};

}  // namespace

std::unique_ptr<StateBlock> make_hard_iron(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<HardIron>(own.get<HardIronParameters>());
}

void hard_iron_parameters(ModelParameters& section) {
  section.add<HardIronParameters>();
}

}  // namespace canyon::fusion
