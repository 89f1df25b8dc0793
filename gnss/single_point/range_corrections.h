#pragma once

#include <string>
#include <vector>

#include "gnss/atmosphere/klobuchar.h"
#include "gnss/satellites/constellation.h"
#include "gnss/single_point/code_choice.h"
#include "gnss/sky_view.h"

namespace canyon::gnss {

/// Delay at L1, m, that a named model subtracts; `klobuchar` are the coefficients of the satellite's ionosphere.
/// Elevations below 5 deg are held there.
std::vector<std::string> ionosphere_corrections_of_observations();
double ionosphere_correction_m(const std::string& model, const KlobucharCoefficients& klobuchar, const SkyView& view);

/// none | saastamoinen_niell (standard atmosphere, ladder of gnss/atmosphere) | saastamoinen_cosecant: zenith delays of
/// a standard atmosphere with 70 % humidity over sin(elevation), as RTKLIB has it.
std::vector<std::string> troposphere_corrections_of_observations();
double troposphere_correction_m(const std::string& model, const SkyView& view);

/// Pseudorange and satellite clock of what is used: one signal, or the ionosphere-free combination of two.
struct CodeMeasurement {
  double pseudorange_m = kNaN;
  double phase_m = kNaN;      ///< carrier phase of the same, with an unknown constant
  double hz = kNaN;           ///< of the signal; of the first one of two
  double noise_factor = 1.0;  ///< 1-sigma of the combination over that of one signal
};
/// a P1 - b P2 with a = f1^2 / (f1^2 - f2^2), b = a - 1.
CodeMeasurement single_measurement(const SignalObservation& signal, SatelliteId sv, int frequency_channel);
CodeMeasurement ionosphere_free_measurement(const SignalPair& pair, SatelliteId sv, int frequency_channel);

}  // namespace canyon::gnss
