#include "gnss/receiver/link_budget.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "gnss/signal.h"

namespace canyon::gnss {

double LinkBudget::antenna_gain_db(double elevation_rad) const {
  return -antenna_horizon_loss_db * (1.0 - std::sin(elevation_rad));
}

double LinkBudget::foliage_db(double length_m) const {
  return foliage_max_db * (1.0 - std::exp(-length_m * foliage_db_per_m / foliage_max_db));
}

double LinkBudget::direct_cn0_dbhz(double elevation_rad, double foliage_m, double field) const {
  return cn0_zenith_dbhz + antenna_gain_db(elevation_rad) - foliage_db(foliage_m) +
         20.0 * std::log10(std::max(field, 1e-10));
}

ReceivedReflection receive(const SignalPath& path, const LinkBudget& link, const Eigen::Vector3d& up_W) {
  const std::complex<double> right = path.copolar;
  const std::complex<double> left = path.crosspolar * std::pow(10.0, -link.lhcp_rejection_db / 20.0);
  // -200 dB stands for "nothing", so that the figures stay finite.
  const double loss_db = 10.0 * std::log10(std::max(std::norm(right) + std::norm(left), 1e-20));
  const double elevation_rad = std::asin(std::clamp(path.arrival_W.dot(up_W), -1.0, 1.0));

  ReceivedReflection r;
  r.excess_m = path.excess_m;
  r.cn0_dbhz = link.direct_cn0_dbhz(elevation_rad, path.foliage_m) + loss_db;
  const double turns = path.excess_m / kL1WavelengthM;
  // A longer way delays the phase.
  r.phase_rad = std::arg(std::norm(right) >= std::norm(left) ? right : left) - 2.0 * kPi * (turns - std::floor(turns));
  return r;
}

}  // namespace canyon::gnss
