#pragma once

#include <string>

#include "canyon/core/config/config.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/single_point/group_delay.h"
#include "canyon/gnss/single_point/range_corrections.h"
#include "canyon/gnss/solver/pvt_filter.h"
#include "canyon/gnss/solver/reported_covariance.h"

namespace canyon::gnss {

/// One band alone, or the ionosphere-free combination of two.
enum class Frequencies { kSingle, kDual };

/// How recorded observations become positions. Each `choice` names a row of that effect's table. The defaults are what
/// Canyon recommends for one frequency.
struct SinglePointConfig {
  std::string systems = "GREC";  ///< RINEX letters, of G R E C J
  double mask_deg = 10.0;
  double max_gdop = 30.0;

  Frequencies frequencies = Frequencies::kSingle;
  EphemerisChoice ephemeris = EphemerisChoice::kNearestToe;
  GroupDelayModel group_delay = GroupDelayModel::kBroadcast;
  IonosphereCorrection ionosphere = IonosphereCorrection::kKlobuchar;
  std::string troposphere = "saastamoinen_niell";  ///< a row of troposphere_corrections()
  double shared_ionosphere = 0.5;  ///< 1-sigma of the modelled ionosphere's scale, an unknown; 0 = not solved
  double smoothing_s = 300.0;      ///< time constant of carrier smoothing; 0 = off

  Estimator estimator = Estimator::kLeastSquares;
  double acceleration_m_s2 = 1.0;  ///< kalman: white acceleration, m/s^2/sqrt(Hz)

  ModelChoice<reported_covariances> reported_covariance{"geometry"};
  double base_age_s = 30.0;  ///< with a base: how old or young its observations may be

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
