#pragma once

#include "canyon/fusion/error_state.h"
#include "canyon/fusion/measurements/measurement.h"

namespace canyon::fusion {

/// H P; what H does not know costs nothing.
Measurement::Rows rows_of(const Measurement::Rows& H, const ErrorMatrix& P);

/// (H P) H', symmetric.
Measurement::Square times_transposed(const Measurement::Rows& HP, const Measurement::Rows& H);

/// Whether what is measured was known better than the noise by so much that P may hold nothing of it but rounding.
/// `predicted` is H P H'.
bool nearly_exact(const Measurement& m, const Measurement::Square& predicted);

/// Of what an earlier measurement without noise has told, P holds rounding, which may have no part in a correction: no
/// row of H P is larger than its own variance and that of the other state allow (Cauchy & Schwarz). What is beyond
/// counts as noise in m.R, with all of that row's part in H P H'.
void count_rounding(Measurement& m, const Measurement::Rows& HP, const Measurement::Square& predicted,
                    const ErrorMatrix& P);

}  // namespace canyon::fusion
