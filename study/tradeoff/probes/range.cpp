#include <algorithm>
#include <cmath>

#include "canyon/core/process/cpu_time.h"
#include "canyon/core/process/progress.h"
#include "canyon/study/tradeoff/probes/heap_meter.h"
#include "canyon/study/tradeoff/probes/models.h"
#include "canyon/study/tradeoff/probes/taped_scans.h"
#include "canyon/study/tradeoff/probes/true_tape.h"

namespace canyon::study {
namespace {

constexpr double kMasterStep_s = 0.01;  ///< of the poses that a run buffers (mission::Vehicle::kStep_ns)

/// First returns by beam: laser and firing within the revolution, for which every rung has the same place.
std::vector<double> ranges_of(const LidarScan& scan, std::size_t firings) {
  constexpr std::size_t kLasers = 256;
  std::vector<double> out;
  for (const LidarPoint& point : scan.points) {
    if (point.return_index != 0 || point.ring >= kLasers) continue;
    const double turn = std::clamp(1.0 + double{point.time_s} / scan.period_s, 0.0, 1.0);
    const std::size_t firing = std::min(firings - 1, static_cast<std::size_t>(turn * static_cast<double>(firings)));
    const std::size_t place = point.ring * firings + firing;
    if (place >= out.size()) out.resize(place + 1, kNaN);
    out[place] = std::sqrt(double{point.x} * point.x + double{point.y} * point.y + double{point.z} * point.z);
  }
  return out;
}

class RangeProbe final : public Probe {
 public:
  RangeProbe(const ProbeSetup& setup, double pose_step_s)
      : setup_(setup), config_(setup.config), pose_step_s_(pose_step_s) {}

  Result<ProbeRun> run() override {
    const HeapMeter heap;
    CANYON_TRY(TapedScanner scanner, TapedScanner::make(setup_, pose_step_s_));
    const TrueMotion motion = true_motion(setup_.tape, setup_.mission.start);
    const std::size_t firings =
        config_.lidar.azimuth_steps > 0 ? static_cast<std::size_t>(config_.lidar.azimuth_steps) : 4096;
    ProbeRun run;
    CpuAccount account;
    lidar::LidarOutput output;
    const auto ticks = spread_ticks(setup_, config_.lidar.rate_hz, scanner.margin_s() + 0.1);
    for (const std::int64_t k : ticks) {
      throw_if_cancelled();
      const Trajectory poses = scanner.poses(motion, k);
      scanner.prepare(k);
      {
        const ChargeCpu charge(&account);
        scanner.scan(k, poses, output);
      }
      run.samples.values.push_back(ranges_of(output.scan, firings));
    }
    run.cpu_s = account.seconds();
    run.simulated_s = static_cast<double>(ticks.size()) / config_.lidar.rate_hz;
    run.work = scanner.rays();
    run.memory_mb = heap.grown_mb();
    return run;
  }

 private:
  ProbeSetup setup_;
  const mission::MissionConfig config_;
  double pose_step_s_;
};

}  // namespace

Result<std::unique_ptr<Probe>> make_range_probe(const ProbeSetup& setup) {
  const double own_s = setup.own_number("motion.step_s");
  CANYON_TRY(const auto scanner, lidar::make_scanner(setup.config.lidar, 0));  // what it refuses is told before it runs
  return std::unique_ptr<Probe>(std::make_unique<RangeProbe>(setup, std::isnan(own_s) ? kMasterStep_s : own_s));
}

}  // namespace canyon::study
