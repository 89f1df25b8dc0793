#pragma once

namespace canyon {

/// Static pressure of the standard atmosphere (ISO 2533) at a geopotential height above mean sea level, pascal. Valid
/// in the troposphere, -2000 to 11000 m; clamped to it outside.
double standard_pressure_pa(double height_m);

/// The height at which the standard atmosphere has that pressure, m; its inverse.
double standard_height_m(double pressure_pa);

}  // namespace canyon
