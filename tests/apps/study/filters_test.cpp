// compare --filters through the binary: GNSS by IMU by filter, in summary.json, on the page and in the terminal.
#include <string>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

constexpr const char* kFiltersCompared[] = {"naive", "vehicle"};
constexpr const char* kSensorsCompared[] = {"low", "high"};

class CompareFiltersTest : public CommandLineTest {
 protected:
  /// summary.json of such a comparison; null if it was refused.
  Json compared(const std::string& more) const {
    const std::string arguments = "compare mission.toml --fidelities low,high --out out --force " + more;
    EXPECT_EQ(canyon(arguments), 0) << arguments << ": " << read("stderr");
    return Json::parse(read("out/summary.json"), nullptr, false);
  }
};

/// Name of the run with this filter and these sensors; each seed has one.
std::string run_of_cell(const Json& summary, const std::string& filter, const std::string& gnss,
                        const std::string& imu) {
  for (const Json& run : summary.at("runs"))
    if (run.at("filter") == filter && run.at("gnss") == gnss && run.at("imu") == imu) return run.at("fidelity");
  return "none";
}

/// Element of the list whose "fidelity" it is.
Json element_named(const Json& list, const std::string& fidelity) {
  for (const Json& element : list)
    if (element.at("fidelity") == fidelity) return element;
  return nullptr;
}

TEST_F(CompareFiltersTest, EachFilterHasATwoByTwoOfItsOwnRuns) {
  Json summary = compared("--open-loop --filters naive,vehicle --set time.limit_s=2");
  ASSERT_EQ(summary["runs"].size(), 8U);
  Json& squares = summary["two_by_two_by_filter"];
  ASSERT_EQ(squares.size(), 2U);
  for (const char* filter : kFiltersCompared) {
    Json& square = squares[filter];
    EXPECT_EQ(square["gnss"], (Json{"low", "high"})) << filter;
    EXPECT_EQ(square["imu"], (Json{"low", "high"})) << filter;
    for (const char* key : {"outcome", "position_error_rms_m", "registration_error_rms_m", "map_error_prior_rms_m"})
      for (std::size_t g = 0; g < 2; ++g)
        for (std::size_t i = 0; i < 2; ++i) {
          const std::string run = run_of_cell(summary, filter, kSensorsCompared[g], kSensorsCompared[i]);
          EXPECT_EQ(square[key][g][i], element_named(summary["runs"], run)[key]) << key << " of " << run;
        }
    EXPECT_TRUE(square["position_error_rms_m"][1][1].is_number());
    EXPECT_NE(square["position_error_rms_m"][0][0], square["position_error_rms_m"][1][1]);
  }
  EXPECT_NE(squares["naive"]["position_error_rms_m"], squares["vehicle"]["position_error_rms_m"]);
  EXPECT_EQ(summary["two_by_two"], squares["naive"]) << "that of the filter named first";
  EXPECT_EQ(run_of_cell(summary, "vehicle", "high", "low"), "high_gnss_low_imu_vehicle");

  const std::string page = read("out/report.html");
  EXPECT_THAT(page, HasSubstr("GNSS, IMU or filter?"));
  EXPECT_THAT(page, HasSubstr("All runs are on one true motion."));
  for (const std::string filter : kFiltersCompared) {
    EXPECT_THAT(page, HasSubstr("<h3>Filter " + filter + "</h3>"));
    EXPECT_THAT(read("stdout"), HasSubstr("2 x 2, filter " + filter + ", open loop: position error RMS"));
  }
}

TEST_F(CompareFiltersTest, OverSeedsItsCellsAreMediansAndCounts) {
  Json summary = compared("--seeds 2 --filters naive,vehicle --set time.limit_s=1");
  ASSERT_EQ(summary["runs"].size(), 16U);
  ASSERT_EQ(summary["two_by_two_by_filter"].size(), 2U);
  for (const char* filter : kFiltersCompared) {
    Json& square = summary["two_by_two_by_filter"][filter];
    EXPECT_FALSE(square.contains("outcome")) << filter;
    EXPECT_EQ(square["successes"], (Json{{0, 0}, {0, 0}})) << filter;
    EXPECT_EQ(square["ended"], (Json{{0, 0}, {0, 0}})) << filter << ": all are stopped";
    for (std::size_t g = 0; g < 2; ++g)
      for (std::size_t i = 0; i < 2; ++i) {
        const std::string run = run_of_cell(summary, filter, kSensorsCompared[g], kSensorsCompared[i]);
        const Json of_run = element_named(summary["over_seeds"], run);
        ASSERT_TRUE(of_run.is_object()) << run;
        EXPECT_EQ(square["position_error_rms_m"][g][i], of_run.at("figures").at("position_error_rms_m").at("median"))
            << run;
      }
  }
}

TEST_F(CompareFiltersTest, WithoutMixedRunsThereIsNone) {
  Json each = compared("--filters naive,vehicle --set time.limit_s=1");
  EXPECT_EQ(each["runs"].size(), 4U);
  EXPECT_FALSE(each.contains("two_by_two_by_filter")) << "one closed loop of each";
  EXPECT_TRUE(each["two_by_two"].is_null());
  EXPECT_THAT(read("out/report.html"), Not(HasSubstr("<h3>Filter ")));
  Json pure = compared("--open-loop --no-2x2 --filters naive,vehicle --set time.limit_s=1");
  EXPECT_EQ(pure["runs"].size(), 4U);
  EXPECT_FALSE(pure.contains("two_by_two_by_filter"));
}

TEST_F(CompareFiltersTest, AnUnknownFilterIsNamed) {
  expect_mistake("compare mission.toml --filters naive,vehicel --out out",
                 "--filters: unknown name \"vehicel\", expected one of \"naive\", \"vehicle\", \"tight\"; nearest is "
                 "\"vehicle\"\n");
}

}  // namespace
}  // namespace canyon::apps::testing
