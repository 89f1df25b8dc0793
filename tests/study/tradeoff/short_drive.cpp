#include "canyon/tests/study/tradeoff/short_drive.h"

#include <cstdio>
#include <filesystem>

#include <unistd.h>

#include "canyon/core/files/files.h"
#include "canyon/gnss/sensor/sensor.h"
#include "canyon/gnss/sensor/simulation/drive.h"
#include "canyon/gnss/sensor/simulation/drive_files.h"
#include "canyon/study/tradeoff/probes/true_tape.h"
#include "canyon/study/tradeoff/tradeoff.h"

namespace canyon::study::testing {
namespace {

constexpr const char* kDrive = R"(base = "vicksburg"
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[autonomy]
[[autonomy.waypoint]]
name = "house"
p_m = [213.9, 150.0]
observe = "building 273"
)";

/// The receiver that records: without what it smooths and without what of a street is drawn by chance.
mission::MissionConfig recording_config() {
  mission::MissionFile file = short_drive_file();
  for (const auto& [key, value] : {std::pair{"gnss.receiver", "snapshot_gps"},
                                   {"gnss.scatter", "none"},
                                   {"gnss.clutter", "none"},
                                   {"gnss.mode", "single_uncorrected"},
                                   {"gnss.ephemeris_error", "none"},
                                   {"gnss.paths", "specular2"},
                                   {"gnss.diffraction", "none"},
                                   {"gnss.ionosphere", "klobuchar"},
                                   {"gnss.troposphere", "standard"}})
    file.set_option(key, ConfigNode::of(std::string(value)), "test");
  file.set_option("gnss.thermal_noise_scale", ConfigNode::of(0.0), "test");
  return *file.resolve("high");
}

/// The antenna's way along the tape, every half second.
std::vector<StampedPlace> places_of(const Comparison& drive, const Eigen::Vector3d& lever_B) {
  const mission::PreparedMission& mission = drive.missions.front();
  const TrueMotion motion = true_motion(*drive.tape, mission.start);
  std::vector<StampedPlace> places;
  for (int k = 0; mission.start + 0.5 * k <= motion.last(); ++k) {
    const GpsTime t = mission.start + 0.5 * k;
    places.push_back({t, mission.scene->frame().to_E(motion.at(t).X_WB * lever_B)});
  }
  return places;
}

std::string truth_csv(const std::vector<StampedPlace>& places) {
  std::string out = "gps_week,sow,x_m,y_m,z_m\n";
  for (const StampedPlace& place : places) {
    char row[128];
    std::snprintf(row, sizeof row, "%d,%.3f,%.6f,%.6f,%.6f\n", place.t.week(), place.t.sow_s(), place.p_E.x(),
                  place.p_E.y(), place.p_E.z());
    out += row;
  }
  return out;
}

/// The folder goes with the process.
struct Folder {
  std::string path = std::filesystem::temp_directory_path() / ("canyon_recording_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};

Status write_recording(const std::string& folder) {
  const Comparison& drive = short_drive();
  const mission::PreparedMission& mission = drive.missions.front();
  const mission::MissionConfig config = recording_config();
  std::vector<StampedPlace> places = places_of(drive, config.gnss.lever_arm_m);
  CANYON_TRY_STATUS(write_text_file(folder + "/truth.csv", truth_csv(places)));
  const double duration_s = places.back().t - places.front().t;
  const gnss::Drive way{.path = PlacePath(std::move(places)),
                        .path_name = "truth.csv",
                        .start = mission.start,
                        .duration_s = duration_s,
                        .rate_hz = config.gnss.rate_hz};
  CANYON_TRY(const auto sensor,
             gnss::make_gnss_sensor(config.gnss, 1, mission.start, mission.start + duration_s, *mission.scene));
  gnss::DriveFiles files(0.0);
  CANYON_TRY(const auto totals,
             gnss::simulate_drive(way, *sensor, *mission.scene, [&](const auto& output) { files.add(output); }));
  CANYON_TRY(const auto source,
             gnss::make_satellite_source(config.gnss.satellites, mission.start, mission.start + duration_s));
  CANYON_TRY(const std::string observed, files.rinex_observations(way, source, "drive.obs"));
  std::vector<std::string> warnings;
  CANYON_TRY(const std::string navigation,
             gnss::rinex_navigation(source, "G", mission.start, mission.start + duration_s, warnings));
  CANYON_TRY_STATUS(write_text_file(folder + "/drive.obs", observed));
  CANYON_TRY_STATUS(write_text_file(folder + "/drive.nav", navigation));
  return write_text_file(folder + "/drive.toml",
                         "observations = \"drive.obs\"\nnavigation = [\"drive.nav\"]\ntruth = \"truth.csv\"\n"
                         "[gnss]\nreceiver = \"snapshot_gps\"\nscatter = \"none\"\nclutter = \"none\"\n");
}

}  // namespace

const mission::MissionFile& short_drive_file() {
  static const mission::MissionFile file = *mission::MissionFile::parse(kDrive, "drive.toml");
  return file;
}

const Comparison& short_drive() {
  static const Comparison made = *prepare_tradeoff(short_drive_file(), {.parts = {"gnss"}, .show_progress = false}, {});
  return made;
}

std::string made_recording_path() {
  static const Folder folder;
  static const Status written = write_recording(folder.path);
  if (!written) throw std::runtime_error(written.error().str());
  return folder.path + "/drive.toml";
}

const RecordedDrive& made_recording() {
  static const auto read = [] {
    auto drive = read_recorded_drive(made_recording_path());
    if (!drive) throw std::runtime_error(drive.error().str());
    return *std::move(drive);
  }();
  return *read;
}

}  // namespace canyon::study::testing
