#include "canyon/inertial/aiding/odometer.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"

namespace canyon::inertial {
namespace {

/// More slip than this is not rolling any more.
constexpr double kLargestSlip = 0.9;

/// Composite Simpson's rule: the mean of f over equally spaced nodes.
template <class F>
double mean_over(std::span<const KinematicState> nodes, F f) {
  double sum = f(nodes.front()) + f(nodes.back());
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(nodes[i]);
  return sum / (3.0 * static_cast<double>(nodes.size() - 1));
}

MarkovProcess slip_process(const OdometerConfig& config, std::uint64_t seed) {
  return MarkovProcess::gauss_markov(seed, "odometer.slip", 0, 0.01 * config.slip_percent, config.slip_tau_s,
                                     1.0 / config.rate_hz);
}

}  // namespace

void visit(FieldVisitor& f, OdometerConfig& c) {
  f.number("rate_hz", c.rate_hz, {0.1, 1000}, "samples per second");
  f.vector3("wheel_m", c.wheel_m, {-100, 100}, "contact point of the wheel in the body frame");
  f.number("metres_per_tick", c.metres_per_tick, {1e-6, 100}, "of the nominal wheel");
  f.number("scale_percent", c.scale_percent, {0, 50}, "error of the wheel's radius, 1-sigma");
  f.number("slip_percent", c.slip_percent, {0, 50}, "slip at steady speed, 1-sigma");
  f.number("slip_tau_s", c.slip_tau_s, {1e-3, 1e9}, "correlation time of that slip");
  f.number("slip_percent_per_m_s2", c.slip_percent_per_m_s2, {0, 20}, "slip that acceleration needs");
}

void Odometer::draw_anew(std::uint64_t noise_seed) {
  slip_ = slip_process(config_, noise_seed);
}

Odometer::Odometer(const OdometerConfig& config, std::uint64_t seed)
    : config_(config),
      scale_(0.01 * config.scale_percent * RandomStream(seed, "odometer.scale").normal(0, 0)),
      slip_(slip_process(config, seed)),
      turned_ticks_(RandomStream(seed, "odometer.phase").uniform(0, 0)) {}

Odometer::Reading Odometer::sample(std::int64_t k, std::span<const KinematicState> nodes) {
  CANYON_CHECK(k == next_, "sample ", k, " asked for, ", next_, " is next");
  CANYON_CHECK(nodes.size() >= 3 && nodes.size() % 2 == 1, "nodes = ", nodes.size());
  ++next_;
  const double dt_s = nodes.back().t - nodes.front().t;
  const auto forward_m_s = [&](const KinematicState& s) {
    return (s.X_WB.R.conjugate() * s.v_WB_W + s.w_WB_B.cross(config_.wheel_m)).x();
  };
  const auto forward_m_s2 = [&](const KinematicState& s) { return (s.X_WB.R.conjugate() * s.a_WB_W).x(); };

  Reading r;
  r.truth.t = r.message.t = nodes.back().t;
  r.truth.distance_m = dt_s * mean_over(nodes, forward_m_s);
  r.truth.scale_error = scale_;
  // Traction pulls the way the vehicle accelerates, whichever way it rolls.
  const double direction = r.truth.distance_m < 0.0 ? -1.0 : 1.0;
  const double traction = 0.01 * config_.slip_percent_per_m_s2 * direction * mean_over(nodes, forward_m_s2);
  r.truth.slip = std::clamp(slip_.at(k).x() + traction, -kLargestSlip, kLargestSlip);

  const double before = std::floor(turned_ticks_);
  turned_ticks_ += r.truth.distance_m / (1.0 - r.truth.slip) * (1.0 + scale_) / config_.metres_per_tick;
  r.message.dt_s = dt_s;
  r.message.ticks = static_cast<std::int64_t>(std::floor(turned_ticks_) - before);
  r.message.speed_m_s = static_cast<double>(r.message.ticks) * config_.metres_per_tick / dt_s;
  return r;
}

}  // namespace canyon::inertial
