#pragma once

#include "canyon/inertial/motion/motion.h"

/// Makers of the rows of the table in inertial/motion/motion.cpp, each in the file of its model.
namespace canyon::inertial {

Result<PlacedMotion> make_stationary(const MotionConfig& config);
Result<PlacedMotion> make_straight(const MotionConfig& config);
Result<PlacedMotion> make_circle(const MotionConfig& config);
Result<PlacedMotion> make_figure_eight(const MotionConfig& config);
Result<PlacedMotion> make_coning(const MotionConfig& config);
Result<PlacedMotion> make_spline(const MotionConfig& config);
Result<PlacedMotion> make_recorded(const MotionConfig& config);

/// The same motion, shaken.
Result<std::shared_ptr<const Motion>> with_vibration(std::shared_ptr<const Motion> motion,
                                                     const VibrationConfig& config, std::uint64_t seed);

/// W at the configured origin.
LocalFrame frame_of(const MotionConfig& config);

}  // namespace canyon::inertial
