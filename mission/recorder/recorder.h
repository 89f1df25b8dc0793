#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/result.h"
#include "canyon/inertial/aiding/barometer.h"
#include "canyon/inertial/aiding/magnetometer.h"
#include "canyon/inertial/aiding/odometer.h"
#include "canyon/lidar/files/cloud_files.h"
#include "canyon/mission/recorder/rows.h"

namespace canyon::mission {

enum class MapKind { kPrior, kRegistered };

/// Takes what a run gives as it comes, each kind in the order of its times; keyframes may come when other kinds are
/// further on. An Error ends the run. This one keeps
/// nothing; others keep what they are made for.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual Status node(const TapeNode&) { return Ok{}; }  ///< true motion, the start first; t as in GPS time
  virtual Status imu(const ImuSample&) { return Ok{}; }
  virtual Status odometer(const inertial::Odometer::Reading&) { return Ok{}; }
  virtual Status barometer(const inertial::Barometer::Reading&) { return Ok{}; }
  virtual Status magnetometer(const inertial::Magnetometer::Reading&) { return Ok{}; }
  virtual Status epoch(const NavRow&) { return Ok{}; }
  virtual Status gnss(const GnssRow&) { return Ok{}; }  ///< once the filter has used it, or will not any more
  virtual Status keyframe(const KeyframeRow&) { return Ok{}; }
  virtual Status keyframe_input(const KeyframeInput&) { return Ok{}; }  ///< of the keyframe just handed on
  /// At the end, with each point's distance to the nearest true surface.
  virtual Status map(MapKind, const lidar::MapCloud&, std::span<const float>) { return Ok{}; }
  virtual Status finish() { return Ok{}; }  ///< nothing follows
};

/// Hands on to several.
class Recorders final : public Recorder {
 public:
  explicit Recorders(std::vector<Recorder*> to) : to_(std::move(to)) {}
  Status node(const TapeNode& node) override { return all(&Recorder::node, node); }
  Status imu(const ImuSample& sample) override { return all(&Recorder::imu, sample); }
  Status odometer(const inertial::Odometer::Reading& reading) override { return all(&Recorder::odometer, reading); }
  Status barometer(const inertial::Barometer::Reading& reading) override { return all(&Recorder::barometer, reading); }
  Status magnetometer(const inertial::Magnetometer::Reading& reading) override {
    return all(&Recorder::magnetometer, reading);
  }
  Status epoch(const NavRow& row) override { return all(&Recorder::epoch, row); }
  Status gnss(const GnssRow& row) override { return all(&Recorder::gnss, row); }
  Status keyframe(const KeyframeRow& row) override { return all(&Recorder::keyframe, row); }
  Status keyframe_input(const KeyframeInput& input) override { return all(&Recorder::keyframe_input, input); }
  Status map(MapKind kind, const lidar::MapCloud& map, std::span<const float> error_m) override {
    return all(&Recorder::map, kind, map, error_m);
  }
  Status finish() override { return all(&Recorder::finish); }

 private:
  template <class Method, class... Arguments>
  Status all(Method method, const Arguments&... arguments) {
    for (Recorder* recorder : to_) CANYON_TRY_STATUS((recorder->*method)(arguments...));
    return Ok{};
  }
  std::vector<Recorder*> to_;
};

}  // namespace canyon::mission
