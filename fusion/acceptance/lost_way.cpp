#include "canyon/fusion/acceptance/lost_way.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/math/chi_square.h"
#include "canyon/fusion/consistency.h"

namespace canyon::fusion {

void visit(FieldVisitor& f, LostWayParameters& p) {
  f.number(
      "lost_after_s", p.lost_after_s, {0, 1e6},
      "huber, student_t, innovation_adaptive: after so long with fixes beside it that go together with one another "
      "the filter counts as lost and goes to them; 0: never");
  f.number("lost_after_m", p.lost_after_m, {0, 1e6}, "and on so long a way of the antenna");
  f.number("lost_sigma", p.lost_sigma, {1, 100}, "but only where that is by more than so many sigma");
}

void lost_way_parameters(ModelParameters& section) {
  section.add<LostWayParameters>();
}

void LostWay::carry(const Innovation& i) {
  const PlaceBeside& place = *i.place;
  if (count_ == 0) {
    now_.way_m = 0.0;
    carried_m_.setZero();
  } else {
    const double elapsed_s = i.t - now_.t;
    now_.way_m += 0.5 * elapsed_s * (last_.speed_m_s + place.speed_m_s);
    // The estimate moves by its velocity and by all corrections.
    if (last_.velocity_measured && place.velocity_measured)
      carried_m_ += moved_by_all_m_ - 0.5 * elapsed_s * (last_.leaving_m_s + place.leaving_m_s);
    else
      carried_m_ += moved_m_;
  }
  moved_m_.setZero();
  moved_by_all_m_.setZero();
  last_ = place;
  now_.t = i.t;
  now_.off_m = place.off_m + carried_m_;
  now_.variance = i.R.diagonal().head<3>();
}

void LostWay::moved(const Eigen::Vector3d& by_m, bool by_this) {
  moved_by_all_m_ += by_m;
  if (by_this) moved_m_ += by_m;
}

void LostWay::push() {
  // Of more than fit, those that are far enough apart; one stays from which it is as far as is asked for.
  constexpr int kSpaced = kMost - 4;
  if (count_ > 0 && (now_.t - at(count_ - 1).t < p_.lost_after_s / kSpaced ||
                     now_.way_m - at(count_ - 1).way_m < p_.lost_after_m / kSpaced))
    return;
  // Fixes that are far between: as many as are asked for stay, however long they take.
  while (count_ > 1 && (count_ == kMost || (count_ >= kFewest && spans(at(1))))) {
    first_ = (first_ + 1) % kMost;
    --count_;
  }
  entries_[static_cast<std::size_t>((first_ + count_) % kMost)] = now_;
  ++count_;
}

bool LostWay::steady() {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), variance = Eigen::Vector3d::Zero();
  double mean_s = 0.0;
  const GpsTime begun = at(0).t;
  for (int k = 0; k < count_; ++k) {
    mean += at(k).off_m / count_;
    variance += at(k).variance / count_;
    mean_s += (at(k).t - begun) / count_;
  }
  double squares = 0.0, spread_s2 = 0.0;
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();
  for (int k = 0; k < count_; ++k) {
    const double since_s = at(k).t - begun - mean_s;
    squares += (at(k).off_m - mean).cwiseAbs2().cwiseQuotient(at(k).variance).sum();
    drift += since_s * at(k).off_m;
    spread_s2 += since_s * since_s;
  }
  // Of the slope, drift / spread, the variance is that of one over spread.
  const double drifting = drift.cwiseAbs2().cwiseQuotient(spread_s2 * variance).sum();
  told_m_s_ = std::sqrt(variance.sum() / 3.0 / spread_s2);
  return canyon::chi_square_tail(squares, 3.0 * (count_ - 1)) >= kUnlikely &&
         canyon::chi_square_tail(drifting, 3.0) >= kUnlikely;
}

bool LostWay::found(const Innovation& i) {
  if (p_.lost_after_s == 0.0 || i.place == nullptr) return false;
  // Not by the innovation: what has been made of the lasting error hides whatever it was led astray by.
  if (chi_square_tail(i.place->nis, 3) >= normal_two_sided_tail(p_.lost_sigma)) {
    start();
    return false;
  }
  carry(i);
  push();
  if (count_ < kFewest || !spans(at(0)) || !steady()) return false;
  start();
  return true;
}

Decision LostWay::recovery(const Innovation& i) const {
  return {.loosening = std::max(i.place->nis / 3.0, 1.0),
          .loosening_m_s = std::sqrt(i.place->leaving_m_s.squaredNorm() / 3.0 + told_m_s_ * told_m_s_)};
}

}  // namespace canyon::fusion
