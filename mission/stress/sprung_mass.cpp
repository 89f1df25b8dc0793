#include "canyon/mission/motion/sprung_mass.h"

#include <complex>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using stress::kEpsilon;
using Complex = std::complex<long double>;

struct Response {
  double x, v_over_w;
};
/// Height and velocity of a sprung mass after the road under it has stepped up by 1, at an angle w t: with y = x - 1
/// free from y = -1, y' = 2 zeta w, written with its two poles, in 64 bits of mantissa.
Response step_response(long double zeta, long double angle) {
  const Complex root = std::sqrt(Complex(zeta * zeta - 1.0L)), a = -zeta + root, b = -zeta - root;
  const Complex ea = std::exp(a * angle), eb = std::exp(b * angle);
  if (zeta == 1.0L) {  // one pole twice: y = (-1 + w t) e^(-w t)
    const long double e = std::exp(-angle);
    return {static_cast<double>(1.0L + (angle - 1.0L) * e), static_cast<double>((2.0L - angle) * e)};
  }
  const Complex c = (2.0L * zeta + b) / (a - b), d = -1.0L - c;
  return {static_cast<double>((1.0L + c * ea + d * eb).real()), static_cast<double>((c * a * ea + d * b * eb).real())};
}

/// A step rounds what it carries, of size 1 + 2 zeta, by eight epsilons, and knows its angle w h to eight; errors live
/// as long as the slower pole does. All far below the 1e-9 that is asked for. The shortest step is that of the largest
/// imu.rate_hz.
StressFigure step_of_the_road(double hz, double zeta, double step_s) {
  const double w = 2.0 * kPi * hz;
  const double slow = w * (zeta <= 1.0 ? zeta : zeta - std::sqrt(zeta * zeta - 1.0));
  SprungMass mass(w, zeta, 0.0);
  mass.advance(1.0, 1.0, step_s);
  stress::Worst worst;
  const int steps = static_cast<int>(4.0 / step_s);
  for (int k = 1; k <= steps; ++k) {
    const Response exact = step_response(zeta, 2.0L * std::numbers::pi_v<long double> * hz * step_s * k);
    const double alive = 1.0 + std::min<double>(k, 1.0 / (slow * step_s));
    const double bound = 8.0 * kEpsilon * (1.0 + w * step_s) * (1.0 + 2.0 * zeta) * alive;
    if (bound > 1e-9) return {stress::kInfinity, 1.0};
    worst.look(mass.state().x - exact.x, bound);
    worst.look(mass.state().v / w - exact.v_over_w, bound);
    mass.advance(1.0, step_s);
  }
  return worst.figure();
}

/// Undamped, what is in it stays: (x - u)^2 + (v / w)^2. An epsilon of each of the four terms of a step, all the same
/// way at worst, twice in the square, as many times as there are steps.
StressFigure undamped_energy(int steps) {
  const double w = 2.0 * kPi * 1.6, step_s = 0.01;
  SprungMass mass(w, 0.0, 0.0);
  mass.advance(1.0, 1.0, step_s);
  for (int k = 0; k < steps; ++k) mass.advance(1.0, step_s);
  const SprungMass::State& s = mass.state();
  const double energy = (s.x - 1.0) * (s.x - 1.0) + s.v * s.v / (w * w);
  return {std::abs(energy - 1.0), 8.0 * kEpsilon * steps};
}

/// On an even road nothing moves, to the bit, at 60 m above W's origin.
StressFigure rest(int steps) {
  SprungMass mass(2.0 * kPi * 5.0, 2.0, 60.123);
  double worst = 0.0;
  for (int k = 0; k < steps; ++k) {
    const SprungMass::State& s = mass.advance(60.123, 0.01);
    for (const double error : {s.x - 60.123, s.v, s.a}) worst = worse(worst, std::abs(error));
  }
  return {worst, 0.0};
}

/// Steps of 1e-9 to 1e9 radians and dampings to 1000: y never leaves what a road that has stepped by 1 can make of it,
/// 1 + 2 zeta / (2 zeta) and e times that at most, and the velocity 2 zeta w.
StressFigure beyond_its_range() {
  stress::Worst worst;
  for (const double angle : {1e-9, 1e-3, 1.0, 1e3, 1e6, 1e9})
    for (const double zeta : {0.0, 0.05, 1.0, 2.0, 1000.0}) {
      SprungMass mass(1.0, zeta, 0.0);
      mass.advance(1.0, 1.0, angle);
      for (int k = 0; k < 50; ++k) {
        const SprungMass::State& s = mass.advance(1.0, angle);
        const double slack = 1.0 + 100.0 * kEpsilon * (1.0 + zeta * angle);
        worst.look(s.x - 1.0, 2.0 * slack);
        worst.look(s.v, (1.0 + 2.0 * zeta) * slack);
        worst.look(std::isfinite(s.a) ? 0.0 : stress::kInfinity, 1.0);
      }
    }
  int passed = 0;
  passed += stress::not_refused([] { SprungMass(0.0, 1.0, 0.0); });
  passed += stress::not_refused([] { SprungMass(1.0, -0.1, 0.0); });
  passed += stress::not_refused([] { SprungMass(std::nan(""), 1.0, 0.0); });
  passed += stress::not_refused([] { SprungMass(1.0, 1.0, 0.0).advance(0.0, 0.0); });
  worst.look(passed, 0.5);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> sprung_mass_cases() {
  const StressMechanism stiff{
      StressGroup::kStiff, "a spring's stiffness and damping times its step",
      "the explicit step's spectral radius is 1.42 at 5 Hz, damping 2 and 100 Hz (2026-11-22: the vehicle was "
      "thousands of "
      "kilometres off, or a library aborted)",
      "the closed form of a sprung mass over a step of the road, to eight roundings for each step that the slower pole "
      "remembers, below 1e-9 everywhere",
      "of the bound"};
  StressMechanism energy{StressGroup::kLong, "energy over a million steps, and over a day",
                         "a scheme that damps or feeds what it ought to keep",
                         "that of the beginning to eight epsilons a step", ""};
  energy.loose = "the bound lets all roundings go the same way";
  const StressMechanism still{StressGroup::kLong, "rest over a million steps, and over a day",
                              "the difference of two heights of 60 m creeps", "not a bit moves", "m"};
  const StressMechanism beyond{
      StressGroup::kStiff, "hyperbolic functions of large arguments",
      "cosh overflows where its decay would have made it 1",
      "bounded by what the road's step can make of it, from 1e-9 to 1e9 radians a step; what is no spring is refused",
      "of the bound"};
  StressRows rows;
  for (const double hz : {0.3, 1.6, 5.0})
    for (const double zeta : {0.05, 0.6, 1.0, 2.0})
      for (const double step_s : {0.0002, 0.001, 0.01, 0.1})
        rows.of(stiff).add("sprung_mass/" + stress::text(hz) + "_hz_damping_" + stress::text(zeta) + "_step_" +
                               stress::text(step_s) + "_s",
                           [=] { return step_of_the_road(hz, zeta, step_s); });
  constexpr int kMillion = 1'000'000, kDay = 8'640'000;  // of 10 ms
  rows.of(energy)
      .add("sprung_mass/undamped_energy_1e6_steps", [] { return undamped_energy(kMillion); })
      .add("sprung_mass/undamped_energy_of_a_day", [] { return undamped_energy(kDay); });
  rows.of(still).add("sprung_mass/rest_1e6_steps", [] { return rest(kMillion); }).add("sprung_mass/rest_of_a_day", [] {
    return rest(kDay);
  });
  rows.of(beyond).add("sprung_mass/beyond_its_range", beyond_its_range);
  return rows.take();
}

}  // namespace canyon::mission
