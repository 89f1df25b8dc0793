#include <array>
#include <complex>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/mems/element_model.h"
#include "canyon/inertial/mems/integrator.h"
#include "canyon/inertial/mems/sensing_element.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using stress::kEpsilon;
using Complex = std::complex<long double>;

constexpr double kTemperature_k = 300.0;

ElementFigures figures_of(double resonance_hz, double quality) {
  ElementFigures f;
  f.resonance_hz = resonance_hz;
  f.quality_factor = quality;
  f.pick_off = "piezoresistive";  // does not pull
  return f;
}

LinearPlant mechanics(double resonance_hz, double quality) {
  return accelerometer_model(figures_of(resonance_hz, quality), kTemperature_k)->mechanics;
}

/// The two rates of m x'' + (m w / Q) x' + m w^2 x = 0, over w.
std::array<Complex, 2> rates_over_w(double quality) {
  const long double damping = 0.5L / quality;
  const Complex root = std::sqrt(Complex(damping * damping - 1.0L, 0.0L));
  return {-damping + root, -damping - root};
}

/// The exact step against the closed form: from displacement and from velocity, in 64 bits of mantissa; and its noise
/// against equipartition, P = phi P phi' + covariance with P = k T / m in w x and in x'.
///
/// A short step of |A| h below 1/2 is a sum of 24 terms with 15 roundings of up to an epsilon, and each doubling adds
/// two; doubling repeats what was wrong before it, so that all is 17 epsilons for each short step, beside four of |A| h
/// for the resonance itself, of what is left of the motion: e^(slowest rate h), at critical damping (1 + w h)^2 of it.
/// The noise sums what is left at shorter times too, where |A| t e^(2 slowest rate t) is largest; and its own terms,
/// none of them negative, an epsilon for each doubling and ten for the series.
StressFigure exact(double resonance_hz, double quality, double step_s) {
  const LinearPlant plant = mechanics(resonance_hz, quality);
  const DiscretePlant step = exact_step(plant, step_s);
  const long double angle = 2.0L * std::numbers::pi_v<long double> * resonance_hz * step_s;
  const auto [a, b] = rates_over_w(quality);
  const Complex ea = std::exp(a * angle), eb = std::exp(b * angle);
  const bool critical = quality == 0.5;
  const Complex from_x = critical ? (1.0L + angle) * ea : (a * eb - b * ea) / (a - b);
  const Complex from_v = critical ? angle * ea : (ea - eb) / (a - b);

  const double norm = static_cast<double>(angle) * (1.0 + 1.0 / quality);
  const double doublings = beyond(std::ceil(std::log2(4.0 * norm)), 0.0);
  const double roundings = kEpsilon * (17.0 * std::exp2(doublings) + 4.0 * norm);
  const double overlap = critical ? 1.0 + static_cast<double>(angle) : 1.0;
  const double left = std::max(1e-290, static_cast<double>(std::abs(ea)) * overlap * overlap);
  stress::Worst worst;
  worst.look(step.phi(0, 0) - static_cast<double>(from_x.real()), roundings * left);
  worst.look(step.phi(0, 1) - static_cast<double>(from_v.real()), roundings * left);

  const double thermal = kBoltzmann * kTemperature_k / figures_of(1.0, 1.0).mass_kg;
  const Eigen::Matrix2d P = thermal * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d miss = step.phi * P * step.phi.transpose() + step.covariance - P;
  const double fade = 2.0 * static_cast<double>(-a.real() * angle);
  // A unit input held over the step moves w x to 1 / w of what a displacement has lost.
  const double w = 2.0 * kPi * resonance_hz;
  worst.look(step.gamma(0) * w - static_cast<double>(1.0L - from_x.real()),
             (10.0 + doublings) * kEpsilon + 2.0 * overlap * roundings / std::max(1.0, 0.5 * fade));
  worst.look(miss.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / thermal,
             (10.0 + doublings) * kEpsilon + 2.0 * roundings / std::max(1.0, fade));
  return worst.figure();
}

long double rk4_factor(const Complex& z) {
  return std::abs(1.0L + z * (1.0L + z / 2.0L * (1.0L + z / 3.0L * (1.0L + z / 4.0L))));
}

/// The longest step over w at which |R(lambda h)| <= 1 for both rates, by halving.
double rk4_border_over_w(double quality) {
  const auto rates = rates_over_w(quality);
  const long double fastest = worse(std::abs(rates[0]), std::abs(rates[1]));
  long double low = 1.0L / fastest, high = 4.0L / fastest;
  for (int i = 0; i < 80; ++i) {
    const long double y = 0.5L * (low + high);
    (worse(rk4_factor(rates[0] * y), rk4_factor(rates[1] * y)) <= 1.0L ? low : high) = y;
  }
  return static_cast<double>(low);
}

/// Where 256 steps of rk4 make ten times of a displacement. At 1 % beyond the border |R| is at least 1.01 (its slope
/// there is 2.5 for a ringing mass, 1.6 and more for a damped one, in units of lambda h of 2.8), which makes 13.
StressFigure rk4_border(double resonance_hz, double quality) {
  const LinearPlant plant = mechanics(resonance_hz, quality);
  const double border_s = rk4_border_over_w(quality) / (2.0 * kPi * resonance_hz);
  double low_s = 0.3 * border_s, high_s = 3.0 * border_s;
  for (int i = 0; i < 50; ++i) {
    const double h = 0.5 * (low_s + high_s);
    const Eigen::MatrixXd phi = runge_kutta_4_step(plant, h).phi;
    Eigen::Vector2d state(1.0, 0.0);
    for (int k = 0; k < 256; ++k) state = (phi * state).eval();
    (state.norm() < 10.0 ? low_s : high_s) = h;
  }
  return {std::abs(low_s / border_s - 1.0), 0.01};
}

/// What a step multiplies its slowest state by, beyond 1, over the whole grid.
StressFigure implicit_growth(DiscretizePlant* scheme) {
  double growth = 0.0;
  for (const double hz : {10.0, 5e3, 1e6})
    for (const double quality : {0.1, 0.5, 10.0, 1e6})
      for (const double step_s : {1e-5, 1e-3, 0.1, 1.0})
        growth = worse(growth, spectral_radius(scheme(mechanics(hz, quality), step_s).phi) - 1.0);
  return {growth, 20.0 * kEpsilon};
}

/// The slow amplitude of a gyroscope's sense mode turns by the split and fades by its damping: phi = e^(-g h) times a
/// turn by d h, to ten epsilons of d h.
StressFigure gyroscope(double quality, double split_hz, double step_s) {
  ElementFigures f = figures_of(10000.0, quality);
  f.split_hz = split_hz;
  f.drive_amplitude_m = 5e-6;
  const DiscretePlant step = exact_step(gyroscope_model(f, kTemperature_k)->mechanics, step_s);
  const long double turn = 2.0L * std::numbers::pi_v<long double> * split_hz * step_s;
  const long double left = std::exp(-std::numbers::pi_v<long double> * 10000.0L / quality * step_s);
  stress::Worst worst;
  const double stiff = std::max(1.0, static_cast<double>(turn) + std::numbers::pi * 1e4 / quality * step_s);
  const double bound = 10.0 * kEpsilon * stiff * std::max(1e-290, static_cast<double>(left));
  worst.look(step.phi(0, 0) - static_cast<double>(left * std::cos(turn)), bound);
  worst.look(step.phi(1, 0) - static_cast<double>(left * std::sin(turn)), bound);
  return worst.figure();
}

/// 50 g on an element that clips at 10 g, 0.2 s long, then rest: what comes out is never more than the clip after the
/// pick-off's curve, and returns. Noise is 1e-3 of it at most; six of its sigmas are let through.
StressFigure overload(double resonance_hz, double quality) {
  ElementFigures f = figures_of(resonance_hz, quality);
  f.range = 10.0;
  f.filter_order = 0;
  const ElementModel model = *accelerometer_model(f, kTemperature_k);
  const double step_s = 0.01, most = std::abs(model.characteristic(model.clip));
  const double noise = 6.0 * std::hypot(model.pick_off_n, model.thermal_n) / std::sqrt(step_s);
  SensingElement element(model, 0.0, "exact", step_s, RandomStream(1, "stress"), 0);
  double largest = 0.0, last = 0.0;
  for (std::int64_t k = 0; k < 40; ++k) {
    last = element.advance(k, k < 20 ? 50.0 * kStandardGravity : 0.0) / step_s;
    largest = worse(largest, std::abs(last));
  }
  stress::Worst worst;
  worst.look(largest, (most + noise) * (1.0 + 10.0 * kEpsilon));
  worst.look(element.overloads() >= 20 ? 0.0 : stress::kInfinity, 1.0);
  const double thermal = std::sqrt(kBoltzmann * kTemperature_k / f.mass_kg) * 2.0 * kPi * resonance_hz;
  worst.look(last, noise + 6.0 * thermal);  // of one reading at an instant, whatever its spectrum
  return worst.figure();
}

/// An element without noise worth speaking of, at rest in u: it stays there, its output u times the step, with a filter
/// and without, whichever integrator; a step from nothing comes to it and is forgotten as fast as it says. Stops and
/// clips hold at their values.
StressFigure element_at_rest(int order, const std::string& integrator) {
  ElementFigures figures;
  figures.pick_off = "piezoresistive";
  figures.pick_off_figures.strain_cubic = 0.0;
  figures.pick_off_figures.bridge_ohm = 1e-6;
  figures.mass_kg = 1e3;  // thermal noise: 1e-9 of the input
  figures.quality_factor = 0.7;
  figures.resonance_hz = 5000.0;
  figures.filter_order = order;
  figures.bandwidth_hz = 40.0;
  auto model = accelerometer_model(figures, 300.0);
  if (!model) return {stress::kInfinity, 1.0};
  model->filter_order = order;
  model->bandwidth_hz = 40.0;
  model->pick_off_n = 0.0;
  const double step_s = integrator == "exact" ? 0.01 : 2e-5;  // an explicit one diverges from 9e-5 s on
  stress::Worst worst;
  SensingElement settled(*model, 0.0, integrator, step_s, RandomStream(5, "stress.mems"), 0);
  settled.settle(9.81);
  for (int k = 0; k < 50; ++k) worst.look(settled.advance(k, 9.81) / (9.81 * step_s) - 1.0, 1e-6);
  SensingElement stepped(*model, 0.0, integrator, step_s, RandomStream(5, "stress.mems"), 1);
  const double memory = stepped.memory_per_step();
  worst.look(memory < 1.0 ? 0.0 : stress::kInfinity, 1.0);
  const int steps = static_cast<int>(std::ceil(std::log(1e-9) / std::log(std::max(memory, 1e-300)))) + 2;
  double last = 0.0;
  for (int k = 0; k < steps; ++k) last = stepped.advance(k, 5.0);
  worst.look(last / (5.0 * step_s) - 1.0, 1e-6);
  worst.look(stepped.gain(1e-6) - 1.0, 1e-9);
  // Half the power at the corner, where the mass itself has (40 / 5000)^2 more or less.
  if (order > 0) worst.look(stepped.gain(40.0) / std::sqrt(0.5) - 1.0, 2.0 * std::pow(40.0 / 5000.0, 2));
  return worst.figure();
}

}  // namespace

std::vector<StressCase> proof_mass_cases() {
  const auto group = StressGroup::kStiff;
  const StressMechanism stiff{
      group, "a resonance times a step",
      "an explicit step diverges; Van Loan's matrix over the whole step holds e^(+A h) and has no digits left; a "
      "damped "
      "scheme swallows the thermal noise",
      "the closed form to 17 epsilons for each of the short steps that it doubles, and equipartition: the noise "
      "restores "
      "what the step damps",
      "of the bound"};
  const StressMechanism border{
      group, "an explicit scheme's border of stability",
      "a stability limit for undamped masses is used for damped ones",
      "256 steps make ten times of a displacement within 1 % of |R(lambda h)| = 1 at the plant's own rates", ""};
  const StressMechanism implicit{group, "an implicit scheme at any stiffness",
                                 "a sign in I - A h makes it explicit, or its inverse loses its digits",
                                 "no state grows, from 6e-4 to 6e7 radians a step, to 20 roundings of the inverse", ""};
  const StressMechanism slow{group, "a slow amplitude beside its carrier",
                             "the carrier is integrated, or the split turns the wrong way",
                             "the closed form to ten epsilons of the angle", "of the bound"};
  const StressMechanism clip{StressGroup::kData, "an overload that rings",
                             "beyond the clip the linear step goes on and rings for thousands of samples",
                             "no sample exceeds what the clip leaves, and the reading returns: six sigmas of the noise",
                             "of the bound"};
  StressRows rows;
  for (const double hz : {10.0, 5e3, 1e6})
    for (const double quality : {0.1, 0.5, 1e6})
      for (const double step_s : {1e-5, 1e-2, 1.0})
        rows.of(stiff).add("proof_mass/" + stress::text(hz) + "_hz_q_" + stress::text(quality) + "_step_" +
                               stress::text(step_s) + "_s",
                           [=] { return exact(hz, quality, step_s); });
  for (const double hz : {10.0, 1e6})
    for (const double quality : {0.1, 0.5, 10.0, 1e6})
      rows.of(border).add("proof_mass/rk4_border_" + stress::text(hz) + "_hz_q_" + stress::text(quality),
                          [=] { return rk4_border(hz, quality); });
  rows.of(implicit).add("proof_mass/implicit_midpoint_never_grows",
                        [] { return implicit_growth(implicit_midpoint_step); });
  rows.of(implicit).add("proof_mass/backward_euler_never_grows", [] { return implicit_growth(backward_euler_step); });
  rows.of(slow).add("proof_mass/gyroscope_matched_modes", [] { return gyroscope(1e4, 0.0, 0.01); });
  rows.of(slow).add("proof_mass/gyroscope_split_1000_hz_step_1_s", [] { return gyroscope(1e6, 1000.0, 1.0); });
  rows.of(clip).add("proof_mass/50_g_on_10_g_damped", [] { return overload(1000.0, 0.5); });
  rows.of(clip).add("proof_mass/50_g_on_10_g_ringing", [] { return overload(1000.0, 100.0); });
  rows.of({StressGroup::kStiff, "a sensing element at rest and after a step",
           "a filter of no order, a step that is not forgotten", "the input, times the step", "of the bound"});
  for (const int order : {0, 1, 2, 4})
    rows.add("imu/element_of_order_" + std::to_string(order), [order] { return element_at_rest(order, "exact"); });
  for (const char* integrator : {"backward_euler", "implicit_midpoint", "rk4"})
    rows.add(std::string("imu/element_by_") + integrator, [integrator] { return element_at_rest(2, integrator); });
  return rows.take();
}

}  // namespace canyon::inertial
