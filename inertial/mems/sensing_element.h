#pragma once

#include <cstdint>
#include <string>

#include "canyon/core/random/random.h"
#include "canyon/inertial/mems/element_model.h"
#include "canyon/inertial/mems/integrator.h"

namespace canyon::inertial {

/// One axis of a MEMS sensor, sample by sample: mechanics, pick-off, front end, anti-alias filter, and the integral of
/// the filter's output over the sample, which is the increment that a digital sensor gives.
///
/// While nothing is hit, all of it is one linear system and one exact step per sample, however far the resonance lies
/// above the sample rate; the input counts as constant within a sample. The pick-off's curve acts on the sample's mean,
/// the front end's limit on the reading without the curve. Where the mass could reach its stops or the front end its
/// limit, the sample is gone through in short steps (32 to a period of the resonance), with stops that give back
/// `kRestitution` of the speed and a front end that clips before the filter: so an overload leaves the ringing and the
/// filter's tail behind that a real one does.
class SensingElement {
 public:
  static constexpr double kRestitution = 0.5;

  /// `electronics_n`: white noise of the electronics at the filter's input, N in the input's unit / sqrt(Hz), beside
  /// the pick-off's. Draws come from `stream`, entity `axis`.
  SensingElement(ElementModel model, double electronics_n, const std::string& integrator, double step_s,
                 RandomStream stream, std::uint32_t axis);

  /// At rest in a constant input, without noise.
  void settle(double u);
  /// Integral of the output over sample k, in which the mean input was u.
  double advance(std::int64_t k, double u);

  /// State of the mechanics (element_model.h).
  Eigen::VectorXd mechanics_state() const { return state_.head(model_.mechanics.size()); }
  /// What a sample of the reading itself, without filter and averaging, would be.
  double reading() const { return (model_.mechanics.C * mechanics_state())(0); }
  /// Gain from the input to the output at a frequency, the filter's included, the averaging over the sample not.
  double gain(double frequency_hz) const;
  /// What a sample leaves at least of any earlier state: e^(-step / longest time constant). 1 or more: the integrator
  /// diverges at this step.
  double memory_per_step() const;
  /// Samples gone through in short steps so far.
  std::int64_t overloads() const { return overloads_; }

 private:
  bool may_hit(double u) const;
  double advance_linear(std::int64_t k, double u);
  double advance_in_short_steps(std::int64_t k, double u);
  double limited(double reading) const;

  ElementModel model_;
  double step_s_, sample_noise_;
  RandomStream stream_;
  std::uint32_t axis_;
  LinearPlant filter_;  ///< empty (no states) without a filter
  DiscretePlant whole_, short_mechanics_, short_filter_;
  Eigen::MatrixXd whole_root_, mechanics_root_, filter_root_;
  int short_steps_;
  Eigen::VectorXd state_;  ///< mechanics, filter, integral
  std::int64_t overloads_ = 0;
};

}  // namespace canyon::inertial
