#include <cmath>

#include "canyon/inertial/errors/block_noise.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/errors/white_draws.h"

namespace canyon::inertial {
namespace {

/// Defined per root hertz: the sum of increments over t has variance N^2 t, at any sample rate. A sensor whose low-pass
/// reaches beyond one sample shares each draw between neighbours, (n_k + a n_(k+1)) / (1 + a), which correlates them by
/// a / (1 + a^2) and leaves the sum over many as it was; a figure of the sensor at its own rate.
class WhiteNoise {
 public:
  explicit WhiteNoise(const TriadSetup& s)
      : stream_(s.unit.noise_seed.value_or(s.unit.seed), s.name + ".white"),
        share_(share(s.figures.neighbour_correlation)),
        sigma_increment_(s.figures.white_per_sqrt_hz * std::sqrt(s.unit.dt_s) / (1.0 + share_)) {}
  static bool needed(const TriadFigures& f) { return f.white_per_sqrt_hz > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) {
    noise_.add_to(block, triad.output, [this](std::int64_t number, AxisArrays& errors) {
      if (share_ == 0.0) return add_white(stream_, sigma_increment_, number, errors);
      std::array<double, kImuBlock + 1> n;
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        stream_.fill_normal(n, axis, static_cast<std::uint64_t>(number) * kImuBlock);
        for (std::size_t i = 0; i < kImuBlock; ++i) errors[axis][i] += sigma_increment_ * (n[i] + share_ * n[i + 1]);
      }
    });
  }

 private:
  /// a of rho = a / (1 + a^2).
  static double share(double rho) { return rho > 0.0 ? (1.0 - std::sqrt(1.0 - 4.0 * rho * rho)) / (2.0 * rho) : 0.0; }

  RandomStream stream_;
  double share_, sigma_increment_;
  BlockNoise noise_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_white_noise(const LinkSetup& setup) {
  return make_for_both_triads<WhiteNoise>(setup);
}

}  // namespace canyon::inertial
