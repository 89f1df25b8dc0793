#include <algorithm>
#include <array>

#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// The stamp of sample k is off by skew (k + 1) dt + jitter n_(k+1), and its interval by what that changes from the
/// sample before: the motion is that of the true interval. Jitter is held within a quarter of an interval.
class Clock final : public ErrorLink {
 public:
  explicit Clock(const LinkSetup& setup)
      : dt_s_(setup.dt_s),
        skew_(setup.figures.clock_skew * RandomStream(setup.seed, "imu.clock.skew").normal(0, 0)),
        jitter_(setup.seed, "imu.clock.jitter"),
        jitter_s_(setup.figures.clock_jitter_s) {}

  void apply(ImuBlock& block) override {
    std::array<double, kImuBlock + 1> jitter_s{};
    if (jitter_s_ > 0.0) {
      jitter_.fill_normal(std::span(jitter_s).first(block.count + 1), 0, static_cast<std::uint64_t>(block.first));
      for (double& x : jitter_s) x = std::clamp(jitter_s_ * x, -0.25 * dt_s_, 0.25 * dt_s_);
    }
    for (std::size_t i = 0; i < block.count; ++i) {
      const auto stamp = static_cast<double>(block.first + static_cast<std::int64_t>(i) + 1);
      ImuSample& sample = block.samples[i];
      sample.t = sample.t + (skew_ * dt_s_ * stamp + jitter_s[i + 1]);
      sample.dt_s += skew_ * dt_s_ + (jitter_s[i + 1] - jitter_s[i]);
    }
  }

 private:
  double dt_s_, skew_;
  RandomStream jitter_;
  double jitter_s_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_clock(const LinkSetup& setup) {
  if (setup.figures.clock_skew == 0.0 && setup.figures.clock_jitter_s == 0.0) return nullptr;
  return std::make_unique<Clock>(setup);
}

}  // namespace canyon::inertial
