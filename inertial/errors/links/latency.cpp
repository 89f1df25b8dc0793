#include <cmath>
#include <vector>

#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// A sample stamped t holds the motion over (t - d - dt, t - d]: with d = (m + f) dt, the increments f x_(k-m-1) + (1 -
/// f) x_(k-m), exact for a motion that is constant over a sample.
class Latency final : public ErrorLink {
 public:
  explicit Latency(const LinkSetup& setup) {
    const double samples = setup.figures.latency_s / setup.dt_s;
    whole_ = static_cast<std::size_t>(samples);
    fraction_ = samples - static_cast<double>(whole_);
  }

  void apply(ImuBlock& block) override {
    const std::size_t memory = whole_ + 1;
    for (std::size_t t = 0; t < 2; ++t) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        auto& past = past_[t][axis];
        auto& x = block.triads[t].truth[axis];
        if (block.first != next_) past.assign(memory, x[0]);
        past.insert(past.end(), x.begin(), x.begin() + static_cast<std::ptrdiff_t>(block.count));
        for (std::size_t i = 0; i < block.count; ++i) x[i] = fraction_ * past[i] + (1.0 - fraction_) * past[i + 1];
        past.erase(past.begin(), past.end() - static_cast<std::ptrdiff_t>(memory));
        block.triads[t].output[axis] = x;
      }
    }
    next_ = block.first + static_cast<std::int64_t>(block.count);
  }
  std::int64_t memory() const override { return static_cast<std::int64_t>(whole_) + 1; }

 private:
  std::size_t whole_;
  double fraction_;
  std::int64_t next_ = -1;
  std::array<std::array<std::vector<double>, 3>, 2> past_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_latency(const LinkSetup& setup) {
  if (setup.figures.latency_s == 0.0) return nullptr;
  return std::make_unique<Latency>(setup);
}

}  // namespace canyon::inertial
