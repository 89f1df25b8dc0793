#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "canyon/core/files/file_writer.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/mission/recorder/epoch_files.h"
#include "canyon/mission/recorder/recorder.h"

namespace canyon::mission {

/// Writes one run's part of a results directory (docs/results.md) as the run goes on: epochs/NAME_*.csv,
/// clouds/NAME_*.pcd, tapes/NAME.tape. Its memory does not grow with the run.
class RunFiles final : public Recorder {
 public:
  /// Makes what is missing of `directory`, which should be staged. `tape` is what the run is driven on, or null.
  static Result<std::unique_ptr<RunFiles>> create(const std::string& directory, const std::string& name,
                                                  const MissionConfig& config, const PreparedMission& mission,
                                                  const Tape* tape);

  Status node(const TapeNode& node) override;
  Status imu(const ImuSample& sample) override;
  Status odometer(const inertial::Odometer::Reading& reading) override;
  Status barometer(const inertial::Barometer::Reading& reading) override;
  Status magnetometer(const inertial::Magnetometer::Reading& reading) override;
  Status epoch(const NavRow& row) override;
  Status gnss(const GnssRow& row) override;
  Status keyframe(const KeyframeRow& row) override;
  Status map(MapKind kind, const lidar::MapCloud& map, std::span<const float> error_m) override;
  Status finish() override;

 private:
  /// A file, and what of it is still to be written.
  struct Table {
    FileWriter file;
    CsvWriter rows;
    /// Once there is enough of it.
    Status flush(std::size_t at_least);
  };
  enum {
    kNav,
    kNavCovariance,
    kGnss,
    kSatellites,
    kKeyframes,
    kImu,
    kOdometer,
    kBarometer,
    kMagnetometer,
    kFixes,
    kRanges,
    kTables
  };

  RunFiles(std::string cloud_stem, const MissionConfig& config, const PreparedMission& mission);
  /// A row, where the table is wanted.
  template <class Row>
  Status append(std::size_t table, const Row& row);
  Status open(std::size_t table, const std::string& path, const char* columns);

  std::string cloud_stem_;
  RowPlace place_;
  std::array<std::optional<Table>, kTables> tables_;  ///< none: not wanted
  std::optional<FileWriter> tape_;
  std::string nodes_;
};

}  // namespace canyon::mission
