#pragma once

#include <vector>

#include "canyon/mission/recorder/recorder.h"

namespace canyon::mission::testing {

/// Keeps everything in memory, some 11 kB a simulated second: for short runs that are looked at afterwards.
class MemoryRecorder : public Recorder {
 public:
  std::vector<TapeNode> tape;
  std::vector<ImuSample> imu_samples;
  std::vector<inertial::Odometer::Reading> odometer_readings;
  std::vector<inertial::Barometer::Reading> barometer_readings;
  std::vector<inertial::Magnetometer::Reading> magnetometer_readings;
  std::vector<NavRow> nav;
  std::vector<GnssRow> gnss_rows;
  std::vector<KeyframeRow> keyframes;
  std::vector<lidar::MapPoint> prior_map, registered_map;

  Status node(const TapeNode& node) override { return keep(tape, node); }
  Status imu(const ImuSample& sample) override { return keep(imu_samples, sample); }
  Status odometer(const inertial::Odometer::Reading& reading) override { return keep(odometer_readings, reading); }
  Status barometer(const inertial::Barometer::Reading& reading) override { return keep(barometer_readings, reading); }
  Status magnetometer(const inertial::Magnetometer::Reading& reading) override {
    return keep(magnetometer_readings, reading);
  }
  Status epoch(const NavRow& row) override { return keep(nav, row); }
  Status gnss(const GnssRow& row) override { return keep(gnss_rows, row); }
  Status keyframe(const KeyframeRow& row) override { return keep(keyframes, row); }
  Status map(MapKind kind, const lidar::MapCloud& map, std::span<const float>) override {
    auto& kept = kind == MapKind::kPrior ? prior_map : registered_map;
    kept.clear();
    for (std::size_t i = 0; i < map.size(); ++i) kept.push_back(map[i]);
    return Ok{};
  }

 private:
  template <class Row>
  static Status keep(std::vector<Row>& rows, const Row& row) {
    rows.push_back(row);
    return Ok{};
  }
};

}  // namespace canyon::mission::testing
