#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/imu_noise.h"
#include "canyon/core/messages.h"
#include "canyon/core/motion/true_motion.h"
#include "canyon/core/result.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/imu_config.h"

namespace canyon::inertial {

/// An IMU: exact increments of the true motion along its own axes, then its error chain.
class ImuModel {
 public:
  virtual ~ImuModel() = default;
  /// Sample k over (nodes.front().t, nodes.back().t]. `nodes` are equally spaced kinematic states of the true motion,
  /// an odd number >= 3 (Simpson) or 5 (Boole); the increments are quadratures of w_IU_U and f_U over them.
  virtual ImuSample sample(std::int64_t k, std::span<const KinematicState> nodes) = 0;
  /// Sample k over (from, to], which need not be the motion's own steps.
  virtual ImuSample sample(std::int64_t k, const TrueMotion& motion, GpsTime from, GpsTime to) = 0;
  /// The attitude of its axes in B: truth, for recorder, scorer and sensors that sit in the same box.
  virtual Eigen::Quaterniond R_BU() const = 0;
  /// What makes up this unit's errors, as far as a filter can be told.
  virtual const ImuNoise& noise() const = 0;
};

/// `noise_seed`, where given, is that of the white noise alone, so that it can be another while biases and gains stay.
/// Chains that are not made of links (inertial/error_chain.h) have none of their own.
Result<std::unique_ptr<ImuModel>> make_imu(const ImuConfig& config, std::uint64_t seed, const LocalFrame& frame,
                                           std::optional<std::uint64_t> noise_seed = {});

/// The error chain of that configuration alone, for increments that come from elsewhere.
Result<std::unique_ptr<ErrorChain>> make_error_chain(const ImuConfig& config, std::uint64_t seed,
                                                     std::optional<std::uint64_t> noise_seed = {});

/// The datasheet noise of a catalogue entry.
Result<ImuNoise> catalogue_noise(const std::string& sensor);
/// The datasheet noise of the unit that `config` names, with its gyroscope where that is another entry's; which errors
/// it is simulated with does not count.
Result<ImuNoise> datasheet_noise(const ImuConfig& config);

}  // namespace canyon::inertial
