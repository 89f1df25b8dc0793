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

/// First returns by beam: laser and firing within the revolution, for which every rung has the same place; and the
/// object that each is of.
struct FirstReturns {
  std::vector<double> range_m;
  std::vector<std::uint32_t> object;
};
FirstReturns first_returns(const lidar::LidarOutput& output, std::size_t firings) {
  constexpr std::size_t kLasers = 256;
  const LidarScan& scan = output.scan;
  FirstReturns out;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const LidarPoint& point = scan.points[i];
    if (point.return_index != 0 || point.ring >= kLasers) continue;
    const double turn = std::clamp(1.0 + double{point.time_s} / scan.period_s, 0.0, 1.0);
    const std::size_t firing = std::min(firings - 1, static_cast<std::size_t>(turn * static_cast<double>(firings)));
    const std::size_t place = point.ring * firings + firing;
    if (place >= out.range_m.size()) {
      out.range_m.resize(place + 1, kNaN);
      out.object.resize(place + 1, 0);
    }
    out.range_m[place] = std::sqrt(double{point.x} * point.x + double{point.y} * point.y + double{point.z} * point.z);
    out.object[place] = output.truth[i].object;
  }
  return out;
}

class RangeProbe final : public Probe {
 public:
  RangeProbe(const ProbeSetup& setup, double pose_step_s, bool same_object)
      : setup_(setup), config_(setup.config), pose_step_s_(pose_step_s), same_object_(same_object) {}

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
      FirstReturns returns = first_returns(output, firings);
      run.samples.values.push_back(std::move(returns.range_m));
      if (same_object_) run.samples.of.push_back(std::move(returns.object));
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
  bool same_object_;  ///< ranges to different objects are not compared
};

Result<std::unique_ptr<Probe>> make(const ProbeSetup& setup, bool same_object) {
  const double own_s = setup.own_number("motion.step_s");
  CANYON_TRY(const auto scanner, lidar::make_scanner(setup.config.lidar, 0));  // what it refuses is told before it runs
  return std::unique_ptr<Probe>(
      std::make_unique<RangeProbe>(setup, std::isnan(own_s) ? kMasterStep_s : own_s, same_object));
}

}  // namespace

Result<std::unique_ptr<Probe>> make_range_probe(const ProbeSetup& setup) {
  return make(setup, false);
}

Result<std::unique_ptr<Probe>> make_object_range_probe(const ProbeSetup& setup) {
  return make(setup, true);
}

}  // namespace canyon::study
