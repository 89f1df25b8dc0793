#include "canyon/study/results/paired_errors.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace canyon::study {

namespace {

/// 97.5 % quantile of Student's t: Cornish-Fisher expansion about the normal's (Abramowitz & Stegun 26.7.5), within 1 %
/// from 3 degrees of freedom on; the first two are exact.
double student_975(int degrees) {
  if (degrees == 1) return 12.7062;
  if (degrees == 2) return 4.30265;
  const double z = 1.959963985, n = degrees;
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

/// Calls visit(time since the start, by how much b's error is the larger one) for the epochs of equal time, in order.
template <class Visit>
Status for_equal_times(const RowStore<EpochError>& a, const RowStore<EpochError>& b, GpsTime start,
                       const Visit& visit) {
  RowStore<EpochError>::Reader reader_a(a), reader_b(b);
  CANYON_TRY(std::optional<EpochError> of_a, reader_a.next());
  CANYON_TRY(std::optional<EpochError> of_b, reader_b.next());
  while (of_a && of_b) {
    const GpsTime ta = of_a->t, tb = of_b->t;
    if (ta == tb) visit(ta - start, of_b->norm_m() - of_a->norm_m());
    if (ta <= tb) {
      CANYON_TRY(of_a, reader_a.next());
    }
    if (tb <= ta) {
      CANYON_TRY(of_b, reader_b.next());
    }
  }
  return Ok{};
}

}  // namespace

Result<PairedErrors> paired_errors(const RowStore<EpochError>& a, const RowStore<EpochError>& b, GpsTime start) {
  PairedErrors out;
  double sum = 0.0, worse = 0.0;
  double first_s = 0.0, last_s = 0.0;
  CANYON_TRY_STATUS(for_equal_times(a, b, start, [&](double t_s, double difference_m) {
    if (out.epochs++ == 0) first_s = t_s;
    last_s = t_s;
    sum += difference_m;
    worse += difference_m > 0.0 ? 1.0 : 0.0;
  }));
  if (out.epochs == 0) return out;
  out.mean_m = sum / out.epochs;
  out.worse_share = worse / out.epochs;

  const int batches = static_cast<int>((last_s - first_s) / kBatch_s);
  if (batches < 2) return out;
  std::vector<double> sums(static_cast<std::size_t>(batches), 0.0), counts(sums);
  CANYON_TRY_STATUS(for_equal_times(a, b, start, [&](double t_s, double difference_m) {
    const auto batch = std::min(sums.size() - 1, static_cast<std::size_t>((t_s - first_s) / kBatch_s));
    sums[batch] += difference_m;
    counts[batch] += 1.0;
  }));
  double squares = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double deviation = sums[i] / counts[i] - out.mean_m;
    squares += deviation * deviation;
  }
  const double sigma = std::sqrt(squares / (batches - 1) / batches), reach = student_975(batches - 1) * sigma;
  out.low_m = out.mean_m - reach;
  out.high_m = out.mean_m + reach;
  return out;
}

}  // namespace canyon::study
