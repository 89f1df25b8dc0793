#include "canyon/gnss/receiver/link_budget.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {

namespace {

constexpr double kFadingLoopHz = 2.0 * 0.25 / kPi;  // 4 B / (2 pi)

}  // namespace

double LinkBudget::foliage_db(double length_m) const {
  return foliage_max_db * (1.0 - std::exp(-length_m * foliage_db_per_m / foliage_max_db));
}

double LinkBudget::direct_cn0_dbhz(double elevation_rad, double foliage_m, double field) const {
  return cn0_zenith_dbhz + antenna->rhcp_db(elevation_rad) - foliage_db(foliage_m) +
         20.0 * std::log10(std::max(field, 1e-10));
}

ReceivedSignal receive(const SignalPath& path, const LinkBudget& link, const Eigen::Vector3d& up_W,
                       const Eigen::Vector3d& to_satellite_W, const Eigen::Vector3d& v_A_W, double wavelength_m) {
  const double elevation_rad = std::asin(std::clamp(path.arrival_W.dot(up_W), -1.0, 1.0));
  const double right_gain = std::pow(10.0, link.antenna->rhcp_db(elevation_rad) / 20.0);
  const double left_gain = std::pow(10.0, link.antenna->lhcp_db(elevation_rad) / 20.0);
  const std::complex<double> right = path.copolar * right_gain;
  const std::complex<double> left = path.crosspolar * left_gain;
  double power = std::norm(right) + std::norm(left);
  if (path.spread > 0.0) {
    const double turns = v_A_W.norm() * path.spread / wavelength_m / kFadingLoopHz;
    const double stands = 1.0 / (1.0 + turns * turns);
    const double by_itself =
        path.gathered_copolar * right_gain * right_gain + path.gathered_crosspolar * left_gain * left_gain;
    power = stands * power + (1.0 - stands) * by_itself;
  }
  // -200 dB stands for "nothing", so that the figures stay finite.
  const double gain_db = 10.0 * std::log10(std::max(power, 1e-20));

  ReceivedSignal r;
  r.excess_m = path.excess_m;
  r.cn0_dbhz = link.cn0_zenith_dbhz - link.foliage_db(path.foliage_m) + gain_db;
  const double turns = path.excess_m / wavelength_m;
  // A longer way delays the phase.
  // The hands of many scatterers fade apart, and the phase must not jump as one passes the other: both count, each as
  // it is strong.
  const std::complex<double> phasor = path.spread > 0.0 ? std::abs(right) * right + std::abs(left) * left
                                      : std::norm(right) >= std::norm(left) ? right
                                                                            : left;
  r.phase_rad = std::arg(phasor) - 2.0 * kPi * (turns - std::floor(turns));
  r.doppler_hz = v_A_W.dot(path.arrival_W - to_satellite_W) / wavelength_m;
  return r;
}

void visit(FieldVisitor& f, LinkConfig& c) {
  f.number("foliage_db_per_m", c.foliage_db_per_m, {0.0, 10.0}, "specific attenuation of tree crowns");
  f.number("foliage_max_db", c.foliage_max_db, {0.1, 100.0}, "largest attenuation by foliage");
  f.number("cn0_zenith_dbhz", c.cn0_zenith_dbhz, {20.0, 60.0}, "C/N0 of a clear satellite at the zenith");
  visit_choice(f, "antenna", c.antenna, "gain pattern and phase centre of the antenna");
  f.flag("antenna_phase_centre", c.antenna_phase_centre, "the antenna's phase centre is off its nominal point");
}

Result<LinkBudget> LinkConfig::budget() const {
  LinkBudget link{cn0_zenith_dbhz, foliage_db_per_m, foliage_max_db, nullptr};
  CANYON_TRY(link.antenna, antenna.make("gnss.antenna"));
  return link;
}

}  // namespace canyon::gnss
