#include "canyon/fusion/acceptance/lost_way.h"

#include <algorithm>

#include <Eigen/Cholesky>

#include "canyon/core/math/chi_square.h"
#include "canyon/fusion/consistency.h"

namespace canyon::fusion {

void visit(FieldVisitor& f, LostWayParameters& p) {
  f.number("lost_after_s", p.lost_after_s, {0, 1e6},
           "huber, student_t, innovation_adaptive: after so long with fixes beside it by the same the filter counts as "
           "lost and goes to them; 0: never");
  f.number("lost_sigma", p.lost_sigma, {1, 100}, "but only where that is by more than so many sigma");
}

void lost_way_parameters(ModelParameters& section) {
  section.add<LostWayParameters>();
}

void LostWay::push(const Innovation& i) {
  // Of more than fit, those that are far enough apart; one stays that is as old as is asked for.
  if (count_ > 0 && i.t - at(count_ - 1).t < p_.lost_after_s / (kMost - 4)) return;
  while (count_ > 1 && (count_ == kMost || i.t - at(1).t >= p_.lost_after_s)) {
    first_ = (first_ + 1) % kMost;
    --count_;
  }
  const auto slot = static_cast<std::size_t>((first_ + count_) % kMost);
  entries_[slot] = {i.t, i.residual.head<3>(), i.R.diagonal().head<3>()};
  ++count_;
}

bool LostWay::steady() const {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int k = 0; k < count_; ++k) mean += at(k).residual / count_;
  double squares = 0.0;
  for (int k = 0; k < count_; ++k) squares += (at(k).residual - mean).cwiseAbs2().cwiseQuotient(at(k).variance).sum();
  return canyon::chi_square_tail(squares, 3.0 * (count_ - 1)) >= kScattered;
}

bool LostWay::found(const Innovation& i) {
  if (p_.lost_after_s == 0.0 || i.residual.size() != 3) return false;
  push(i);
  const bool far = chi_square_tail(i.nis, 3) < normal_two_sided_tail(p_.lost_sigma);
  if (!far) {
    count_ = 0;
    return false;
  }
  if (count_ < kFewest || i.t - at(0).t < p_.lost_after_s) return false;
  if (!steady()) return false;
  start();
  return true;
}

Decision LostWay::recovery(const Innovation& i) {
  return {.loosening = std::max(i.nis / static_cast<double>(i.residual.size()), 1.0)};
}

}  // namespace canyon::fusion
