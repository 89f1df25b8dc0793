#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/config.h"
#include "core/imu_noise.h"
#include "core/local_frame.h"
#include "core/messages.h"
#include "core/result.h"
#include "core/truth.h"

namespace canyon::inertial {

/// [imu] of a mission file.
struct ImuConfig {
  std::string sensor = "high_grade_mems";  ///< entry of inertial/catalogue
  std::string errors = "datasheet";        ///< datasheet | white_only | paper | none
  double rate_hz = 100.0;
  Eigen::Vector3d lever_arm_m{0.0, 0.0, 0.4};  ///< U in B; axes of U parallel to B
};
void visit(FieldVisitor& f, ImuConfig& c);

/// An IMU: exact increments of the true motion, then its error chain.
class ImuModel {
 public:
  virtual ~ImuModel() = default;
  /// Sample k over (nodes.front().t, nodes.back().t]. `nodes` are equally spaced kinematic states of the true motion,
  /// an odd number >= 3 (Simpson) or 5 (Boole); the increments are quadratures of w_IU_U and f_U over them.
  virtual ImuSample sample(std::int64_t k, std::span<const KinematicState> nodes) = 0;
  /// What the filter should be told of this unit.
  virtual const ImuNoise& noise() const = 0;
};

Result<std::unique_ptr<ImuModel>> make_imu(const ImuConfig& config, std::uint64_t seed, const LocalFrame& frame);

/// The datasheet noise of a catalogue entry.
Result<ImuNoise> catalogue_noise(const std::string& sensor);

}  // namespace canyon::inertial
