#include <algorithm>

#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// Temperature at t of a piecewise linear profile, constant outside.
double temperature_at(const Environment& e, double t_s) {
  const auto& times = e.temperature_times_s;
  const auto next = std::upper_bound(times.begin(), times.end(), t_s);
  if (next == times.begin()) return e.temperatures_c.front();
  if (next == times.end()) return e.temperatures_c.back();
  const auto i = static_cast<std::size_t>(next - times.begin());
  const double share = (t_s - times[i - 1]) / (times[i] - times[i - 1]);
  return e.temperatures_c[i - 1] + share * (e.temperatures_c[i] - e.temperatures_c[i - 1]);
}

/// Bias and gain in proportion to the distance from the reference temperature; the coefficient of each axis is normal
/// with the figure of the sheet. Temperature is taken in the middle of the sample's interval.
class Temperature {
 public:
  explicit Temperature(const TriadSetup& s)
      : environment_(s.unit.environment),
        reference_c_(s.unit.figures.reference_temperature_c),
        dt_s_(s.unit.dt_s),
        bias_(s.figures.bias_temperature * dt_s_ * RandomStream(s.unit.seed, s.name + ".bias_temperature").normal3(0)),
        gain_(s.figures.scale_temperature * RandomStream(s.unit.seed, s.name + ".scale_temperature").normal3(0)) {}
  static bool needed(const TriadFigures& f) { return f.bias_temperature > 0.0 || f.scale_temperature > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    for (std::size_t i = 0; i < block.count; ++i) {
      const double t_s = (static_cast<double>(block.first) + (static_cast<double>(i) + 0.5)) * dt_s_;
      const double above_k = temperature_at(environment_, t_s) - reference_c_;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        triad.output[axis][i] += above_k * (bias_[a] + gain_[a] * triad.truth[axis][i]);
      }
    }
  }

 private:
  Environment environment_;
  double reference_c_, dt_s_;
  Eigen::Vector3d bias_, gain_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_temperature(const LinkSetup& setup) {
  if (setup.environment.temperatures_c.empty()) return nullptr;
  return make_for_both_triads<Temperature>(setup);
}

}  // namespace canyon::inertial
