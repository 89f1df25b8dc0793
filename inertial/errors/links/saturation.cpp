#include <algorithm>

#include "canyon/inertial/errors/error_link.h"

namespace canyon::inertial {
namespace {

/// The mean over each interval stays within +- range. What an element does while it is overloaded within an interval is
/// the business of the proof-mass models.
class Saturation {
 public:
  explicit Saturation(const TriadSetup& s) : increment_(s.figures.range * s.unit.dt_s) {}
  static bool needed(const TriadFigures& f) { return f.range > 0.0; }
  void apply(const ImuBlock& block, TriadBlock& triad) const {
    for (auto& axis : triad.output) {
      for (std::size_t i = 0; i < block.count; ++i) axis[i] = std::clamp(axis[i], -increment_, increment_);
    }
  }

 private:
  double increment_;
};

}  // namespace

std::unique_ptr<ErrorLink> make_saturation(const LinkSetup& setup) {
  return make_for_both_triads<Saturation>(setup);
}

}  // namespace canyon::inertial
