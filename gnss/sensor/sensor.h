#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/core/truth.h"
#include "canyon/gnss/paths/counters.h"
#include "canyon/gnss/paths/path_omissions.h"
#include "canyon/gnss/receiver/modes/delay_omissions.h"

namespace canyon::scene {
class Scene;
class SceneAt;
}  // namespace canyon::scene

namespace canyon::gnss {

/// What one due GNSS epoch gives: messages, and the parallel truth record.
struct GnssOutput {
  GnssEpoch epoch;  ///< empty for models that do not form pseudoranges
  GnssFix fix;
  GnssTruth truth;
  double range_gain = kNaN;  ///< of the fix: how far it moves at most where every range moves by 1 m (PositionSolution)
};

/// A GNSS receiver in the scene. `index` is the number of the epoch since the start (the random streams' sample index).
///
/// A receiver has a memory: locks held, cycles counted. Epochs are measured in order, one index after the other, and
/// what measure() returns depends on its arguments and on the epochs since the receiver was last switched on, nothing
/// else. An index that does not follow the last one switches it on anew, as one that has been running for long: all
/// that can be tracked is in lock. So an epoch measured alone, or first, depends on its arguments alone, and a sequence
/// measured again gives the same bits. All errors that do not need memory (noise, clocks, delays) are functions of
/// seed, satellite and index or time, whatever was asked before. A sensor serves one vehicle; it is not thread-safe.
class GnssSensor {
 public:
  virtual ~GnssSensor() = default;
  virtual GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p_A_W, const Eigen::Vector3d& v_A_W,
                             const scene::SceneAt& scene) = 0;
  virtual GnssCounters counters() const = 0;
  /// From the next epoch on, until it is called again: what has been shown to change nothing where the antenna will be
  /// (gnss/sensor/sensor_need.h) is not computed. A sensor that has none of it to leave out does nothing.
  virtual void leave_out(const PathOmissions&) {}
  /// The same of what the ranges are made of. An epoch is measured in full where the promise that comes with it might
  /// not hold: where the receiver could decide otherwise, or the position is moved by more.
  virtual void leave_out(const RangeOmissions&) {}
  /// False where fixes come without satellites: counts of them and DOP jumps are then undefined.
  virtual bool has_satellites() const { return false; }
  /// What a user should be told once: damaged records of the navigation file that were skipped, one line each.
  virtual std::vector<std::string> warnings() const { return {}; }
};

struct GnssConfig;  // gnss/sensor/gnss_config.h

/// Index of the epoch `t_s` after the start, in steps of the configured rate. Epochs looked at hours apart are not
/// consecutive, so each finds the receiver running, not still to regain what was hidden an hour ago.
std::int64_t epoch_index(const GnssConfig& config, double t_s);

/// Builds the configured sensor: reads the navigation file if one is named and checks that it covers [start, end].
/// `noise_seed`, where given, is that of what it draws anew at every epoch (thermal noise, errors that are white), so
/// that these can be others while delays, clocks and ambiguities stay.
Result<std::unique_ptr<GnssSensor>> make_gnss_sensor(const GnssConfig& config, std::uint64_t seed, GpsTime start,
                                                     GpsTime end, const scene::Scene& scene,
                                                     std::optional<std::uint64_t> noise_seed = {});

}  // namespace canyon::gnss
