#include "canyon/core/units.h"
#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

struct MountingParameters {
  double mounting_sigma_deg = 1.0;
  double mounting_walk_deg_per_sqrt_hr = 0.1;
};
void visit(FieldVisitor& f, MountingParameters& p) {
  f.number("mounting_sigma_deg", p.mounting_sigma_deg, {1e-6, 45}, "1-sigma of the IMU's axes against the vehicle's");
  f.number("mounting_walk_deg_per_sqrt_hr", p.mounting_walk_deg_per_sqrt_hr, {0, 45},
           "how they wander, as load shifts");
}

/// Rotation vector m of the axes of the vehicle in those of the IMU, rad: R_UB = Exp(m). Wheels see it about the axes
/// y and z; about x it stays as unsure as the start is.
class Mounting final : public StateBlock {
 public:
  explicit Mounting(const MountingParameters& p)
      : sigma_(p.mounting_sigma_deg * kDegree), walk_(p.mounting_walk_deg_per_sqrt_hr * kDegree / 60.0) {}
  int size() const override { return 3; }
  double variance(int) const override { return sigma_ * sigma_; }
  StateProcess process(int) const override { return {.density = walk_ * walk_}; }

 private:
  double sigma_, walk_;
};

}  // namespace

std::unique_ptr<StateBlock> make_mounting(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<Mounting>(own.get<MountingParameters>());
}

void mounting_parameters(ModelParameters& section) {
  section.add<MountingParameters>();
}

}  // namespace canyon::fusion
