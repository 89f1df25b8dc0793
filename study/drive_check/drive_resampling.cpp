#include "canyon/study/drive_check/drive_resampling.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"

namespace canyon::study {

int drive_block(GpsTime t, GpsTime start) {
  return static_cast<int>(std::floor((t - start) / kDriveBlock_s));
}

std::vector<DriveFigures> resampled_figures(const std::vector<DriveEpoch>& epochs, const std::vector<DriveFix>& fixes,
                                            int count, std::uint64_t seed) {
  if (epochs.empty()) return {};
  const GpsTime start = epochs.front().t;
  const int blocks = drive_block(epochs.back().t, start) + 1;
  std::vector<std::vector<const DriveEpoch*>> epochs_of(static_cast<std::size_t>(blocks));
  std::vector<std::vector<const DriveFix*>> fixes_of(static_cast<std::size_t>(blocks));
  for (const DriveEpoch& e : epochs) epochs_of[static_cast<std::size_t>(drive_block(e.t, start))].push_back(&e);
  for (const DriveFix& f : fixes)
    fixes_of[static_cast<std::size_t>(std::clamp(drive_block(f.t, start), 0, blocks - 1))].push_back(&f);

  const RandomStream draws(seed, "study.drive_check.blocks");
  constexpr double kApart_s = 1000.0;
  std::vector<DriveFigures> out;
  for (int k = 0; k < count; ++k) {
    throw_if_cancelled();
    std::vector<DriveEpoch> drawn;
    std::vector<DriveFix> with;
    for (int b = 0; b < blocks; ++b) {
      const double u = draws.uniform(static_cast<std::uint32_t>(b), static_cast<std::uint64_t>(k));
      const auto block = std::min(static_cast<std::size_t>(u * blocks), static_cast<std::size_t>(blocks - 1));
      for (const DriveEpoch* e : epochs_of[block])
        drawn.push_back({start + (kApart_s * b + (e->t - start)), e->signals});
      for (const DriveFix* f : fixes_of[block]) with.push_back(*f);
    }
    out.push_back(drive_figures(drawn, with));
  }
  return out;
}

}  // namespace canyon::study
