#pragma once

#include <memory>
#include <vector>

#include "canyon/core/model_choice.h"
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

/// Keys of what the energy of an echo depends on.
struct SignalConfig {
  double pulse_m = 0.75;                ///< length of the pulse, 5 ns (HDL-64E manual), as range
  double range_at_10_percent_m = 50.0;  ///< where a 10 % target square to the beam is at the detection threshold
  double full_overlap_m = 5.0;          ///< nearer, the signal is constant
};
void visit(FieldVisitor& f, SignalConfig& c);

/// Energy received from a surface of apparent reflectivity 1 at range_m, in units of the detection threshold:
/// 10 (range_at_10_percent / range)^2. Nearer than full_overlap_m emitter and receiver look past each other in part,
/// which takes as much as nearness brings: the value there. That this is at 5 m is an assumption: makers do not tell.
double signal_gain(const SignalConfig& signal, double range_m);

/// Square of the range below which nearness brings no more energy (full_overlap_m), m^2: received energy is
/// reflectivity / max(range^2, this).
float full_overlap_m2(const SignalConfig& signal);

/// Standard normal draws of each shot's echo in a layer: entity = laser, index = firing cycle, n = layer.
void fill_shot_normals(const RandomStream& stream, const Volley& volley, std::size_t layer, std::vector<double>& out);

}  // namespace canyon::lidar
