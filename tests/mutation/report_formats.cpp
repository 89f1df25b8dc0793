#include <filesystem>

#include "canyon/core/check.h"
#include "canyon/tests/mutation/format.h"
#include "canyon/tests/report/synthetic_results.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::testing {
namespace {

/// A results directory of two short runs, whose every file the report reads.
const std::vector<Seed>& results() {
  static const std::vector<Seed> files = [] {
    const TemporaryDirectory scratch;
    write_synthetic_results(scratch.path(), {.speed_m_s = 40.0,
                                             .gnss_rate_hz = 0.5,
                                             .paper = false,
                                             .mixed = false,
                                             .clouds = true,
                                             .cloud_points_per_keyframe = 1});
    std::vector<Seed> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch.path())) {
      if (!entry.is_regular_file()) continue;
      const std::string name = std::filesystem::relative(entry.path(), scratch.path()).string();
      out.push_back({"results/" + name, load(entry.path().string())});
    }
    return out;
  }();
  return files;
}

Format of_results(const std::string& name, const std::vector<std::string>& damaged) {
  return {.name = name,
          .command = {"report", "results"},
          .read = {},
          .seeds =
              [damaged] {
                std::vector<Seed> out;
                for (const std::string& file : damaged)
                  for (const Seed& seed : results())
                    if (seed.name == "results/" + file) out.push_back(seed);
                CANYON_CHECK(out.size() == damaged.size(), "file = ", damaged.front());
                return out;
              },
          .beside = results};
}

}  // namespace

std::vector<Format> report_formats() {
  return {of_results("SummaryJson", {"summary.json"}),
          of_results("SceneJson", {"scene.json"}),
          of_results("ManifestJson", {"manifest.json"}),
          of_results("EpochsNav", {"epochs/high_nav.csv"}),
          of_results("EpochsGnss", {"epochs/high_gnss.csv"}),
          of_results("EpochsSatellites", {"epochs/high_satellites.csv"}),
          of_results("EpochsKeyframes", {"epochs/high_keyframes.csv"}),
          of_results("MapClouds", {"clouds/high_prior.pcd", "clouds/high_registered.pcd"})};
}

}  // namespace canyon::testing
