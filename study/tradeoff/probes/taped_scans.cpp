#include "canyon/study/tradeoff/probes/taped_scans.h"

#include "canyon/study/tradeoff/probes/true_tape.h"

namespace canyon::study {

Result<TapedScanner> TapedScanner::make(const ProbeSetup& setup, double pose_step_s) {
  CANYON_TRY(auto scanner, lidar::make_scanner(setup.config.lidar, static_cast<std::uint64_t>(setup.config.run.seed)));
  return TapedScanner(setup, std::move(scanner), pose_step_s);
}

double TapedScanner::margin_s() const {
  // Lasers that run free begin up to one firing cycle, below 1 ms, before the period (lidar/scan_drive.h).
  return 1.0 / setup_.config.lidar.rate_hz + setup_.config.lidar.latency_s + 1e-3;
}

Trajectory TapedScanner::poses(const TrueMotion& motion, std::int64_t k) const {
  return poses_of(motion, time_of(k) - margin_s(), time_of(k), pose_step_s_);
}

void TapedScanner::prepare(std::int64_t k) {
  if (!setup_.mission.traffic.empty())
    scene_.set_instances(setup_.mission.traffic.at(time_of(k) - setup_.mission.start));
}

void TapedScanner::scan(std::int64_t k, const Trajectory& poses, lidar::LidarOutput& out) {
  lidar::Scanner::InstancesAt moving;
  const double stamp_s = time_of(k) - setup_.mission.start;
  if (!setup_.mission.traffic.empty())
    moving = [&](double after_s) { return setup_.mission.traffic.at(stamp_s + after_s); };
  scanner_->scan(k, time_of(k), poses, scene_, moving, out);
}

}  // namespace canyon::study
