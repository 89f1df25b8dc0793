#pragma once

#include <functional>
#include <limits>

#include "canyon/core/result.h"
#include "canyon/inertial/mems/linear_plant.h"
#include "canyon/inertial/mems/mems_figures.h"

namespace canyon::inertial {

/// A sensing element as equations: mechanics from the input (m/s^2 or rad/s) to what the pick-off reads, in the input's
/// unit and calibrated at rest; then the electronics. Per axis.
struct ElementModel {
  LinearPlant mechanics;                                  ///< thermally excited; state 0 is what meets the stops
  double stop = std::numeric_limits<double>::infinity();  ///< of |state 0|
  double clip = std::numeric_limits<double>::infinity();  ///< of |reading|
  double fastest_hz = 0.0;                                ///< resonance of the mechanics as they are written here
  std::function<double(double)> characteristic;           ///< static curve of the pick-off, reading to reading
  double thermal_n = 0.0;   ///< N of the mechanics far below resonance, input's unit / sqrt(Hz)
  double pick_off_n = 0.0;  ///< N of the pick-off
  double low_corner_hz = 0.0;
  double bandwidth_hz = 0.0;
  int filter_order = 0;
};

/// m x'' + (m w0 / Q) x' + (m w0^2 + k_e) x = m a + F, with k_e the pick-off's pull and F white of two-sided density
/// 2 k_B T m w0 / Q (fluctuation-dissipation). States: w x and x', w^2 = w0^2 + k_e / m; the output is w^2 x.
/// An Error where the pick-off pulls the mass in.
Result<ElementModel> accelerometer_model(const ElementFigures& figures, double temperature_k);

/// A Coriolis vibratory gyroscope: the sense mode y of resonance w, Q, driven by -2 Omega x_drive' while the drive
/// mode swings with amplitude x_d at w - split. Carried as the slow complex amplitude of y = Re(A e^(j w_d t)), the
/// rotating-wave form, good to 1/Q and split / resonance:
///   a' = (-g + j d) a + Omega + noise,  a = A / (j x_d),  g = w / (2 Q),  d = 2 pi split,
/// with noise of two-sided density k_B T / (m w Q x_d^2) in each part. Output: Re(a (g - j d)), the demodulator in the
/// phase that reads a constant rate as itself. Matched modes (d = 0) are a low-pass of corner g; split ones resonate at
/// the split.
Result<ElementModel> gyroscope_model(const ElementFigures& figures, double temperature_k);

}  // namespace canyon::inertial
