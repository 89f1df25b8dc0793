#include "canyon/fusion/timeline/incident.h"

namespace canyon::fusion {

const char* trouble_text(Trouble trouble) {
  switch (trouble) {
    case Trouble::kNone:
      return "nothing wrong";
    case Trouble::kNotFinite:
      return "not finite, or no covariance";
    case Trouble::kReversed:
      return "IMU samples that go back in time";
    case Trouble::kDuplicate:
      return "the same instant twice";
    case Trouble::kGap:
      return "gap in the IMU's samples";
    case Trouble::kLost:
      return "IMU sample repeated in place of a lost one";
    case Trouble::kTooLate:
      return "later than is waited for";
    case Trouble::kFrozen:
      return "fix that stands still while the vehicle moves";
    case Trouble::kAhead:
      return "ahead of the IMU";
  }
  return "";
}

const char* trouble_key(Trouble trouble) {
  constexpr const char* kKeys[kTroubles] = {"none", "not_finite", "reversed", "duplicate", "gap",
                                            "lost", "too_late",   "frozen",   "ahead"};
  return kKeys[static_cast<std::size_t>(trouble)];
}

void Incidents::add(Trouble trouble, GpsTime t) {
  const auto i = static_cast<std::size_t>(trouble);
  if (counts_[i]++ == 0) first_[i] = t;
}

void Incidents::add(const Incidents& later) {
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] == 0) first_[i] = later.first_[i];
    counts_[i] += later.counts_[i];
  }
}

std::string Incidents::text() const {
  std::string out;
  for (std::size_t i = 1; i < counts_.size(); ++i) {
    if (counts_[i] == 0 || static_cast<Trouble>(i) == Trouble::kAhead) continue;
    out += (out.empty() ? "" : ", ") + std::to_string(counts_[i]) + " x " + trouble_text(static_cast<Trouble>(i)) +
           " (first at " + first_[i].iso() + ")";
  }
  return out;
}

}  // namespace canyon::fusion
