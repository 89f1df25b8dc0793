#pragma once

#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/sky_view.h"

namespace canyon::gnss {

/// BeiDou's own form of the Klobuchar model (BDS-SIS-ICD-B1I 3.0, 5.2.4.7), for the coefficients of its D1 and D2
/// messages: slant delay at B1I (1561.098 MHz), m. Unlike in GPS's form, the pierce point lies on a shell of 375 km,
/// its geographic latitude (not the geomagnetic one) enters the polynomials, the cosine is not developed into a series,
/// the period is held to 72000..172800 s, and the mapping is that of the shell. Elevation in [0, pi/2].
double beidou_klobuchar_delay_m(const KlobucharCoefficients& coefficients, const SkyView& view);

}  // namespace canyon::gnss
