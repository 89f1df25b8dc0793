#pragma once

#include "canyon/core/process/library_part.h"
#include "canyon/inertial/allan/noise_fit.h"
#include "canyon/inertial/calibration/triad_calibration.h"

namespace canyon::inertial {

Result<NoiseFit> fit_noise_with_ceres(std::span<const DeviationPoint> points, int points_per_octave,
                                      const std::vector<std::string>& allowed);
Result<TriadCalibration> fit_to_gravity_with_ceres(std::span<const Eigen::Vector3d> positions, double sigma_m_s2,
                                                   double gravity_m_s2);

/// What stands on Ceres (core/process/library_part.h).
struct CeresPart {
  decltype(&fit_noise_with_ceres) fit_noise;
  decltype(&fit_to_gravity_with_ceres) fit_to_gravity;
};
extern "C" [[gnu::weak]] const CeresPart canyon_ceres_part;

inline const CeresPart& ceres_part() {
  return library_part("ceres", &canyon_ceres_part);
}

}  // namespace canyon::inertial
