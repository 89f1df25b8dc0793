#pragma once

#include <array>

#include "canyon/core/config/config.h"
#include "canyon/fusion/acceptance/acceptance.h"

namespace canyon::fusion {

/// When a filter counts as lost; shared by the rows that weigh what is far off instead of refusing it.
struct LostWayParameters {
  double lost_after_s = 8.0;
  double lost_after_m = 20.0;
  double lost_sigma = 5.0;
};
void visit(FieldVisitor& f, LostWayParameters& p);
void lost_way_parameters(ModelParameters& section);

/// Whether places say that it is the filter that is off: for so long, and on so long a way, they have been far beside
/// it, and go together with one another to their own noise. That is judged along their own motion: the filter's, with
/// what they have moved of it put back, and with its velocity replaced by the one that was measured with them. Errors
/// that wander, as of echoes along a street, do not go together with that; nor does what a vehicle that stands measures
/// count, for beside that an echo is as steady as the truth. Asks for no memory.
class LostWay {
 public:
  explicit LostWay(const LostWayParameters& p) : p_(p) {}
  void start() { count_ = 0; }
  /// As Acceptance::moved().
  void moved(const Eigen::Vector3d& by_m, bool by_this);
  /// To be asked of every innovation in turn; begins anew where it says yes.
  bool found(const Innovation& i);
  /// That makes the filter as unsure as this place says: its normalized square becomes what is expected of it. Its
  /// velocity by what is measured, and by what the stretch can tell of it at all. After found() has said yes.
  Decision recovery(const Innovation& i) const;

 private:
  static constexpr int kMost = 32, kFewest = 5;
  /// Of fixes that are as good as they say one stretch in a hundred scatters more, and one drifts more; that costs a
  /// few fixes.
  static constexpr double kUnlikely = 0.01;

  struct Entry {
    GpsTime t;
    double way_m;
    Eigen::Vector3d off_m, variance;
  };
  const Entry& at(int k) const { return entries_[static_cast<std::size_t>((first_ + k) % kMost)]; }
  bool spans(const Entry& from) const {
    return now_.t - from.t >= p_.lost_after_s && now_.way_m - from.way_m >= p_.lost_after_m;
  }
  void carry(const Innovation& i);
  void push();
  bool steady();

  LostWayParameters p_;
  std::array<Entry, kMost> entries_{};
  int first_ = 0, count_ = 0;
  Entry now_{};
  PlaceBeside last_;
  /// Since then, by this model's corrections and by all.
  Eigen::Vector3d moved_m_ = Eigen::Vector3d::Zero(), moved_by_all_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d carried_m_ = Eigen::Vector3d::Zero();  ///< from the first on, beside the filter's own motion
  double told_m_s_ = 0.0;  ///< 1-sigma of what the stretch last asked about tells of drift
};

}  // namespace canyon::fusion
