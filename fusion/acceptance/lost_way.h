#pragma once

#include <array>

#include "canyon/core/config/config.h"
#include "canyon/fusion/acceptance/acceptance.h"

namespace canyon::fusion {

/// When a filter counts as lost; shared by the rows that weigh what is far off instead of refusing it.
struct LostWayParameters {
  double lost_after_s = 0.0;
  double lost_sigma = 5.0;
};
void visit(FieldVisitor& f, LostWayParameters& p);
void lost_way_parameters(ModelParameters& section);

/// Whether measurements of three components say that it is the filter that is off: for so long they have been beside it
/// by the same, to their own noise, and by more than it can account for. Errors that wander, as of echoes along a
/// street, do not count; but beside a vehicle that stands an echo is as steady as the truth. Asks for no memory.
class LostWay {
 public:
  explicit LostWay(const LostWayParameters& p) : p_(p) {}
  void start() { count_ = 0; }
  /// To be asked of every innovation in turn; begins anew where it says yes.
  bool found(const Innovation& i);
  /// That makes the filter as unsure as this innovation says: its normalized square becomes what is expected of it.
  static Decision recovery(const Innovation& i);

 private:
  static constexpr int kMost = 32, kFewest = 5;
  /// Of fixes that are as good as they say one in ten such stretches scatters more; that costs one more fix.
  static constexpr double kScattered = 0.1;

  struct Entry {
    GpsTime t;
    Eigen::Vector3d residual, variance;
  };
  const Entry& at(int k) const { return entries_[static_cast<std::size_t>((first_ + k) % kMost)]; }
  void push(const Innovation& i);
  bool steady() const;

  LostWayParameters p_;
  std::array<Entry, kMost> entries_{};
  int first_ = 0, count_ = 0;
};

}  // namespace canyon::fusion
