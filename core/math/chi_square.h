#pragma once

namespace canyon {

/// Probability that a chi-square variable of `dof` degrees of freedom, not necessarily whole, exceeds x. dof >= 0.5; x
/// < 0 counts as 0. Regularised incomplete gamma function, series or continued fraction (Abramowitz &
/// Stegun 6.5.29, 6.5.31), relative error < 1e-12.
double chi_square_tail(double x, double dof);

/// The x that a chi-square variable of `dof` degrees of freedom exceeds with the given probability, in (0, 1).
double chi_square_threshold(double probability, double dof);

}  // namespace canyon
