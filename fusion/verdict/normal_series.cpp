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
  squares_ += z.squaredNorm();
  add(0, z);
}

void NormalSeries::add(std::size_t index, const Eigen::VectorXd& z) {
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
    level.sums[static_cast<std::size_t>(k - 1)] += at(level.count - k).dot(z);
    ++level.pairs[static_cast<std::size_t>(k - 1)];
  }
  at(level.count) = z;
  if (++level.count % 2 == 1) {
    level.half = z;
    return;
  }
  const Eigen::VectorXd mean = 0.5 * (level.half + z);
  add(index + 1, mean);
}

double NormalSeries::interval_s() const {
  return samples_ > 1 ? (last_ - first_) / static_cast<double>(samples_ - 1) : kNaN;
}

double NormalSeries::mean_square() const {
  return samples_ > 0 ? squares_ / (static_cast<double>(samples_) * dimension_) : kNaN;
}

std::vector<NormalSeries::Lag> NormalSeries::lags() const {
  std::vector<Lag> out;
  const double unit = mean_square() * dimension_;
  bool known = unit > 0.0;
  double step = 1.0;
  for (std::size_t l = 0; known && l < levels_.size(); ++l, step *= 2.0) {
    for (std::size_t k = l == 0 ? 1 : kLags / 2 + 1; known && k <= kLags; ++k) {
      const std::int64_t pairs = levels_[l].pairs[k - 1];
      known = pairs > 0;
      if (known)
        out.push_back({.samples = static_cast<double>(k) * step,
                       .r = levels_[l].sums[k - 1] / static_cast<double>(pairs) / unit,
                       .pairs = pairs});
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
