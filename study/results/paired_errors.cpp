#include "canyon/study/results/paired_errors.h"

#include <algorithm>
#include <cmath>

#include "canyon/mission/recorder/estimate_error.h"

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

}  // namespace

PairedErrors paired_errors(const mission::RunRecord& a, const mission::RunRecord& b) {
  PairedErrors out{.a = a.name, .b = b.name};
  std::vector<double> times_s, differences_m;
  for (std::size_t i = 0, k = 0; i < a.nav.size() && k < b.nav.size();) {
    const GpsTime ta = a.nav[i].t, tb = b.nav[k].t;
    if (ta == tb) {
      times_s.push_back(ta - a.start);
      differences_m.push_back(mission::estimate_error(b.nav[k]).position_W_m.norm() -
                              mission::estimate_error(a.nav[i]).position_W_m.norm());
    }
    i += ta <= tb ? 1 : 0;
    k += tb <= ta ? 1 : 0;
  }
  out.epochs = static_cast<int>(differences_m.size());
  if (differences_m.empty()) return out;
  double sum = 0.0, worse = 0.0;
  for (const double d : differences_m) {
    sum += d;
    worse += d > 0.0 ? 1.0 : 0.0;
  }
  out.mean_m = sum / out.epochs;
  out.worse_share = worse / out.epochs;

  const int batches = static_cast<int>((times_s.back() - times_s.front()) / kBatch_s);
  if (batches < 2) return out;
  std::vector<double> sums(static_cast<std::size_t>(batches), 0.0), counts(sums);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const auto batch = std::min(sums.size() - 1, static_cast<std::size_t>((times_s[i] - times_s.front()) / kBatch_s));
    sums[batch] += differences_m[i];
    counts[batch] += 1.0;
  }
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

std::vector<PairedErrors> paired_with_first(const std::vector<mission::RunRecord>& records) {
  std::vector<PairedErrors> out;
  const bool open = std::all_of(records.begin(), records.end(), [](const auto& record) { return record.open_loop; });
  for (std::size_t i = 1; open && i < records.size(); ++i) out.push_back(paired_errors(records.front(), records[i]));
  return out;
}

}  // namespace canyon::study
