#pragma once

#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/core/truth.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/lidar/files/cloud_files.h"
#include "canyon/lidar/scanner.h"
#include "canyon/mission/mapping/mapper.h"
#include "canyon/mission/recorder/rows.h"

namespace canyon::mission {

/// Looks at what one part of a run hands to the next. What is not finite, or larger than it can be on Earth (the .cpp
/// has the limits), is refused where it comes from, and does not travel on to where some library gives up. The Error is
/// of a computation that could not finish (exit status 1) and names the producer, the time and the value.
///
/// NaN where a message means "not measured" passes: a fix that is none, a velocity that the receiver does not give.
class Boundaries {
 public:
  explicit Boundaries(GpsTime start) : start_(start) {}

  Status check(const KinematicState& motion) const;
  Status check(const ImuSample& sample) const;
  Status check(const OdometerSample& sample) const;
  Status check(const BarometerSample& sample) const;
  Status check(const MagnetometerSample& sample) const;
  Status check(const gnss::GnssOutput& output) const;
  Status check(const lidar::LidarOutput& output) const;
  Status check(const NavEstimate& estimate) const;
  Status check(const Keyframe& keyframe) const;
  /// What is recorded.
  Status check(const NavRow& row) const;
  Status check(const GnssRow& row) const;
  Status check(const KeyframeRow& row) const;
  Status check(const lidar::MapCloud& map, double t_s) const;
  Status check_end(double duration_s, double distance_m) const;

 private:
  GpsTime start_;
};

/// Of a command only that it is finite is asked: the vehicle keeps to its limits, and one that is not is the mission's
/// outcome, since the autonomy is what is under test.
bool is_finite(const DriveCommand& command);

}  // namespace canyon::mission
