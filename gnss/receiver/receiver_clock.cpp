#include "canyon/gnss/receiver/receiver_clock.h"

namespace canyon::gnss {
namespace {

class PerfectClock final : public ReceiverClock {
 public:
  double offset_m(std::int64_t) override { return 0.0; }
  double rate_m_s(std::int64_t) override { return 0.0; }
  bool perfect() const override { return true; }
};

std::unique_ptr<ReceiverClock> make_perfect_clock(const ReceiverClockParameters&) {
  return std::make_unique<PerfectClock>();
}

constexpr ModelRow<MakeReceiverClock> kClocks[] = {
    {"none", without_keys<make_perfect_clock>, "the receiver knows GPS time exactly"},
    {"tcxo", without_keys<make_tcxo>, "two-state clock of a temperature-compensated crystal"},
};

}  // namespace

ModelTable<MakeReceiverClock> receiver_clock_models() {
  return kClocks;
}

}  // namespace canyon::gnss
