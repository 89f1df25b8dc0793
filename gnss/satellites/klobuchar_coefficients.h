#pragma once

#include <array>

namespace canyon::gnss {

/// Coefficients of the broadcast ionosphere model (IS-GPS-200 20.3.3.5.2.5), as transmitted: s, s/semicircle, ...
struct KlobucharCoefficients {
  std::array<double, 4> alpha{};
  std::array<double, 4> beta{};
};

/// What the built-in constellation broadcasts: the coefficients of 1 July 2010 (solar minimum), IGS file brdc1820.10n.
inline constexpr KlobucharCoefficients kBuiltInKlobuchar{{0.4657e-8, 0.1490e-7, -0.5960e-7, -0.1192e-6},
                                                         {0.8192e5, 0.8192e5, -0.6554e5, -0.5243e6}};

/// Whether messages can hold such coefficients, with room: alpha up to 2^-17, beta up to 2^23 in 8 bits.
bool is_sane(const KlobucharCoefficients& coefficients);

}  // namespace canyon::gnss
