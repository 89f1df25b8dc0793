#pragma once

#include <cstdint>
#include <string>

#include "canyon/core/model_choice.h"
#include "canyon/lidar/beam/echo_model.h"
#include "canyon/lidar/beam/see_through.h"
#include "canyon/lidar/beam/signal.h"
#include "canyon/lidar/beam/texture/texture.h"
#include "canyon/lidar/beam/weather.h"
#include "canyon/lidar/ego_mask.h"
#include "canyon/lidar/receiver/crosstalk.h"
#include "canyon/lidar/receiver/detector.h"
#include "canyon/lidar/receiver/sensor_report.h"

namespace canyon::lidar {

/// [lidar] of a mission file: the head, and the chain that a shot goes through. The keys of each part stand in the
/// part's own file; in the mission file all but the weather's are keys of this one section.
struct LidarConfig {
  std::string beams = "vlp16";                        ///< table in lidar/beams
  double rate_hz = 10.0;                              ///< revolutions per second
  std::int64_t azimuth_steps = 1800;                  ///< firings per revolution; 0 = as fast as the lasers can
  Eigen::Vector3d mount_m{0.3, 0.0, 1.8};             ///< L in B
  Eigen::Vector3d mount_yaw_pitch_roll_deg{0, 0, 0};  ///< R_BL
  double range_noise_m = 0.02;                        ///< 1-sigma; VLP-16 manual: +-3 cm typical accuracy
  double angle_noise_deg = 0.0;       ///< 1-sigma of the beam's true direction about the reported, each of two axes
  std::string deskew = "prediction";  ///< by whose motion within a revolution; deskewing_names()
  double latency_s = 0.0;             ///< the stamp is that much later than what was measured
  double wavelength_nm = 905.0;
  ModelChoice<echo_models> model{"single_ray"};
  Transparent see_through;  ///< default: nothing
  WeatherConfig weather;
  CrosstalkConfig crosstalk;
  SignalConfig signal;
  TextureConfig texture;
  ModelChoice<detectors> detector{"ideal"};
  ReportConfig report;
  EgoConfig ego;
  bool blinded = false;  ///< returns nothing (coupling studies)
};
void visit(FieldVisitor& f, LidarConfig& c);

}  // namespace canyon::lidar
