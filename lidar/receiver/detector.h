#pragma once

#include <memory>
#include <vector>

#include "canyon/core/model_choice.h"
#include "canyon/core/random/random.h"
#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/volley.h"

namespace canyon::lidar {

struct LidarConfig;

/// What the receiver makes of the echoes: sets measured_m and intensity. Const and thread-safe.
class Detector {
 public:
  virtual ~Detector() = default;
  virtual void detect(const Volley& volley, Echoes& echoes) const = 0;
  /// 1-sigma of what the faintest detected echo's edge adds to the range noise, m.
  virtual double weakest_edge_m() const { return 0.0; }
  /// The most that a range reads short beside its noise, m.
  virtual double most_short_m() const { return 0.0; }
};

/// `[lidar] detector`.
using MakeDetector = std::unique_ptr<Detector>(const ModelParameters& own, const LidarConfig& config,
                                               std::uint64_t seed);
ModelTable<MakeDetector> detectors();

std::unique_ptr<Detector> make_ideal_detector(const ModelParameters& own, const LidarConfig& config,
                                              std::uint64_t seed);
std::unique_ptr<Detector> make_radiometric_detector(const ModelParameters& own, const LidarConfig& config,
                                                    std::uint64_t seed);
void radiometric_parameters(ModelParameters& section);

/// Standard normal draws of each shot's echo in a layer: entity = laser, index = firing cycle, n = layer.
void fill_shot_normals(const RandomStream& stream, const Volley& volley, std::size_t layer, std::vector<double>& out);

}  // namespace canyon::lidar
