#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/receiver_clock.h"

namespace canyon::gnss {
namespace {

constexpr double kH0 = 2e-19;       // s, white frequency noise
constexpr double kHMinus2 = 2e-20;  // 1/s, random-walk frequency noise
constexpr double kStartBiasS = 1e-6;
constexpr double kStartRate = 1e-7;

class Tcxo final : public ReceiverClock {
 public:
  explicit Tcxo(const ReceiverClockParameters& p) : draws_(p.seed, "gnss.receiver_clock"), interval_s_(p.interval_s) {
    CANYON_CHECK(interval_s_ > 0.0, "interval_s = ", interval_s_);
    // Cholesky factor of the two-state process noise over one interval.
    const double white = 0.5 * kH0, walk = 2.0 * kPi * kPi * kHMinus2, dt = interval_s_;
    bias_bias_ = std::sqrt(white * dt + walk * dt * dt * dt / 3.0);
    rate_bias_ = 0.5 * walk * dt * dt / bias_bias_;
    rate_rate_ = std::sqrt(walk * dt - rate_bias_ * rate_bias_);
    restart();
  }

  double offset_m(std::int64_t index) override {
    go_to(index);
    return kSpeedOfLight * bias_s_;
  }
  double rate_m_s(std::int64_t index) override {
    go_to(index);
    return kSpeedOfLight * rate_;
  }

 private:
  void go_to(std::int64_t index) {
    CANYON_CHECK(index >= 0, "index = ", index);
    if (index < index_) restart();
    while (index_ < index) step();
  }
  void restart() {
    index_ = 0;
    bias_s_ = kStartBiasS * draws_.normal(0, 0);
    rate_ = kStartRate * draws_.normal(1, 0);
  }
  void step() {
    ++index_;
    const auto sample = static_cast<std::uint64_t>(index_);
    const double w0 = draws_.normal(0, sample), w1 = draws_.normal(1, sample);
    bias_s_ += interval_s_ * rate_ + bias_bias_ * w0;
    rate_ += rate_bias_ * w0 + rate_rate_ * w1;
  }

  RandomStream draws_;
  double interval_s_;
  double bias_bias_ = 0.0, rate_bias_ = 0.0, rate_rate_ = 0.0;
  std::int64_t index_ = 0;
  double bias_s_ = 0.0, rate_ = 0.0;
};

}  // namespace

std::unique_ptr<ReceiverClock> make_tcxo(const ReceiverClockParameters& p) {
  return std::make_unique<Tcxo>(p);
}

}  // namespace canyon::gnss
