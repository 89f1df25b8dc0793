#pragma once

/// Loops of the propagation over plain rows. `width` is a multiple of 4; rows do not overlap unless said.
namespace canyon::fusion {

/// A StepJacobian as plain numbers, 3 x 3 matrices row by row.
struct StepCoefficients {
  double dt_s;
  double theta_theta[9], theta_gyro[9];
  double v_theta[9], v_p[9], v_v[9], v_accel[9], v_gyro[9];
};

/// One term of the IMU's error: row `axis` gets `rate` times row `state`.
struct FeedTerm {
  int axis;
  int state;
  double rate;
};

/// Rows are at most so wide.
inline constexpr int kMostStates = 128;

/// Integrals of the IMU's error, 15 rows: I_1g, I_2g, I_3g - dt / 2 I_2g, I_1a, I_2a - dt / 2 I_1a.
inline constexpr int kIntegralRows = 15;

/// integrals (rows of `width`) += what `count` terms make of the rows of `errors` (`stride` apart), all of whose states
/// keep carried[k] of themselves in I_(k+1).
void add_integrals(const FeedTerm* terms, int count, const double* carried, double dt_s, const double* errors,
                   int stride, double* integrals, int width);

/// The nine rows [theta, p, v] after the step, from those before it (`stride` apart) and the integrals.
void move_rows(const StepCoefficients& step, const double* before, int stride, const double* integrals, double* after,
               int width);

/// rows(i, :) += sum_k left(i, k) right(k, :), k < 3, for `count` rows of `width`, of which left has three columns.
void add_products(double* rows, int count, int width, const double* left, const double* right);

/// rows(i, j) *= factor[i] factor[j] for `count` rows, `stride` apart, and as many columns.
void scale_both(double* rows, int stride, int count, const double* factor);

}  // namespace canyon::fusion
