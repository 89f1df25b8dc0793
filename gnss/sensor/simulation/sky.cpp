#include "canyon/gnss/sensor/simulation/sky.h"

#include <cmath>

#include "canyon/core/output/printed.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"

namespace canyon::gnss {

std::vector<SkyEpoch> follow_sky(GnssSensor& sensor, const GnssConfig& config, GpsTime start, double duration_s,
                                 double step_s, const Eigen::Vector3d& p_A_W, const scene::SceneAt& scene) {
  const auto count = static_cast<std::int64_t>(std::floor(duration_s / step_s + 1e-9)) + 1;
  std::vector<SkyEpoch> epochs;
  for (std::int64_t k = 0; k < count; ++k) {
    throw_if_cancelled();
    const double t_s = static_cast<double>(k) * step_s;
    epochs.push_back(
        {t_s, sensor.measure(epoch_index(config, t_s), start + t_s, p_A_W, Eigen::Vector3d::Zero(), scene)});
  }
  return epochs;
}

double cn0_of(const GnssOutput& output, SatelliteId sv) {
  for (const GnssObservation& o : output.epoch.observations)
    if (o.sv == sv) return o.cn0_dbhz;
  return kNaN;
}

std::string sky_satellites_csv(const std::vector<SkyEpoch>& epochs) {
  std::string out = "t_s,satellite,elevation_deg,azimuth_deg,cn0_dbhz,line_of_sight,tracked,reflections,multipath_m\n";
  for (const SkyEpoch& e : epochs) {
    throw_if_cancelled();
    for (const GnssObservationTruth& s : e.output.truth.satellites) {
      const double cn0 = cn0_of(e.output, s.sv);
      out += printed("%.3f,%s,%.3f,%.3f,%s,%d,%d,%d,%s\n", e.t_s, s.sv.str().c_str(), s.elevation_rad / kDegree,
                     s.azimuth_rad / kDegree, std::isfinite(cn0) ? printed("%.2f", cn0).c_str() : "",
                     s.line_of_sight ? 1 : 0, s.tracked ? 1 : 0, s.reflections,
                     s.tracked ? printed("%.3f", s.multipath_m).c_str() : "");
    }
  }
  return out;
}

std::string sky_dop_csv(const std::vector<SkyEpoch>& epochs) {
  std::string out = "t_s,satellites,gdop,pdop,hdop,vdop,tdop\n";
  for (const SkyEpoch& e : epochs) {
    out += printed("%.3f,%d", e.t_s, e.output.fix.satellites);
    const Dop& d = e.output.fix.dop;
    for (const double dop : {d.gdop, d.pdop, d.hdop, d.vdop, d.tdop})
      out += std::isfinite(dop) ? printed(",%.3f", dop) : std::string(",");
    out += "\n";
  }
  return out;
}

}  // namespace canyon::gnss
