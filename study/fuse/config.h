#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/imu_noise.h"
#include "canyon/core/model_choice.h"
#include "canyon/fusion/filter_config.h"
#include "canyon/fusion/timeline/filter_timeline.h"

namespace canyon::study {

/// One figure of a unit's noise as `[imu]` of `canyon fuse` names it.
struct NoiseFigure {
  const char* key;
  TriadNoise ImuNoise::*triad;
  double TriadNoise::*figure;
  double si;  ///< of the key's unit
  const char* doc;
};
inline constexpr std::size_t kNoiseFigures = 12;
const std::array<NoiseFigure, kNoiseFigures>& noise_figures();

/// Axes of a log; which it has is never guessed.
enum class LogAxes { kForwardLeftUp, kForwardRightDown };

/// [imu]: the unit, and how its log is to be read.
struct FuseImuConfig {
  std::string sensor = "adis16465";
  bool sensor_given = false;                                 ///< not a key: whether the file names a sensor or a figure
  std::array<std::optional<double>, kNoiseFigures> figures;  ///< in place of the sensor's
  std::string columns;
  LogAxes axes = LogAxes::kForwardLeftUp;
  Eigen::Vector3d turn_deg = Eigen::Vector3d::Zero();
  bool instantaneous = false;
  double clock_offset_s = 0.0;
  Eigen::Vector3d lever_m = Eigen::Vector3d::Zero();
  double bridge_s = 1.0;
};
void visit(FieldVisitor& f, FuseImuConfig& c);

/// [gnss]: the antenna and its log of fixes.
struct FuseGnssConfig {
  std::string columns;
  Eigen::Vector3d lever_m = Eigen::Vector3d::Zero();
  double clock_offset_s = 0.0;
  Eigen::Vector3d sigma_enu_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_sigma_enu_m_s = Eigen::Vector3d::Zero();
  std::string solve;  ///< options of the solution of RINEX; empty: defaults
};
void visit(FieldVisitor& f, FuseGnssConfig& c);

/// [odometer]
struct FuseOdometerConfig {
  std::string columns;
  double tick_m = 0.02;
};
void visit(FieldVisitor& f, FuseOdometerConfig& c);

/// [heading]
struct FuseHeadingConfig {
  std::string columns;
  double offset_deg = 0.0;
  double sigma_deg = 0.0;
};
void visit(FieldVisitor& f, FuseHeadingConfig& c);

/// [poses]
struct FusePosesConfig {
  std::string columns;
  std::vector<double> origin_deg_deg_m;  ///< of the map, for poses in local coordinates; empty: none
  Eigen::Vector3d sigma_enu_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d attitude_sigma_deg = Eigen::Vector3d::Zero();
};
void visit(FieldVisitor& f, FusePosesConfig& c);

/// What a reference is the place of.
enum class TruthPoint { kImu, kAntenna, kBody };

/// [truth]
struct FuseTruthConfig {
  std::string columns;
  TruthPoint of = TruthPoint::kImu;
  std::vector<double> origin_deg_deg_m;  ///< of W, for a reference in local coordinates; empty: none
};
void visit(FieldVisitor& f, FuseTruthConfig& c);

/// [start]
struct FuseStartConfig {
  FuseStartConfig();
  std::string from = "auto";  ///< `auto`, `truth`, or a row of fusion::alignments()
  ModelParameters own;        ///< of all rows
};
void visit(FieldVisitor& f, FuseStartConfig& c);

/// [smoother]: of all rows of fusion::smoothers(); which one it is `--smoother` says.
struct FuseSmootherConfig {
  FuseSmootherConfig();
  ModelParameters own;
};
void visit(FieldVisitor& f, FuseSmootherConfig& c);

/// [score] and [output]
struct FuseScoreConfig {
  double skip_s = 0.0;
};
void visit(FieldVisitor& f, FuseScoreConfig& c);
struct FuseOutputConfig {
  double rate_hz = 10.0;
};
void visit(FieldVisitor& f, FuseOutputConfig& c);

/// What `canyon fuse --config FILE.toml` holds.
struct FuseConfig {
  fusion::FilterConfig fusion;
  FuseImuConfig imu;
  FuseGnssConfig gnss;
  FuseOdometerConfig odometer;
  FuseHeadingConfig heading;
  FusePosesConfig poses;
  FuseTruthConfig truth;
  FuseStartConfig start;
  fusion::TimelineConfig timeline{.held_s = 1.0};  ///< for as long as bridge_s: no curve ends at once
  FuseSmootherConfig smoother;
  FuseScoreConfig score;
  FuseOutputConfig output;
  ConfigNode file;  ///< not a key: where they were written, for messages
};
void visit(FieldVisitor& f, FuseConfig& c);

/// Reads the file; an empty path gives the defaults.
Result<FuseConfig> read_fuse_config(const std::string& path);
Result<FuseConfig> parse_fuse_config(std::string_view toml, const std::string& name);

/// What the filter is told of the unit: that of [fusion] imu, else of [imu] sensor, with the figures of [imu].
Result<ImuNoise> fuse_noise(const FuseConfig& config);

/// All keys but those of [fusion] as a Markdown table, for docs/fuse.md.
std::string fuse_key_reference();

/// An Error at the line where `key` was written, if it was.
Error at_key(const FuseConfig& config, const std::string& key, std::string what, std::string expected);

}  // namespace canyon::study
