#include "canyon/study/reproduce/paper_receiver.h"

#include "canyon/core/process/progress.h"
#include "canyon/scene/flat_ground.h"
#include "canyon/scene/scene_at.h"

namespace canyon::study {

gnss::GnssConfig error_free_receiver(const PaperSky& sky, const char* mode, const char* solver) {
  gnss::GnssConfig c;
  c.satellites = sky.satellites;
  c.mode.name = mode;
  c.position.solver.name = solver;
  c.position.weighting.name = "uniform";
  c.ionosphere.name = c.troposphere.name = c.ephemeris_error.name = "none";
  c.propagation.paths.name = c.reception.multipath_rule.name = "none";
  c.receiver_clock.name = "none";
  c.tracking.thermal_noise_scale = 0.0;
  c.mask_deg = 18.0;
  return c;
}

Result<std::vector<gnss::GnssOutput>> measured(const gnss::GnssConfig& config, std::uint64_t seed, GpsTime start,
                                               const PaperWay& way) {
  gnss::GnssConfig c = config;
  c.rate_hz = way.rate_hz;
  const scene::Scene& field = scene::flat_ground();
  const scene::SceneAt at(field);
  CANYON_TRY(const auto sensor, gnss::make_gnss_sensor(c, seed, start, start + way.seconds, field));
  std::vector<gnss::GnssOutput> out;
  const auto epochs = static_cast<std::int64_t>(way.seconds * way.rate_hz);
  for (std::int64_t k = 0; k < epochs; ++k) {
    if (k % 64 == 0) throw_if_cancelled();
    const double t_s = static_cast<double>(k) / way.rate_hz, h_s = 0.5 / way.rate_hz;
    const Eigen::Vector3d v_W = (way.p_W(t_s + h_s) - way.p_W(t_s - h_s)) / (2.0 * h_s);
    out.push_back(sensor->measure(k, start + t_s, way.p_W(t_s), v_W, at));
  }
  return out;
}

}  // namespace canyon::study
