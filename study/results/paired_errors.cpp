#include "canyon/study/results/paired_errors.h"

#include <optional>

#include "canyon/study/statistics/batch_means.h"

namespace canyon::study {

namespace {

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
  BatchMeans differences;
  double worse = 0.0;
  CANYON_TRY_STATUS(for_equal_times(a, b, start, [&](double t_s, double difference_m) {
    differences.add(t_s, difference_m);
    worse += difference_m > 0.0 ? 1.0 : 0.0;
  }));
  out.epochs = differences.samples();
  if (out.epochs == 0) return out;
  out.mean_m = differences.mean();
  out.worse_share = worse / out.epochs;
  const Interval interval = differences.interval();
  out.low_m = interval.low;
  out.high_m = interval.high;
  return out;
}

}  // namespace canyon::study
