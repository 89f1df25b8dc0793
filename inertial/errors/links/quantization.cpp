#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// The output register holds a whole number of steps of rate or specific force: rounded to the nearest, halves to even.
/// What is rounded off is not carried to the next sample; sensors that carry it show `quantization_noise` instead.
class Quantization {
 public:
  explicit Quantization(const TriadSetup& s)
      : step_(s.figures.resolution * s.unit.dt_s), steps_per_increment_(1.0 / step_) {}
  static bool needed(const TriadFigures& f) { return f.resolution > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    // Adding 1.5 * 2^52 leaves no bits for a fraction: rounds numbers below 2^51.
    constexpr double kRound = 6755399441055744.0;
    for (auto& axis : triad.output) {
      for (std::size_t i = 0; i < block.count; ++i) {
        axis[i] = step_ * ((axis[i] * steps_per_increment_ + kRound) - kRound);
      }
    }
  }

 private:
  double step_, steps_per_increment_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_quantization(const LinkSetup& setup) {
  return make_for_both_triads<Quantization>(setup);
}

}  // namespace canyon::inertial
