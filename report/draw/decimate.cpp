#include "canyon/report/draw/decimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/check.h"

namespace canyon::report {
namespace {

/// The extreme samples of one bucket.
struct Bucket {
  std::size_t first, last, least, greatest;
};

void append(LinePiece& piece, const Bucket& bucket) {
  std::array<std::size_t, 4> kept{bucket.first, bucket.least, bucket.greatest, bucket.last};
  std::sort(kept.begin(), kept.end());
  piece.insert(piece.end(), kept.begin(), std::unique(kept.begin(), kept.end()));
}

}  // namespace

std::vector<LinePiece> decimate(std::span<const double> x, std::span<const double> y, std::size_t buckets) {
  CANYON_CHECK(x.size() == y.size() && buckets > 0, "x ", x.size(), ", y ", y.size(), ", buckets ", buckets);
  std::vector<LinePiece> pieces;
  if (x.empty()) return pieces;
  const bool whole = x.size() <= 4 * buckets;
  const double span = x.back() - x.front();
  const auto bucket_of = [&](std::size_t i) {
    if (whole || span <= 0) return i;
    const double place = (x[i] - x.front()) / span * static_cast<double>(buckets);
    return std::min(static_cast<std::size_t>(place), buckets - 1);
  };

  bool gap = true;  // since the last finished bucket
  std::size_t i = 0;
  while (i < x.size()) {
    const std::size_t bucket_number = bucket_of(i);
    bool found = false;
    bool gap_before = gap;
    bool gap_after = false;
    Bucket bucket{};
    for (; i < x.size() && bucket_of(i) == bucket_number; ++i) {
      if (!std::isfinite(y[i])) {
        (found ? gap_after : gap_before) = true;
        continue;
      }
      gap_after = false;  // a gap inside the bucket is narrower than what is drawn
      if (!found) bucket = {i, i, i, i};
      found = true;
      bucket.last = i;
      if (y[i] < y[bucket.least]) bucket.least = i;
      if (y[i] > y[bucket.greatest]) bucket.greatest = i;
    }
    if (!found) {
      gap = true;
      continue;
    }
    if (gap_before || pieces.empty()) pieces.emplace_back();
    append(pieces.back(), bucket);
    gap = gap_after;
  }
  return pieces;
}

}  // namespace canyon::report
