#pragma once

#include <span>
#include <vector>

namespace canyon::study {

/// Order at which values of three steps h1 > h2 > h3 converge, from their differences e12 = |f1 - f2|, e23 = |f2 - f3|
/// alone, so that no reference can fake it (Roache, Verification and Validation in Computational Science and
/// Engineering, 1998, section 5.10; for steps of unequal ratio the equation of Celik et al., J. Fluids Eng. 130 (2008)
/// 078001, eq. 3, as ASME V&V 20-2009 has it, solved by bisection: its fixed point diverges where r12 is much larger
/// than r23). Negative where differences grow as steps fall: the values go apart. -30 or 30 where they do so faster
/// than that; NaN only where a difference is not above `rounding`.
double observed_order(double h1, double h2, double h3, double e12, double e23, double rounding);

/// What the finest of two values at steps h1 > h2 still errs: e12 / ((h1 / h2)^p - 1) (Richardson 1911; Roache 1998,
/// eq. 5.3.2). NaN unless p > 0.
double richardson_error(double h1, double h2, double e12, double order);

/// What the last of a series without steps still errs, if its differences go on to fall as the last two did: e23 q / (1
/// - q), q = e23 / e12. NaN unless they fall.
double extrapolated_error(double e12, double e23);

}  // namespace canyon::study
