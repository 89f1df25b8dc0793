#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

struct TimeOffsetParameters {
  double time_offset_sigma_s = 0.05;
};
void visit(FieldVisitor& f, TimeOffsetParameters& p) {
  f.number("time_offset_sigma_s", p.time_offset_sigma_s, {1e-6, 10},
           "1-sigma of what fixes are stamped too early or late, where it is estimated");
}

/// A fix stamped t tells of t plus this in the IMU's time, s: a constant. It is seen where the vehicle moves.
class TimeOffset final : public StateBlock {
 public:
  explicit TimeOffset(const TimeOffsetParameters& p) : sigma_s_(p.time_offset_sigma_s) {}
  int size() const override { return 1; }
  double variance(int) const override { return sigma_s_ * sigma_s_; }

 private:
  double sigma_s_;
};

}  // namespace

std::unique_ptr<StateBlock> make_time_offset(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<TimeOffset>(own.get<TimeOffsetParameters>());
}

void time_offset_parameters(ModelParameters& section) {
  section.add<TimeOffsetParameters>();
}

}  // namespace canyon::fusion
