#include "canyon/fusion/verdict/normal_series.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/messages.h"

namespace canyon::fusion {

NormalSeries::NormalSeries(int dimension) : dimension_(dimension) {
  CANYON_CHECK(dimension >= 1, "dimension = ", dimension);
}

void NormalSeries::add(GpsTime t, const Eigen::Ref<const Eigen::VectorXd>& z) {
  CANYON_CHECK(z.size() == dimension_, z.size(), " elements of ", dimension_);
  if (!z.allFinite()) return;
  if (samples_++ == 0) first_ = t;
  last_ = t;
  const double squares = z.squaredNorm();
  squares_ += squares;
  add(0, z, squares);
}

/// `squares`: mean of the squares of the samples that z is the mean of.
void NormalSeries::add(std::size_t index, const Eigen::VectorXd& z, double squares) {
  if (index == levels_.size()) {
    levels_.emplace_back();
    levels_.back().ring.resize(static_cast<std::size_t>(kLags * dimension_));
  }
  Level& level = levels_[index];
  const auto at = [&](std::int64_t i) {
    return Eigen::Map<Eigen::VectorXd>(level.ring.data() + (i % kLags) * dimension_, dimension_);
  };
  const auto reach = std::min<std::int64_t>(kLags, level.count);
  for (std::int64_t k = index == 0 ? 1 : kLags / 2 + 1; k <= reach; ++k) {
    const auto lag = static_cast<std::size_t>(k - 1);
    level.sums[lag] += at(level.count - k).dot(z);
    level.earlier_squares[lag] += level.ring_squares[static_cast<std::size_t>((level.count - k) % kLags)];
    level.later_squares[lag] += squares;
    ++level.pairs[lag];
  }
  at(level.count) = z;
  level.ring_squares[static_cast<std::size_t>(level.count % kLags)] = squares;
  if (++level.count % 2 == 1) {
    level.half = z;
    level.half_squares = squares;
    return;
  }
  const Eigen::VectorXd mean = 0.5 * (level.half + z);
  add(index + 1, mean, 0.5 * (level.half_squares + squares));
}

double NormalSeries::interval_s() const {
  return samples_ > 1 ? (last_ - first_) / static_cast<double>(samples_ - 1) : kNaN;
}

double NormalSeries::mean_square() const {
  return samples_ > 0 ? squares_ / (static_cast<double>(samples_) * dimension_) : kNaN;
}

std::vector<NormalSeries::Lag> NormalSeries::lags() const {
  std::vector<Lag> out;
  bool known = squares_ > 0.0;
  double step = 1.0;
  for (std::size_t l = 0; known && l < levels_.size(); ++l, step *= 2.0) {
    for (std::size_t k = l == 0 ? 1 : kLags / 2 + 1; known && k <= kLags; ++k) {
      const Level& level = levels_[l];
      known = level.pairs[k - 1] > 0;
      if (!known) break;
      const double unit = std::sqrt(level.earlier_squares[k - 1]) * std::sqrt(level.later_squares[k - 1]);
      const double r = unit > 0.0 ? std::clamp(level.sums[k - 1] / unit, -1.0, 1.0) : 0.0;  // 1 but for rounding
      out.push_back({.samples = static_cast<double>(k) * step, .r = r, .pairs = level.pairs[k - 1]});
    }
  }
  // The trapezoidal rule over lags that lie farther and farther apart.
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double before = i > 0 ? out[i - 1].samples : 0.0,
                 after = i + 1 < out.size() ? out[i + 1].samples : 2.0 * out[i].samples - before;
    out[i].stands_for = 0.5 * (after - before);
  }
  return out;
}

double NormalSeries::chance() const {
  return 2.0 / std::sqrt(static_cast<double>(samples_) * dimension_);
}

NormalSeries::Portmanteau NormalSeries::portmanteau() const {
  constexpr std::int64_t kSamplesPerLag = 4;
  Portmanteau out;
  const auto most = static_cast<std::size_t>(std::min<std::int64_t>(kLags, samples_ / kSamplesPerLag));
  const std::vector<Lag> all = lags();
  for (std::size_t k = 0; k < std::min(most, all.size()); ++k, ++out.degrees)
    out.statistic += all[k].r * all[k].r * dimension_ * static_cast<double>(all[k].pairs);
  return out;
}

double NormalSeries::effective_samples() const {
  const auto n = static_cast<double>(samples_);
  double alike = 0.0;
  for (const Lag& lag : lags()) {
    if (lag.r <= chance()) break;
    alike += lag.stands_for * std::max(0.0, 1.0 - lag.samples / n) * lag.r * lag.r;
  }
  return std::max(1.0, n / (1.0 + 2.0 * alike));
}

double NormalSeries::correlation_s() const {
  const std::vector<Lag> all = lags();
  if (all.empty() || all.front().r <= chance()) return 0.0;
  const double low = all.front().r / std::exp(1.0);
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].r > low) continue;
    const Lag &before = all[i - 1], &after = all[i];
    const double share = (before.r - low) / (before.r - after.r);
    return (before.samples + share * (after.samples - before.samples) - 1.0) * interval_s();
  }
  return (all.back().samples - 1.0) * interval_s();  // at least
}

}  // namespace canyon::fusion
