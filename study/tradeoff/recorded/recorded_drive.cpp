#include "canyon/study/tradeoff/recorded/recorded_drive.h"

#include "canyon/core/files/place_files.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/single_point/group_delay.h"

namespace canyon::study {
namespace {

constexpr std::size_t kFewest = 4;  // satellites, for a clock and more to be seen

/// The [gnss] keys of a recording, which are the mission's own; taken out of the tree.
std::vector<std::pair<std::string, ConfigNode>> take_receiver(ConfigNode& tree) {
  std::vector<std::pair<std::string, ConfigNode>> keys;
  if (const ConfigNode* gnss = tree.find("gnss"); gnss != nullptr && gnss->table() != nullptr)
    for (const auto& [key, value] : *gnss->table()) keys.emplace_back("gnss." + key, value);
  tree.erase("gnss");
  return keys;
}

Status check_named(const RecordingConfig& config, const std::string& path) {
  const auto missing = [&](const char* key) {
    return Error{path, 0, key, "is missing", "a file that the recording is made of"};
  };
  if (config.observations.empty()) return missing("observations");
  if (config.truth.empty()) return missing("truth");
  if (config.navigation.empty()) return missing("navigation");
  return gnss::check_systems(config.systems, "systems");
}

/// Lays every epoch that has a truth into the scene.
void add_epochs(const PlacePath& truth, RecordedDrive& drive) {
  const LocalFrame& frame = drive.scene->frame();
  for (const gnss::ObservationEpoch& observed : drive.data.observations.epochs) {
    throw_if_cancelled();
    const auto at = truth.at(observed.t);
    const double sow_s = observed.t.sow_s();
    if (!at || sow_s < drive.config.from_sow || sow_s > drive.config.to_sow) continue;
    RecordedEpoch epoch{.observed = &observed,
                        .t = observed.t,
                        .p_A_E = at->p_E,
                        .p_A_W = frame.to_W(at->p_E),
                        .v_A_W = frame.R_EW().transpose() * at->v_E,
                        .satellites = {}};
    epoch.satellites = recorded_satellites(drive, *drive.data.constellation, observed, at->p_E);
    if (epoch.satellites.size() >= kFewest) drive.epochs.push_back(std::move(epoch));
  }
}

}  // namespace

void visit(FieldVisitor& f, RecordingConfig& c) {
  f.file("observations", c.observations, "", "RINEX observations");
  f.files("navigation", c.navigation, "RINEX navigation files of the same day");
  f.files("sp3", c.sp3, "precise orbits of the same day, for the ladder of their interval");
  f.file("truth", c.truth, "", "true antenna: CSV of gps_week,sow and lat_deg,lon_deg,h_m or x_m,y_m,z_m");
  f.text("systems", c.systems, "satellite systems looked at, of G R E C J");
  f.number("mask_deg", c.mask_deg, {0.0, 89.0}, "satellites below this elevation are not looked at");
  f.number("from_sow", c.from_sow, {0.0, 604800.0}, "seconds of the GPS week from which the scene is complete");
  f.number("to_sow", c.to_sow, {0.0, 604800.0}, "and up to which");
  f.group("scene", c.scene, "as of a mission");
}

std::vector<const RecordedEpoch*> RecordedDrive::spread(std::size_t count) const {
  std::vector<const RecordedEpoch*> out;
  const std::size_t n = std::min(count, epochs.size());
  for (std::size_t i = 0; i < n; ++i) out.push_back(&epochs[(2 * i + 1) * epochs.size() / (2 * n)]);
  return out;
}

std::vector<RecordedSatellite> recorded_satellites(const RecordedDrive& drive, const gnss::Constellation& constellation,
                                                   const gnss::ObservationEpoch& epoch, const Eigen::Vector3d& p_A_E) {
  const gnss::GroupDelays delays(gnss::GroupDelayModel::kBroadcast, drive.data.navigation);
  const gnss::Horizon horizon(p_A_E);
  std::vector<RecordedSatellite> out;
  for (const gnss::SatelliteObservations& one : epoch.satellites) {
    if (drive.config.systems.find(system_letter(one.sv.system)) == std::string::npos) continue;
    const auto signal = gnss::single_frequency_signal(drive.data.observations.codes(epoch, one.sv.system), one);
    if (!signal) continue;
    const auto sent = gnss::transmission_from_pseudorange(constellation, one.sv, epoch.t, signal->pseudorange_m);
    if (!sent) continue;
    const int band = signal->code.band - '0';
    RecordedSatellite satellite{.sv = one.sv, .cn0_dbhz = signal->cn0_dbhz};
    satellite.frequency_hz = gnss::carrier_hz(one.sv.system, band, sent->state.frequency_channel);
    if (!std::isfinite(satellite.frequency_hz)) continue;
    const double clock_s = sent->state.clock_s - delays.delay_s(sent->state, one.sv, band, std::nullopt);
    satellite.range_m = signal->pseudorange_m + kSpeedOfLight * clock_s;
    satellite.p_transmitted_E = sent->state.p_E;
    satellite.p_E = gnss::turned_by_earth(sent->state.p_E, (sent->state.p_E - p_A_E).norm() / kSpeedOfLight);
    const gnss::SkyView view = horizon.view(epoch.t, satellite.p_E);
    satellite.elevation_rad = view.elevation_rad;
    satellite.azimuth_rad = view.azimuth_rad;
    if (view.elevation_rad >= drive.config.mask_deg * kDegree) out.push_back(satellite);
  }
  return out;
}

Result<std::unique_ptr<const RecordedDrive>> read_recorded_drive(const std::string& path) {
  CANYON_TRY(ConfigNode tree, ConfigNode::load(path));
  auto drive = std::make_unique<RecordedDrive>();
  drive->name = path;
  drive->receiver = take_receiver(tree);
  CANYON_TRY_STATUS(read_config(&tree, "", drive->config));
  const RecordingConfig& config = drive->config;
  CANYON_TRY_STATUS(check_named(config, path));
  CANYON_TRY(auto places, read_places(config.truth));
  for (const StampedPlace& place : places)
    CANYON_TRY_STATUS(gnss::check_antenna_height(place.p_E, {.file = config.truth, .line = place.line}));
  gnss::SinglePointConfig reading;
  reading.systems = config.systems;
  gnss::RecordedFiles files;
  files.observations = config.observations;
  files.navigation = config.navigation;
  CANYON_TRY(drive->data, gnss::read_recorded_data(files, reading));
  if (!config.sp3.empty()) {
    CANYON_TRY(drive->sp3, gnss::read_sp3_files(config.sp3));
  }
  mission::SceneCache scenes;
  CANYON_TRY(drive->scene, scenes.get(config.scene));
  add_epochs(PlacePath(std::move(places)), *drive);
  if (drive->epochs.empty())
    return Error{config.observations, 0, "", "no epoch with four satellites at a time of " + config.truth,
                 "a truth of the same time"};
  return std::unique_ptr<const RecordedDrive>(std::move(drive));
}

mission::MissionFile with_receiver(mission::MissionFile file, const RecordedDrive& drive) {
  for (const auto& [key, value] : drive.receiver) file.set_option(key, value, drive.name);
  return file;
}

}  // namespace canyon::study
