#pragma once

#include <memory>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/single_point/recorded_data.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/scene/scene_source.h"

namespace canyon::study {

/// What `canyon tradeoff --recording FILE` reads: a drive that a receiver recorded, with its surveyed truth and the
/// scene that it led through.
struct RecordingConfig {
  std::string observations, truth;
  std::vector<std::string> navigation, sp3;
  std::string systems = "G";
  double mask_deg = 10.0;
  double from_sow = 0.0, to_sow = 604800.0;  ///< seconds of the week: the stretch that the scene covers
  scene::SceneConfig scene;
};
void visit(FieldVisitor& f, RecordingConfig& c);

/// One satellite as it was observed.
struct RecordedSatellite {
  SatelliteId sv;
  double frequency_hz = kNaN;
  double cn0_dbhz = kNaN;
  double range_m =
      kNaN;  ///< pseudorange with the satellite's clock and group delay applied: range, receiver clock, delays
  Eigen::Vector3d p_E = Eigen::Vector3d::Zero();              ///< at transmission, in E of reception
  Eigen::Vector3d p_transmitted_E = Eigen::Vector3d::Zero();  ///< the same in E of transmission
  double elevation_rad = 0.0, azimuth_rad = 0.0;              ///< at the true antenna
  /// What is in the pseudorange beside the geometric range: receiver clock, atmosphere, reflections, noise.
  double beyond_m(const Eigen::Vector3d& p_A_E) const { return range_m - (p_E - p_A_E).norm(); }
};

struct RecordedEpoch {
  const gnss::ObservationEpoch* observed = nullptr;
  GpsTime t;
  Eigen::Vector3d p_A_E, p_A_W, v_A_W;        ///< the true antenna
  std::vector<RecordedSatellite> satellites;  ///< of the systems asked for, above the mask, with a pseudorange
};

/// A recorded drive, read and laid into its scene. Not to be copied: epochs point into its data.
struct RecordedDrive {
  std::string name;
  RecordingConfig config;
  std::vector<std::pair<std::string, ConfigNode>> receiver;  ///< keys of [gnss] that tell what recorded
  std::shared_ptr<const scene::Scene> scene;
  gnss::RecordedData data;
  gnss::PreciseOrbits sp3;            ///< empty where there are none
  std::vector<RecordedEpoch> epochs;  ///< that have a truth, and four satellites at least

  /// `count` of them, spread evenly over the drive; all where there are no more.
  std::vector<const RecordedEpoch*> spread(std::size_t count) const;
};

/// Errors with file, line and key: what is missing or malformed in the file and in those that it names; no epoch with a
/// truth and four satellites.
Result<std::unique_ptr<const RecordedDrive>> read_recorded_drive(const std::string& path);

/// The satellites of an epoch, as `constellation` places them, for an antenna at p_A_E.
std::vector<RecordedSatellite> recorded_satellites(const RecordedDrive& drive, const gnss::Constellation& constellation,
                                                   const gnss::ObservationEpoch& epoch, const Eigen::Vector3d& p_A_E);

/// The mission whose ladders are measured on it, with the receiver that recorded.
mission::MissionFile with_receiver(mission::MissionFile file, const RecordedDrive& drive);

}  // namespace canyon::study
