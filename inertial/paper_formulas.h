#pragma once

/// The inertial formulas of Durst & Goodin 2012, section 2.2: each as printed, and as it should be where that differs.
/// What follows from each slip is shown in tests/inertial/paper_formulas_test.cpp.
namespace canyon::inertial {

/// sigma_aT = sqrt(4 k_B T omega_0 / (m Q)): the accelerometer's thermal noise, m/s^2/sqrt(Hz).
/// The formula is right (Gabrielson 1993), but it is a density: the paper adds a draw of that size to every sample
/// whatever the rate, so its noise power depends on the rate. Here it is used as what it is, a one-sided density; N of
/// IEEE Std 952, the root of the two-sided one, is 1 / sqrt(2) of it.
double accel_thermal_density(double temperature_k, double omega_0_rad_s, double mass_kg, double quality_factor);

/// sigma_gT = (Q / k) sqrt(4 k_B T R B), as printed.
/// Despite its use as an error of the angular rate this is a displacement: sqrt(4 k_B T R B) is a force in newtons (R
/// in kg/s), and Q / k turns it into the proof mass's motion at resonance, in METRES (Annovazzi-Lodi & Merlo 1999).
double gyro_thermal_as_printed_m(double quality_factor, double stiffness_n_m, double temperature_k,
                                 double resistance_kg_s, double bandwidth_hz);

/// The rate whose Coriolis force 2 m Omega omega_0 x_d equals the thermal force sqrt(4 k_B T R), R = m omega_0 / Q:
///   sqrt(k_B T / (m omega_0 Q)) / x_d,  rad/s/sqrt(Hz),
/// with x_d the amplitude of the drive motion: N of IEEE Std 952, the root of a two-sided density, after demodulation
/// (inertial/mems/element_model.h). This is the rate-equivalent form of the quantity the paper prints.
double gyro_thermal_density(double temperature_k, double omega_0_rad_s, double mass_kg, double quality_factor,
                            double drive_amplitude_m);

/// sigma_quant = 0.01745 sqrt(3 Q^2 / t), as printed: Q "the sensor's quality factor", t "the total run time, in
/// hours". The Allan variance of quantization noise is 3 Q^2 / tau^2 (IEEE Std 952, C.1.6): tau is the averaging time,
/// not the run time; it is squared; and Q is the quantization coefficient (an angle), not the resonator's quality
/// factor. 0.01745 is radians per degree. As printed a sensor grows less noisy the longer it is run. The corrected link
/// (in the chain "paper") adds to each increment the difference of two successive white errors of standard deviation Q,
/// whose Allan variance is 3 Q^2 / tau^2.
double quantization_as_printed(double quality_factor, double run_time_hr);

/// The recursion sigma(t) = sigma(t-1) / tau + sigma_0, as printed, driven by two draws.
/// 1/tau stands where exp(-dt/tau) belongs. So the process diverges for tau < 1 s; and for tau > 1 s its correlation
/// time is dt / ln(tau): 3.5 ms at tau = 10 s and 125 Hz, in place of 10 s. The corrected form is
/// inertial/errors/markov_process.h.
double recursion_as_printed(double previous, double tau_s, double sigma_0);
/// dt / ln(tau), s; infinite at tau = 1, negative (divergence) below.
double recursion_correlation_time_s(double tau_s, double dt_s);

}  // namespace canyon::inertial
