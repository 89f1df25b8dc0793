#include "canyon/mission/recorder/run_files.h"

#include <filesystem>

#include "canyon/mission/route_tape.h"

namespace canyon::mission {

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;

}  // namespace

Status RunFiles::Table::flush(std::size_t at_least) {
  if (rows.text().size() < at_least) return Ok{};
  CANYON_TRY_STATUS(file.write(rows.text()));
  rows.clear();
  return Ok{};
}

RunFiles::RunFiles(std::string cloud_stem, const MissionConfig& config, const PreparedMission& mission)
    : cloud_stem_(std::move(cloud_stem)),
      place_{mission.scene->frame(), mission.start, lidar::registers(config.registration)} {}

Status RunFiles::open(std::size_t table, const std::string& path, const char* columns) {
  CANYON_TRY(FileWriter file, FileWriter::create(path));
  tables_[table].emplace(Table{std::move(file), CsvWriter(columns)});
  return Ok{};
}

Result<std::unique_ptr<RunFiles>> RunFiles::create(const std::string& directory, const std::string& name,
                                                   const MissionConfig& config, const PreparedMission& mission,
                                                   const Tape* tape) {
  std::error_code ignored;
  for (const char* folder : {"/epochs", "/clouds"}) std::filesystem::create_directories(directory + folder, ignored);
  std::unique_ptr<RunFiles> files(new RunFiles(directory + "/clouds/" + name, config, mission));
  const std::string stem = directory + "/epochs/" + name;
  CANYON_TRY_STATUS(files->open(kNav, stem + "_nav.csv", kNavColumns));
  if (config.run.record_covariance)
    CANYON_TRY_STATUS(files->open(kNavCovariance, stem + "_nav_covariance.csv", kNavCovarianceColumns));
  CANYON_TRY_STATUS(files->open(kGnss, stem + "_gnss.csv", kGnssColumns));
  CANYON_TRY_STATUS(files->open(kSatellites, stem + "_satellites.csv", kSatelliteColumns));
  CANYON_TRY_STATUS(files->open(kKeyframes, stem + "_keyframes.csv", kKeyframeColumns));
  if (config.run.record_filter_input) {
    CANYON_TRY_STATUS(files->open(kImu, stem + "_imu.csv", kImuColumns));
    const AidingSensors sensors = aiding_sensors(config);
    if (sensors.odometer) CANYON_TRY_STATUS(files->open(kOdometer, stem + "_odometer.csv", kOdometerColumns));
    if (sensors.barometer) CANYON_TRY_STATUS(files->open(kBarometer, stem + "_barometer.csv", kBarometerColumns));
    if (sensors.magnetometer)
      CANYON_TRY_STATUS(files->open(kMagnetometer, stem + "_magnetometer.csv", kMagnetometerColumns));
    CANYON_TRY_STATUS(files->open(kFixes, stem + "_fixes.csv", kFixColumns));
    if (fusion::measures_with(config.fusion, "ranges"))
      CANYON_TRY_STATUS(files->open(kRanges, stem + "_ranges.csv", kRangeColumns));
  }
  if (config.run.record_tape) {
    std::filesystem::create_directories(directory + "/tapes", ignored);
    CANYON_TRY(files->tape_, FileWriter::create(directory + "/tapes/" + name + ".tape"));
    files->nodes_ = tape_header({.source = tape != nullptr ? tape->source : name + " of " + config.run.name,
                                 .scene_hash = mission.scene->hash(),
                                 .traffic = traffic_text(config),
                                 .nodes = {}});
  }
  return files;
}

Status RunFiles::node(const TapeNode& node) {
  if (!tape_) return Ok{};
  TapeNode from_start = node;
  from_start.motion.t.ns -= place_.start.ns;
  append_tape_node(nodes_, from_start);
  if (nodes_.size() < kPiece) return Ok{};
  CANYON_TRY_STATUS(tape_->write(nodes_));
  nodes_.clear();
  return Ok{};
}

template <class Row>
Status RunFiles::append(std::size_t table, const Row& row) {
  if (!tables_[table]) return Ok{};
  write(tables_[table]->rows, row, place_);
  return tables_[table]->flush(kPiece);
}

Status RunFiles::imu(const ImuSample& sample) {
  return append(kImu, sample);
}
Status RunFiles::odometer(const inertial::Odometer::Reading& reading) {
  return append(kOdometer, reading);
}
Status RunFiles::barometer(const inertial::Barometer::Reading& reading) {
  return append(kBarometer, reading);
}
Status RunFiles::magnetometer(const inertial::Magnetometer::Reading& reading) {
  return append(kMagnetometer, reading);
}

Status RunFiles::epoch(const NavRow& row) {
  write(tables_[kNav]->rows, row, place_);
  if (tables_[kNavCovariance] && row.covariance) {
    write_covariance(tables_[kNavCovariance]->rows, row, place_);
    CANYON_TRY_STATUS(tables_[kNavCovariance]->flush(kPiece));
  }
  return tables_[kNav]->flush(kPiece);
}

Status RunFiles::gnss(const GnssRow& row) {
  write(tables_[kGnss]->rows, row, place_);
  write_satellites(tables_[kSatellites]->rows, row, place_);
  if (tables_[kFixes]) {
    write_fix(tables_[kFixes]->rows, row, place_);
    CANYON_TRY_STATUS(tables_[kFixes]->flush(kPiece));
  }
  if (tables_[kRanges]) {
    write_ranges(tables_[kRanges]->rows, row, place_);
    CANYON_TRY_STATUS(tables_[kRanges]->flush(kPiece));
  }
  CANYON_TRY_STATUS(tables_[kGnss]->flush(kPiece));
  return tables_[kSatellites]->flush(kPiece);
}

Status RunFiles::keyframe(const KeyframeRow& row) {
  write(tables_[kKeyframes]->rows, row, place_);
  return tables_[kKeyframes]->flush(kPiece);
}

Status RunFiles::map(MapKind kind, const lidar::MapCloud& map, std::span<const float> error_m) {
  return lidar::write_pcd(cloud_stem_ + (kind == MapKind::kPrior ? "_prior.pcd" : "_registered.pcd"), map, error_m);
}

Status RunFiles::finish() {
  for (auto& table : tables_) {
    if (!table) continue;
    CANYON_TRY_STATUS(table->flush(0));
    CANYON_TRY_STATUS(table->file.close());
  }
  if (!tape_) return Ok{};
  CANYON_TRY_STATUS(tape_->write(nodes_));
  return tape_->close();
}

}  // namespace canyon::mission
