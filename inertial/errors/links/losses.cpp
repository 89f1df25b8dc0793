#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// Samples go missing `loss_length` at a time and are repeated from the last one that came, as drivers do. Groups of
/// that many samples are lost where their own draw says so and the group before was not drawn, so that a loss never
/// lasts longer; of all samples p (1 - p) = loss_share are lost.
class Losses final : public ErrorLink {
 public:
  explicit Losses(const LinkSetup& setup)
      : stream_(setup.seed, "imu.losses"), length_(std::llround(setup.figures.loss_length)) {
    const double share = setup.figures.loss_share;
    CANYON_CHECK(share < 0.25 && length_ > 0, "loss_share = ", share, ", loss_length = ", length_);
    drawn_ = 0.5 * (1.0 - std::sqrt(1.0 - 4.0 * share));
  }

  void apply(ImuBlock& block) override {
    for (std::size_t i = 0; i < block.count; ++i) {
      const std::int64_t k = block.first + static_cast<std::int64_t>(i);
      const bool lost = k == next_ && is_lost(k / length_);
      block.samples[i].lost = lost;
      for (std::size_t t = 0; t < 2; ++t) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          double& output = block.triads[t].output[axis][i];
          double& last = last_[t][axis];
          if (lost) {
            output = last;
          } else {
            last = output;
          }
        }
      }
      next_ = k + 1;
    }
  }
  std::int64_t memory() const override { return length_ + 1; }

 private:
  bool drawn(std::int64_t group) const { return stream_.uniform(0, static_cast<std::uint64_t>(group)) < drawn_; }
  bool is_lost(std::int64_t group) {
    if (group != group_) {
      group_ = group;
      group_is_lost_ = group > 0 && drawn(group) && !drawn(group - 1);
    }
    return group_is_lost_;
  }

  RandomStream stream_;
  std::int64_t length_;
  double drawn_;
  std::int64_t group_ = -1;  // the one that was last looked at
  bool group_is_lost_ = false;
  std::int64_t next_ = -1;
  std::array<std::array<double, 3>, 2> last_{};
};

}  // namespace

std::unique_ptr<ErrorLink> make_losses(const LinkSetup& setup) {
  if (setup.figures.loss_share == 0.0) return nullptr;
  return std::make_unique<Losses>(setup);
}

}  // namespace canyon::inertial
