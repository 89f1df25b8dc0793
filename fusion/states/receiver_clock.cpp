#include "canyon/fusion/states/receiver_clock.h"

#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

struct ReceiverClockParameters {
  double clock_sigma_m = 100.0;
  double clock_rate_sigma_m_s = 300.0;
  double clock_walk_m_per_sqrt_s = 0.1;
  double clock_rate_walk_m_s_per_sqrt_s = 0.1;
  double system_time_sigma_m = 100.0;
};
void visit(FieldVisitor& f, ReceiverClockParameters& p) {
  f.number("clock_sigma_m", p.clock_sigma_m, {1e-3, 1e6},
           "1-sigma of the receiver's clock once the first epoch has set it");
  f.number("clock_rate_sigma_m_s", p.clock_rate_sigma_m_s, {1e-3, 1e6}, "1-sigma of its rate at the start");
  f.number("clock_walk_m_per_sqrt_s", p.clock_walk_m_per_sqrt_s, {0, 1e3}, "its white noise of frequency");
  f.number("clock_rate_walk_m_s_per_sqrt_s", p.clock_rate_walk_m_s_per_sqrt_s, {0, 1e3},
           "its random walk of frequency");
  f.number("system_time_sigma_m", p.system_time_sigma_m, {1e-3, 1e6},
           "1-sigma of the time of each other system against that of GPS, in this receiver");
}

/// The clock of the receiver, m, and its rate, m/s (two states, van Dierendonck, McGraw & Brown 1984), and what each
/// other system's pseudoranges are longer by, m, constants.
class ReceiverClock final : public StateBlock {
 public:
  explicit ReceiverClock(const ReceiverClockParameters& p) : p_(p) {}
  int size() const override { return ClockIndex::kSize; }
  double variance(int state) const override {
    const double sigma = state == ClockIndex::kClock  ? p_.clock_sigma_m
                         : state == ClockIndex::kRate ? p_.clock_rate_sigma_m_s
                                                      : p_.system_time_sigma_m;
    return sigma * sigma;
  }
  StateProcess process(int state) const override {
    const double walk = state == ClockIndex::kClock  ? p_.clock_walk_m_per_sqrt_s
                        : state == ClockIndex::kRate ? p_.clock_rate_walk_m_s_per_sqrt_s
                                                     : 0.0;
    return {.density = walk * walk};
  }
  int integral_of(int state) const override { return state == ClockIndex::kClock ? ClockIndex::kRate : -1; }

 private:
  ReceiverClockParameters p_;
};

}  // namespace

std::unique_ptr<StateBlock> make_receiver_clock(const ModelParameters& own, const StateSetup&) {
  return std::make_unique<ReceiverClock>(own.get<ReceiverClockParameters>());
}

void receiver_clock_parameters(ModelParameters& section) {
  section.add<ReceiverClockParameters>();
}

}  // namespace canyon::fusion
