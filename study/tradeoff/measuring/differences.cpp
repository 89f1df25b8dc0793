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

/// Whether vector `k` of sample `i` is of the same thing in both.
bool of_the_same(const Samples& a, const Samples* b, std::size_t i, std::size_t k) {
  if (b == nullptr || a.of.empty() || b->of.empty()) return true;
  return k < a.of[i].size() && k < b->of[i].size() && a.of[i][k] == b->of[i][k];
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
      const bool comparable = has_x && has_y && of_the_same(a, b, i, k / dimension);
      if ((has_x || has_y) && !comparable) one += 1.0;
      if (!comparable) continue;
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

std::vector<double> common_rms(const std::vector<const Samples*>& all) {
  std::vector<double> sums(all.size(), 0.0), out(all.size(), kNaN);
  std::vector<std::size_t> taking_part;
  for (std::size_t r = 0; r < all.size(); ++r)
    if (std::isfinite(rms(differences(*all[r], nullptr)))) taking_part.push_back(r);
  if (taking_part.empty()) return out;
  const Samples& first = *all[taking_part.front()];
  double count = 0.0;
  for (std::size_t i = 0; i < first.values.size(); ++i) {
    for (std::size_t k = 0; k < first.values[i].size(); k += first.dimension) {
      const bool common = std::all_of(taking_part.begin(), taking_part.end(), [&](std::size_t r) {
        return i < all[r]->values.size() && has(all[r]->values[i], k, first.dimension);
      });
      if (!common) continue;
      count += 1.0;
      for (const std::size_t r : taking_part)
        for (std::size_t c = k; c < k + first.dimension; ++c) sums[r] += all[r]->values[i][c] * all[r]->values[i][c];
    }
  }
  for (const std::size_t r : taking_part) out[r] = count > 0.0 ? std::sqrt(sums[r] / count) : kNaN;
  return out;
}

}  // namespace canyon::study
