#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/omissions.h"

namespace canyon::study {

/// Epochs of a mission's GNSS sensor by themselves, without vehicle and filter, at places of a plan's corridor.
class GnssReplay {
 public:
  /// `count` instants spread over the time for which the plan holds (without a corridor: over the tape's), the k-th as
  /// epoch k. The body stands anywhere on the tape's way, whenever it was there, moved by up to the half-width of the
  /// corridor to either side, on the ground there, and heads anywhere (stream "plan.replay" of the mission's seed);
  /// where that is not within the corridor, it is not moved aside. `mission` must outlive this.
  GnssReplay(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
             const mission::Omissions& omissions, std::int64_t count);

  struct Epoch {
    std::int64_t index = 0;
    GpsTime t;
    std::size_t place = 0;  ///< of the corridor; corridor.size(): beside it
    Eigen::Vector3d p_A_W, v_A_W;
  };
  const std::vector<Epoch>& epochs() const { return epochs_; }

  /// A sensor of its own, since receivers remember.
  Result<std::unique_ptr<gnss::GnssSensor>> sensor() const;
  /// Measured with what is left out there; epochs in their order.
  gnss::GnssOutput measure(gnss::GnssSensor& sensor, const Epoch& epoch, const gnss::PathOmissions& leave_out);

 private:
  const mission::MissionConfig& config_;
  const mission::PreparedMission& mission_;
  scene::SceneAt scene_;
  std::vector<Epoch> epochs_;
};

/// Of an effect by its name: what leaving out that one alone means where `all` may be left out.
gnss::PathOmissions only(const char* effect, const gnss::PathOmissions& all, const gnss::PathOmissions& others = {});

/// How far two outputs of one epoch differ, in metres of range or position: 0 if every field of fix and observations is
/// the same to the bit, infinite where other satellites are tracked or used, or the fix is of another kind. What else
/// differs alone (C/N0, carrier, Doppler, velocity, covariance) counts as the largest of it in its own unit.
double difference_m(const gnss::GnssOutput& a, const gnss::GnssOutput& b);

/// To the bit, every field.
bool same(const GnssFix& a, const GnssFix& b);

}  // namespace canyon::study
