#pragma once

#include <cmath>

#include "canyon/core/stress/looks.h"

/// Whether drawn numbers follow the law that they are said to have.
namespace canyon::scene::made {

/// Numbers that should be uniform between two ends: none beyond them, none of the ends left out, and their mean.
class UniformLaw {
 public:
  UniformLaw(double low, double high, double grain) : low_(low), high_(high), grain_(grain) {}

  void take(double x) {
    ++count_;
    sum_ += x;
    if (!(x >= least_)) least_ = x;
    if (!(x <= most_)) most_ = x;
  }
  double count() const { return count_; }

  /// 5 sigma of the mean: 6e-7. A gap of 16 mean distances at either end: 1e-7 each.
  void look_at(stress::Looks& looks) const {
    const double wide = high_ - low_, gap = 16.0 * wide / count_ + grain_;
    looks.right(count_ >= 32.0);
    looks.near(sum_ / count_, 0.5 * (low_ + high_), 5.0 * wide / std::sqrt(12.0 * count_) + grain_);
    looks.right(least_ >= low_ - grain_ && least_ <= low_ + gap && most_ <= high_ + grain_ && most_ >= high_ - gap);
  }

 private:
  double low_, high_, grain_;
  double count_ = 0.0, sum_ = 0.0, least_ = stress::kInfinity, most_ = -stress::kInfinity;
};

/// A share of so many: 5 sigma of a binomial number and one for what is discrete, 6e-7.
inline void look_at_share(stress::Looks& looks, double found, double of, double share) {
  looks.near(found, share * of, 5.0 * std::sqrt(of * share * (1.0 - share)) + 1.0);
}

}  // namespace canyon::scene::made
