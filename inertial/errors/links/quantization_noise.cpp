#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/block_noise.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// White noise of the integrated output (angle or velocity), which is how the quantization of an integrating sensor
/// looks from afar and what an Allan fit calls Q: the increment's error is Q (n_(k+1) - n_k), whose sum over any time
/// is one difference of two. A property of the sensor's own rate: Q does not scale with the sample interval.
class QuantizationNoise {
 public:
  explicit QuantizationNoise(const TriadSetup& s)
      : stream_(s.unit.seed, s.name + ".quantization_noise"), q_(s.figures.quantization_noise) {}
  static bool needed(const TriadFigures& f) { return f.quantization_noise > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) {
    noise_.add_to(block, triad.output, [this](std::int64_t number, AxisArrays& errors) {
      std::array<double, kImuBlock + 1> n;
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        stream_.fill_normal(n, axis, static_cast<std::uint64_t>(number) * kImuBlock);
        for (std::size_t i = 0; i < kImuBlock; ++i) errors[axis][i] += q_ * (n[i + 1] - n[i]);
      }
    });
  }

 private:
  RandomStream stream_;
  double q_;
  BlockNoise noise_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_quantization_noise(const LinkSetup& setup) {
  return make_for_both_triads<QuantizationNoise>(setup);
}

}  // namespace canyon::inertial
