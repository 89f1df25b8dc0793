// Memory of a run does not grow with its length. Takes minutes, so it runs with ./test.sh --nightly only.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "canyon/mission/motion/vehicle.h"
#include "canyon/mission/recorder/run_files.h"
#include "canyon/mission/run.h"
#include "canyon/study/results/run_statistics.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  long pages = 0, resident = 0;
  statm >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

double folder_mb(const std::filesystem::path& folder) {
  double bytes = 0.0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return bytes / 1048576.0;
}

/// Resident memory and what is written, at every simulated ten minutes; and whether each step of the vehicle has come
/// when it is due.
class MemoryLog final : public mission::Recorder {
 public:
  explicit MemoryLog(std::filesystem::path folder) : folder_(std::move(folder)) {}
  Status node(const TapeNode& node) override {
    if (nodes_ == 0) first_node_ = node.motion.t;
    off_time += node.motion.t.ns - first_node_.ns != nodes_ * mission::Vehicle::kStep_ns ? 1 : 0;
    ++nodes_;
    return Ok{};
  }
  Status epoch(const mission::NavRow& row) override {
    if (first_.ns == 0) first_ = row.t;
    if (row.t - first_ < 600.0 * static_cast<double>(mb.size())) return Ok{};
    mb.push_back(resident_mb());
    written_mb.push_back(folder_mb(folder_));
    if (mb.size() % 6 == 1)
      std::printf("  %2zu h: %.2f MB, written %.2f MB\n", mb.size() / 6, mb.back(), written_mb.back());
    return Ok{};
  }
  std::vector<double> mb, written_mb;
  int off_time = 0;

 private:
  std::filesystem::path folder_;
  std::int64_t nodes_ = 0;
  GpsTime first_, first_node_;
};

/// MB per hour, by least squares.
double slope_mb_h(std::span<const double> mb) {
  const double n = static_cast<double>(mb.size()), middle = 0.5 * (n - 1.0);
  double along = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < mb.size(); ++i) {
    const double x = static_cast<double>(i) - middle;
    along += x * mb[i];
    squares += x * x;
  }
  return 6.0 * along / squares;
}

/// A day along one street, ten minutes' halt after every half metre, with the LIDAR blinded: what a mission may grow
/// with is then its map alone, and there is none.
std::string slow_mission(double hours) {
  std::string toml = R"(
base = "vicksburg"
[vehicle]
start_m = [213.9, 30.0]
start_heading_deg = 0.0
[lidar]
blinded = true
[registration]
method = "none"
[success]
facade_share = 0.0
[run]
record_filter_input = true
truth_as_pose = true
[autonomy]
model = "route_follower"
hold_s = 600.0
)";
  toml += "[time]\nlimit_s = " + std::to_string(3600.0 * hours) + "\n";
  for (int k = 0; k <= 6.0 * hours; ++k)
    toml += "[[autonomy.waypoint]]\nname = \"halt " + std::to_string(k) + "\"\np_m = [213.9, " +
            std::to_string(60.0 + 0.5 * k) + "]\nobserve = \"building 273\"\n";
  return toml;
}

// 2026-11-22: all rows were kept, some 40 MB an hour. CANYON_MEMORY_HOURS in the environment takes another length.
TEST(MemoryNightly, ADayIsDrivenInBoundedMemory) {
  const char* given = std::getenv("CANYON_MEMORY_HOURS");
  const double hours = given != nullptr ? std::atof(given) : 24.0;
  const auto file = mission::MissionFile::parse(slow_mission(hours), "slow.toml");
  for (const char* fidelity : {"low", "high"}) {
    const auto config = file->resolve(fidelity);
    ASSERT_TRUE(config.ok()) << config.error().str();
    mission::SceneCache scenes;
    const auto prepared = mission::prepare(*config, scenes);
    ASSERT_TRUE(prepared.ok()) << prepared.error().str();
    const canyon::testing::TemporaryFolder folder;
    const auto files = mission::RunFiles::create(folder.path().string(), fidelity, *config, *prepared, nullptr);
    ASSERT_TRUE(files.ok()) << files.error().str();
    RunStatistics statistics(prepared->scene->frame(), folder.path().string());
    MemoryLog log(folder.path());
    mission::Recorders all({files->get(), &statistics, &log});
    const auto record =
        mission::run_mission(*config, *prepared, nullptr, {.tape = nullptr, .recorder = &all, .autonomy = nullptr});
    ASSERT_TRUE(record.ok()) << record.error().str();
    EXPECT_GT(record->simulated_s, 3600.0 * hours - 1.0) << (record->failure ? record->failure->detail : "");
    ASSERT_GE(log.mb.size(), 6.0 * hours) << "one reading in ten minutes";
    const double slope = slope_mb_h(std::span(log.mb).subspan(log.mb.size() / 2));
    std::printf("  %s: %.3f MB an hour over the last half\n", fidelity, slope);
    EXPECT_LE(slope, 1.0) << fidelity;
    EXPECT_EQ(log.off_time, 0) << "steps of the vehicle at other times than k * 10 ms, " << fidelity;
    // A row is as long as its numbers: times, places and counts gain a digit or two in a day, of some twenty a column.
    const std::span<const double> written(log.written_mb);
    const std::size_t half = written.size() / 2, quarter = written.size() / 4;
    const double early = slope_mb_h(written.subspan(quarter, half - quarter)), late = slope_mb_h(written.subspan(half));
    std::printf("  %s: files grow by %.2f MB an hour, then by %.2f\n", fidelity, early, late);
    EXPECT_LE(late, 1.1 * early) << fidelity;
  }
}

}  // namespace
}  // namespace canyon::study
