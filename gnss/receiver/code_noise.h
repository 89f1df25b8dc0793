#pragma once

namespace canyon::gnss {

/// 1-sigma thermal noise of a code tracking loop per metre of its value at 45 dB-Hz.
///
/// Early-minus-late power discriminator, infinite bandwidth (Kaplan & Hegarty 2006, section 5.6.3, after Betz &
/// Kolodziejski 2000): sigma ~ sqrt(B d / (2 C/N0) (1 + 2 / (T C/N0 (2 - d)))), d early to late in chips, T = 20 ms.
/// The loop bandwidth cancels here; 0.3 m at 45 dB-Hz and d = 0.5 is B = 0.13 Hz, a carrier-aided loop.
double relative_code_noise(double cn0_dbhz, double spacing_chips);

}  // namespace canyon::gnss
