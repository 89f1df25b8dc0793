#include "canyon/study/tradeoff/measuring/differences.h"

#include <algorithm>
#include <cmath>

namespace canyon::study {
namespace {

bool has(const std::vector<double>& values, std::size_t first, std::size_t dimension) {
  if (first + dimension > values.size()) return false;
  return std::all_of(values.begin() + static_cast<std::ptrdiff_t>(first),
                     values.begin() + static_cast<std::ptrdiff_t>(first + dimension),
                     [](double v) { return std::isfinite(v); });
}

}  // namespace

Differences differences(const Samples& a, const Samples* b) {
  Differences out;
  double both = 0.0, one = 0.0;
  const std::size_t dimension = a.dimension;
  const std::size_t count = b == nullptr ? a.values.size() : std::min(a.values.size(), b->values.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double>& x = a.values[i];
    const std::vector<double>* y = b == nullptr ? nullptr : &b->values[i];
    SquareSum sum;
    for (std::size_t k = 0; k < std::max(x.size(), y == nullptr ? 0 : y->size()); k += dimension) {
      const bool has_x = has(x, k, dimension), has_y = y == nullptr || has(*y, k, dimension);
      if (has_x != has_y) one += 1.0;
      if (!has_x || !has_y) continue;
      both += 1.0;
      sum.count += 1.0;
      for (std::size_t c = k; c < k + dimension; ++c) {
        const double d = x[c] - (y == nullptr ? 0.0 : (*y)[c]);
        sum.sum += d * d;
      }
    }
    out.samples.push_back(sum);
  }
  out.undefined_share = one > 0.0 ? one / (one + both) : 0.0;
  return out;
}

double rms(const Differences& d) {
  SquareSum total;
  for (const SquareSum& one : d.samples) total = {total.sum + one.sum, total.count + one.count};
  return total.count > 0.0 ? std::sqrt(total.sum / total.count) : kNaN;
}

}  // namespace canyon::study
