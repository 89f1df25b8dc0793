// Drives of scans, and what the motion has to cover of them.
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/lidar/scan_drive.h"
#include "canyon/lidar/scanner.h"
#include "canyon/lidar/stress/beams/closed_room.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {
namespace {

using made::closed_room;
using made::kScanAt;

/// Drives of scans whose motion begins or ends a little too late or too soon are refused before anything is scanned, as
/// are scans of a negative number; a microsecond is rounding. A figure counts.
StressFigure not_covered() {
  StressFigure out;
  ScanDrive drive;
  drive.scene = closed_room(false);
  drive.lidar.beams = "grid:2:-5:5", drive.lidar.azimuth_steps = 40, drive.lidar.latency_s = 0.03;
  drive.start = kScanAt, drive.scans = 5;
  // From a period, the latency and a millisecond before the first stamp to the last one, 0.4 s on.
  const auto covers = [&](double from_s, double to_s) {
    drive.motion = {};
    for (const double dt : {from_s, 0.1, to_s}) drive.motion.append({kScanAt + dt, Pose{}});
    int scans = 0;
    const bool refused = stress::not_refused([&] {
                           const auto cost = scan_drive(drive, 1, [&](auto, auto, const auto&, const auto&) {
                             ++scans;
                             return Status(Ok{});
                           });
                           out.figure += cost.ok() ? 0.0 : 1.0;
                         }) == 0;
    out.figure += scans == (refused ? 0 : 5) ? 0.0 : 1.0;
    return !refused;
  };
  out.figure += covers(-0.131, 0.4) && covers(-0.131 + 5e-7, 0.4 - 5e-7) && covers(-1.0, 2.0) ? 0.0 : 1.0;
  out.figure += covers(-0.1305, 0.4) || covers(-0.131, 0.3999) || covers(-0.05, 0.4) || covers(-0.131, 0.2) ? 1.0 : 0.0;
  auto scanner = make_scanner(drive.lidar, 1);
  if (!scanner) return {1e9, 0.0};
  out.figure += stress::not_refused([&] { (*scanner)->scan(-1, kScanAt, drive.motion, scene::SceneAt(*drive.scene)); });
  return out;
}

}  // namespace

std::vector<StressCase> scan_drive_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "scans that the motion does not cover", "a time before that is added, an end left out",
           "refused before the first scan, to a microsecond", "wrong"});
  rows.add("beams/not_covered", not_covered);
  return rows.take();
}

}  // namespace canyon::lidar
