#pragma once

namespace canyon::gnss {

/// Thermal noise, 1-sigma, of a carrier tracking loop (Kaplan & Hegarty 2006, sections 5.6.1 and 5.6.2).
/// Phase-lock loop of noise bandwidth B, predetection T: sqrt(B / (C/N0) (1 + 1 / (2 T C/N0))).
double carrier_phase_noise_rad(double cn0_dbhz, double carrier_loop_hz, double integration_s);
/// Its frequency: sqrt(4 B / (C/N0) (1 + 1 / (T C/N0))) / (2 pi T).
double doppler_noise_hz(double cn0_dbhz, double carrier_loop_hz, double integration_s);

}  // namespace canyon::gnss
