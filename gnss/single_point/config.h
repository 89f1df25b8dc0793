#pragma once

#include <string>
#include <vector>

#include "canyon/core/config/config.h"

namespace canyon::gnss {

/// How recorded observations become positions. Each `choice` names a row of that effect's table. The defaults are what
/// Canyon recommends for one frequency.
struct SinglePointConfig {
  std::string systems = "GREC";  ///< RINEX letters, of G R E C J
  double mask_deg = 10.0;
  double max_gdop = 30.0;

  std::string frequencies = "single";     ///< single | dual (ionosphere-free combination)
  std::string ephemeris = "nearest_toe";  ///< nearest_toe | transmitted
  std::string group_delay = "broadcast";  ///< none | broadcast | rtklib
  std::string ionosphere = "klobuchar";   ///< none | klobuchar | klobuchar_own | ionex
  std::string troposphere = "saastamoinen_niell";
  double shared_ionosphere = 0.5;  ///< 1-sigma of the modelled ionosphere's scale, an unknown; 0 = not solved
  double smoothing_s = 300.0;      ///< time constant of carrier smoothing; 0 = off

  std::string estimator = "least_squares";  ///< least_squares | kalman
  double acceleration_m_s2 = 1.0;           ///< kalman: white acceleration, m/s^2/sqrt(Hz)

  std::string weighting = "budget";
  double sigma_m = 0.5;
  double doppler_sigma_m_s = 0.05;  ///< of a range rate where that of the range is sigma_m
  std::string fault_exclusion = "greedy";
  double false_alarm = 1e-3;
  std::int64_t max_exclusions = 8;
};
void visit(FieldVisitor& f, SinglePointConfig& c);

/// Reads a TOML file of these keys.
Result<SinglePointConfig> read_single_point_config(const std::string& path);

}  // namespace canyon::gnss
