#include "canyon/gnss/receiver/reports/cn0_estimator.h"

#include <algorithm>
#include <cmath>

namespace canyon::gnss {
namespace {

/// A first-order loop of this bandwidth forgets by exp(-dt / averaging).
double forgetting_hz(double averaging_s) {
  return averaging_s > 0.0 ? 1.0 / (4.0 * averaging_s) : 1.0;
}

}  // namespace

void visit(FieldVisitor& f, Cn0ReportConfig& c) {
  f.number("cn0_averaging_s", c.averaging_s, {0.0, 100.0},
           "time over which the receiver estimates the C/N0 that it reports, with noise accordingly; 0 = exact");
  f.number("cn0_resolution_db", c.resolution_db, {0.0, 10.0}, "step of the reported C/N0; 0 = none");
}

double cn0_noise_db(double cn0_dbhz, double averaging_s, double integration_s) {
  const double rho = std::pow(10.0, 0.1 * cn0_dbhz) * integration_s;
  const double samples = std::max(1.0, averaging_s / integration_s);
  return 10.0 / std::log(10.0) * std::sqrt((1.0 + 2.0 / rho) / samples);
}

Cn0Estimator::Cn0Estimator(std::uint64_t seed, const std::string& name, const Cn0ReportConfig& config,
                           double integration_s, double interval_s)
    : config_(config),
      integration_s_(integration_s),
      noise_(seed, name, forgetting_hz(config.averaging_s), interval_s) {}

double Cn0Estimator::reported_dbhz(double cn0_dbhz, std::uint32_t entity, std::int64_t index) const {
  double out = cn0_dbhz;
  if (config_.averaging_s > 0.0)
    out += cn0_noise_db(cn0_dbhz, config_.averaging_s, integration_s_) * noise_.at(entity, index);
  if (config_.resolution_db > 0.0) out = config_.resolution_db * std::round(out / config_.resolution_db);
  // A receiver of any kind would not give out what it cannot track by.
  if (config_.averaging_s > 0.0 || config_.resolution_db > 0.0) out = std::max(out, 0.0);
  return out;
}

}  // namespace canyon::gnss
