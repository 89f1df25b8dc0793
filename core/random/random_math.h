#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

/// The arithmetic from random bits to numbers, shared by the scalar and the batch form of RandomStream. Only + - * /
/// sqrt and bit operations, without branches: every step is exactly rounded by IEEE 754, so that the same bits come out
/// of scalar and vector code on every machine (contraction to fused multiply-add is off in the whole build). A private
/// header of core/.
namespace canyon::random_math {

/// A number below 2^52 as double, exactly; unlike a conversion, it exists in every vector instruction set.
inline double exact_double(std::uint64_t k) {
  constexpr double kTwo52 = 4503599627370496.0;
  return std::bit_cast<double>(k | std::bit_cast<std::uint64_t>(kTwo52)) - kTwo52;
}

/// The upper 53 bits of the 64-bit word (high, low) times 2^-53: a uniform number in [0, 1). Both products and the sum
/// are exact.
inline double uniform53(std::uint64_t low, std::uint64_t high) {
  return exact_double(high) * 0x1p-32 + exact_double(low >> 11) * 0x1p-53;
}

/// The same shifted into (0, 1]: never zero, so its logarithm is finite (at least -36.7).
inline double uniform53_above_zero(std::uint64_t low, std::uint64_t high) {
  return exact_double(high) * 0x1p-32 + (exact_double(low >> 11) + 1.0) * 0x1p-53;
}

/// Natural logarithm of a normal positive number; relative error below 1e-15.
inline double log_positive(double x) {
  // x = 2^e m with m in [sqrt(1/2), sqrt(2)): subtracting sqrt(1/2)'s bits moves the exponent's step to there.
  constexpr std::uint64_t kSqrtHalfBits = 0x3FE6A09E667F3BCD;
  constexpr std::uint64_t kBias = 2048;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t biased = (bits - kSqrtHalfBits + (kBias << 52)) >> 52;  // e + 2048, modulo 4096
  const double m = std::bit_cast<double>(bits - (biased << 52) + (kBias << 52));
  const double e = exact_double(biased) - static_cast<double>(kBias);

  // ln m = 2 atanh(s); with |s| <= 0.1716 the first term left out, z^11 / 23, is 6e-19 of the sum.
  const double s = (m - 1.0) / (m + 1.0);
  const double z = s * s;
  double tail = 1.0 / 21.0;
  tail = tail * z + 1.0 / 19.0;
  tail = tail * z + 1.0 / 17.0;
  tail = tail * z + 1.0 / 15.0;
  tail = tail * z + 1.0 / 13.0;
  tail = tail * z + 1.0 / 11.0;
  tail = tail * z + 1.0 / 9.0;
  tail = tail * z + 1.0 / 7.0;
  tail = tail * z + 1.0 / 5.0;
  tail = tail * z + 1.0 / 3.0;
  const double twice = s + s;
  const double ln_m = twice + twice * (z * tail);

  // ln 2 in two parts; the first has 41 bits, so that its product with e is exact.
  constexpr double kLn2High = 0x1.62e42fefa3p-1;
  constexpr double kLn2Low = 0x1.3de6af278ece6p-42;
  return e * kLn2High + (ln_m + e * kLn2Low);
}

struct SineCosine {
  double sine;
  double cosine;
};

/// Sine and cosine of 2 pi u for u in [0, 1]; error below 3e-16.
inline SineCosine sin_cos_turns(double u) {
  // u = q / 4 + r with |r| <= 1/8, both exactly: adding 1.5 * 2^52 rounds 4 u to a whole number, kept in the low bits.
  constexpr double kRound = 6755399441055744.0;
  const double shifted = 4.0 * u + kRound;
  const std::uint64_t q = std::bit_cast<std::uint64_t>(shifted);
  const double r = u - 0.25 * (shifted - kRound);

  // Taylor series in r, coefficients (2 pi)^k / k!; the first terms left out are 9e-20 and 3e-18 at |r| = 1/8.
  const double z = r * r;
  double sine = 0x1.aaec32af93359p-4;
  sine = sine * z - 0x1.6fadb9f155744p-1;
  sine = sine * z + 0x1.e8f434d018d63p+1;
  sine = sine * z - 0x1.e3074fde8871fp+3;
  sine = sine * z + 0x1.50783487ee782p+5;
  sine = sine * z - 0x1.32d2cce62bd86p+6;
  sine = sine * z + 0x1.466bc6775aae2p+6;
  sine = sine * z - 0x1.4abbce625be53p+5;
  sine = r * 0x1.921fb54442d18p+2 + r * (z * sine);
  double cosine = 0x1.20c62c2f2d7f5p-2;
  cosine = cosine * z - 0x1.b6e24f44b128fp+0;
  cosine = cosine * z + 0x1.f9d38a3763cc3p+2;
  cosine = cosine * z - 0x1.a6d1f2a204a8cp+4;
  cosine = cosine * z + 0x1.e1f506891babbp+5;
  cosine = cosine * z - 0x1.55d3c7e3cbffap+6;
  cosine = cosine * z + 0x1.03c1f081b5ac4p+6;
  cosine = cosine * z - 0x1.3bd3cc9be45dep+4;
  cosine = 1.0 + z * cosine;

  // Turn by q quarters: odd quarters exchange the two, quarters 2 and 3 negate the sine, 1 and 2 the cosine.
  const std::uint64_t s = std::bit_cast<std::uint64_t>(sine);
  const std::uint64_t c = std::bit_cast<std::uint64_t>(cosine);
  const std::uint64_t exchange = (s ^ c) & (0 - (q & 1));
  const std::uint64_t sine_sign = (q & 2) << 62;
  const std::uint64_t cosine_sign = ((q + 1) & 2) << 62;
  return {std::bit_cast<double>(s ^ exchange ^ sine_sign), std::bit_cast<double>(c ^ exchange ^ cosine_sign)};
}

/// Radius of Box-Muller's pair, from u1 in (0, 1].
inline double box_muller_radius(double u1) {
  return std::sqrt(-2.0 * log_positive(u1));
}

}  // namespace canyon::random_math
