// A program whose autonomies fail (tests/support/faulty_autonomies.cpp): that is a result, so its exit status is 0, and
// all that there is of the run is written.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/wait.h>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// Beside a sound run two whose autonomy throws, or does not return, at its 151st command.
constexpr const char* kFaultyFidelities = R"(
[fidelity.throws]
base = "low"
[fidelity.throws.autonomy]
model = "route_follower"
[fidelity.hangs]
base = "low"
[fidelity.hangs.autonomy]
model = "reference_2012"
call_limit_s = 0.5
[fidelity.throws_when_made]
base = "throws"
[fidelity.throws_when_made.autonomy]
hold_s = 7
[fidelity.hangs_when_made]
base = "hangs"
[fidelity.hangs_when_made.autonomy]
hold_s = 7
)";

class FaultyProgramTest : public CommandLineTest {
 protected:
  void SetUp() override {
    CommandLineTest::SetUp();
    write("mission.toml", std::string(kMission) + kFaultyFidelities);
  }
  /// As canyon(), of the program with the faulty autonomies.
  int faulty_canyon(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && '" CANYON_WITH_FAULTY_AUTONOMIES "' " + arguments +
                                " > '" + path("stdout") + "' 2> '" + path("stderr") + "'";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void expect_fault(const Json& run, const std::string& detail) const {
    EXPECT_EQ(run.at("outcome"), "autonomy_fault");
    EXPECT_EQ(run.at("failure").at("kind"), "autonomy_fault");
    EXPECT_EQ(run.at("failure").at("detail"), detail);
    // The step in which the 151st command, of 100 a second, was due.
    EXPECT_NEAR(run.at("failure").at("t_s").get<double>(), 1.51, 0.011) << detail;
    const std::string name = run.at("fidelity"), nav = read("out/epochs/" + name + "_nav.csv");
    EXPECT_EQ(std::count(nav.begin(), nav.end(), '\n'), 1 + 15) << "a line of names, and ten rows a second";
    for (const std::string& file : {"epochs/" + name + "_gnss.csv", "epochs/" + name + "_keyframes.csv",
                                    "clouds/" + name + "_prior.pcd", "tapes/" + name + ".tape"})
      EXPECT_FALSE(read("out/" + file).empty()) << file;
  }
};

TEST_F(FaultyProgramTest, ARunWhoseAutonomyThrowsIsAResult) {
  ASSERT_EQ(faulty_canyon("run mission.toml --fidelity throws --out out"), 0) << read("stderr");
  EXPECT_EQ(read("stderr"), "");
  const Json summary = Json::parse(read("out/summary.json"));
  ASSERT_EQ(summary.at("runs").size(), 1U);
  expect_fault(summary.at("runs").front(), "it threw: no <idea>");
  EXPECT_EQ(summary.at("hash").get<std::string>().size(), 64U);
  for (const char* file : {"manifest.json", "scene.json", ".canyon"})
    EXPECT_FALSE(read(std::string("out/") + file).empty()) << file;
  EXPECT_THAT(read("stdout"), HasSubstr("m: it was ended by a fault of its autonomy's own (it threw: no <idea>)\n"));
  EXPECT_THAT(read("out/report.html"),
              HasSubstr(" failed: it was ended by a fault of its autonomy&#39;s own after 1.5"));
  EXPECT_THAT(read("out/report.html"), HasSubstr("It threw: no &lt;idea&gt;."));
}

// What never returns is left behind, and must hold up neither its neighbours nor the end of the program.
TEST_F(FaultyProgramTest, OfAComparisonTheOthersGoOn) {
  ASSERT_EQ(faulty_canyon("compare mission.toml --fidelities low,throws,hangs --out out --json"), 0) << read("stderr");
  Json runs = Json::parse(read("stdout"))["runs"];
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0]["outcome"], "stopped");
  EXPECT_EQ(runs[0]["duration_s"], 4.0);
  expect_fault(runs[1], "it threw: no <idea>");
  expect_fault(runs[2], "a call took longer than autonomy.call_limit_s = 0.5 s");
  EXPECT_FALSE(read("out/report.html").empty());
}

// 2026-11-30: an autonomy that threw while it was made ended the whole comparison, one that did not return held it up.
TEST_F(FaultyProgramTest, OneThatFailsWhileItIsMadeHasDrivenNowhere) {
  ASSERT_EQ(faulty_canyon("compare mission.toml --fidelities low,throws_when_made,hangs_when_made --out out --json"), 0)
      << read("stderr");
  Json runs = Json::parse(read("stdout"))["runs"];
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0]["outcome"], "stopped");
  const char* const details[] = {"it threw: no <idea>", "a call took longer than autonomy.call_limit_s = 0.5 s"};
  for (int i : {0, 1}) {
    const Json& run = runs[static_cast<std::size_t>(1 + i)];
    EXPECT_EQ(run.at("outcome"), "autonomy_fault") << i;
    EXPECT_EQ(run.at("failure").at("detail"), details[i]);
    EXPECT_LE(run.at("failure").at("t_s").get<double>(), 0.01) << i;
    EXPECT_LE(run.at("distance_m").get<double>(), 1e-3) << i;
  }
  EXPECT_FALSE(read("out/report.html").empty());
}

TEST_F(FaultyProgramTest, ItCountsAmongTheSeedsAsAnEndOfItsOwn) {
  ASSERT_EQ(faulty_canyon("compare mission.toml --fidelities low,throws --no-2x2 --seeds 2 --out out"), 0)
      << read("stderr");
  const Json shares = Json::parse(read("out/summary.json")).at("shares");
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_EQ(shares[0].at("outcomes"), Json::object({{"stopped", 2}}));
  EXPECT_EQ(shares[1].at("outcomes"), Json::object({{"autonomy_fault", 2}}));
  EXPECT_EQ(shares[1].at("n"), 2) << "it ended by itself";
  EXPECT_EQ(shares[1].at("success"), 0);
}

}  // namespace
}  // namespace canyon::apps::testing
