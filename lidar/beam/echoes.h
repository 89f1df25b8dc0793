#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "canyon/core/truth.h"
#include "canyon/lidar/beam/aim.h"
#include "canyon/lidar/beam/no_surface.h"

namespace canyon::lidar {

/// Light that came back from one distance of one shot.
struct Echo {
  /// Range (infinity: there is no echo), incidence, material and object.
  LidarPointTruth truth{.range_m = std::numeric_limits<float>::infinity(),
                        .cos_incidence = 0.0f,
                        .material = kNoMaterial,
                        .object = kNoObject};
  float reflectivity = 0;  ///< apparent: what a Lambertian surface square to the beam would need to give as much

  bool any() const { return truth.range_m < std::numeric_limits<float>::infinity(); }
};

/// One echo of each of sixteen neighbouring shots, and what the detector makes of it.
struct alignas(64) EchoPacket {
  static constexpr std::size_t kShots = AimPacket::kShots;
  float range_m[kShots], reflectivity[kShots];
  LidarPointTruth truth[kShots];
  float measured_m[kShots];  ///< 0 or infinity: not detected
  float intensity[kShots];

  Echo at(std::size_t lane) const { return {truth[lane], reflectivity[lane]}; }
  void set(std::size_t lane, const Echo& echo) {
    range_m[lane] = echo.truth.range_m;
    reflectivity[lane] = echo.reflectivity;
    truth[lane] = echo.truth;
  }
};

/// The echoes of all shots of a volley: layer k holds the (k + 1)-th nearest of each shot. There is always one layer,
/// and most often only one.
class Echoes {
 public:
  /// Beyond this many echoes of a shot the farthest are dropped.
  static constexpr std::size_t kMost = 32;

  /// Starts anew, with one layer, which the caller fills lane by lane: what is in it is left from before.
  std::span<EchoPacket> start(std::size_t packets);
  /// Adds an echo, keeping a shot's in the order of range; of equally far ones the new is the last.
  void insert(std::size_t shot, const Echo& echo);

  std::size_t layers() const { return layers_; }
  std::span<EchoPacket> layer(std::size_t k) { return {packets_[k].data(), packets_per_layer_}; }
  std::span<const EchoPacket> layer(std::size_t k) const { return {packets_[k].data(), packets_per_layer_}; }

 private:
  std::vector<std::vector<EchoPacket>> packets_;  ///< by layer; those from layers_ on wait to be used again
  std::size_t layers_ = 0, packets_per_layer_ = 0;
};

}  // namespace canyon::lidar
