#pragma once

#include <memory>
#include <vector>

#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/volley.h"
#include "canyon/lidar/lidar_config.h"

namespace canyon::lidar {

/// What the receiver makes of the echoes: sets measured_m and intensity. Const and thread-safe.
class Detector {
 public:
  virtual ~Detector() = default;
  virtual void detect(const Volley& volley, Echoes& echoes) const = 0;
};

/// One row per model: `[lidar] detector`.
struct DetectorRow {
  const char* name;
  std::unique_ptr<Detector> (*make)(const LidarConfig& config, std::uint64_t seed);
  const char* doc;
};
const std::vector<DetectorRow>& detectors();

std::unique_ptr<Detector> make_ideal_detector(const LidarConfig& config, std::uint64_t seed);
std::unique_ptr<Detector> make_radiometric_detector(const LidarConfig& config, std::uint64_t seed);

/// Energy received from a surface of apparent reflectivity 1 at range_m, in units of the detection threshold:
/// 10 (range_at_10_percent / range)^2. Nearer than full_overlap_m emitter and receiver look past each other in part,
/// which takes as much as nearness brings: the value there. That this is at 5 m is an assumption: makers do not tell.
double signal_gain(const LidarConfig& config, double range_m);

/// Standard normal draws of each shot's echo in a layer: entity = laser, index = firing cycle, n = layer.
void fill_shot_normals(const RandomStream& stream, const Volley& volley, std::size_t layer, std::vector<double>& out);

}  // namespace canyon::lidar
