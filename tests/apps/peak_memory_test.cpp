// Memory of whole missions. Takes minutes, so it runs with ./test.sh --nightly only.
#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using PeakMemoryNightly = CommandLineTest;

// 2026-11-22: all rows and clouds of all runs were kept until the end, 0.75 GB for the five.
TEST_F(PeakMemoryNightly, TheBuiltInMissionStaysWithinItsMemory) {
  const auto peak_mb = [&](const std::string& arguments) {
    EXPECT_EQ(canyon("compare --seed 1 --json --force --out results " + arguments), 0) << read("stderr");
    return nlohmann::json::parse(read("stdout"))["timing"]["peak_memory_mb"].get<double>();
  };
  EXPECT_LE(peak_mb("--fidelities low,high --no-2x2"), 450.0);
  EXPECT_LE(peak_mb(""), 600.0);
}

}  // namespace
}  // namespace canyon::apps::testing
