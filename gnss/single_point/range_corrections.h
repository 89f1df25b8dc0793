#pragma once

#include "canyon/core/model_table.h"
#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/satellites/constellation.h"
#include "canyon/gnss/single_point/code_choice.h"
#include "canyon/gnss/sky_view.h"

namespace canyon::gnss {

/// What is subtracted for the ionosphere: nothing, GPS's coefficients for all, each system's own where it sends some,
/// or maps.
enum class IonosphereCorrection { kNone, kKlobuchar, kKlobucharOwn, kIonex };
ModelTable<IonosphereCorrection> ionosphere_corrections();
bool is_klobuchar(IonosphereCorrection model);

/// Klobuchar's delay at L1, m, with the coefficients of a system by that system's own formula: BeiDou's
/// (gnss/atmosphere/beidou_klobuchar.h), else that of GPS. Elevations below 5 deg are held there.
double klobuchar_correction_m(GnssSystem system, const KlobucharCoefficients& coefficients, const SkyView& view);

/// What is subtracted for the troposphere, m.
using TroposphereCorrection = double(const SkyView& view);
ModelTable<TroposphereCorrection> troposphere_corrections();

/// Pseudorange and satellite clock of what is used: one signal, or the ionosphere-free combination of two.
struct CodeMeasurement {
  double pseudorange_m = kNaN;
  double phase_m = kNaN;      ///< carrier phase of the same, with an unknown constant
  double hz = kNaN;           ///< of the signal; of the first one of two; NaN for a GLONASS channel not known
  double noise_factor = 1.0;  ///< 1-sigma of the combination over that of one signal
};
/// Of a GLONASS satellite whose channel is not known, phase and hz are NaN.
CodeMeasurement single_measurement(const SignalObservation& signal, SatelliteId sv, int frequency_channel);
CodeMeasurement ionosphere_free_measurement(const SignalPair& pair, SatelliteId sv, int frequency_channel);

}  // namespace canyon::gnss
