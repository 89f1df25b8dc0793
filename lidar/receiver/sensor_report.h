#pragma once

#include <span>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/truth.h"
#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/firing_pattern.h"
#include "canyon/lidar/beam/signal.h"
#include "canyon/lidar/beam/volley.h"
#include "canyon/lidar/receiver/detector.h"
#include "canyon/lidar/receiver/return_choice.h"

namespace canyon::lidar {

/// One return of each of sixteen neighbouring shots: the point in L and its truth.
struct alignas(64) ReturnPacket {
  static constexpr std::size_t kShots = AimPacket::kShots;
  struct alignas(16) Light {
    float x, y, z, intensity;
  };
  Light light[kShots];
  LidarPointTruth truth[kShots];
  std::uint32_t reported[kShots];  ///< 1, or 0: there is no such return
};

/// What the sensor reports of a volley. Layer k holds the k-th of each shot's returns.
struct VolleyReturns {
  std::vector<std::vector<ReturnPacket>> layers;
  std::size_t depth = 0;  ///< layers in use
  std::size_t lasers = 0, cycles = 0;
  double first_s = 0.0, step_s = 0.0;
  std::size_t total = 0;  ///< of returns
};

/// Keys of what the sensor reports.
struct ReportConfig {
  ReturnMode returns = ReturnMode::kStrongest;
  double min_range_m = 0.9;
  double max_range_m = 100.0;
  double range_quantum_m = 0.002;
  double range_bias_m = 0.0;  ///< 1-sigma of each laser's constant bias
};
void visit(FieldVisitor& f, ReportConfig& c);

/// The sensor's last steps: which of the detected echoes it reports, with the bias of their laser, in whole quanta,
/// within its limits, where the sensor believes it pointed.
class SensorReport {
 public:
  SensorReport(const ReportConfig& config, const SignalConfig& signal, const FiringPattern& pattern,
               std::uint64_t seed);

  void choose(const Volley& volley, const Echoes& echoes, VolleyReturns& out) const;
  /// The most returns that a shot has; 0: any number.
  std::size_t most_returns() const { return mode_ == ReturnMode::kAll ? 0 : mode_ == ReturnMode::kDual ? 2 : 1; }
  /// Returns as points, in the order of firing. Both spans are of `total` elements.
  void write(const VolleyReturns& returns, std::span<LidarPoint> points, std::span<LidarPointTruth> truth) const;

 private:
  ReturnMode mode_;
  double quantum_m_, min_m_, max_m_;
  float overlap_m2_;
  std::vector<double> bias_m_;  ///< by laser
  std::vector<std::size_t> firing_order_;
  std::vector<double> firing_s_;  ///< by laser
};

}  // namespace canyon::lidar
