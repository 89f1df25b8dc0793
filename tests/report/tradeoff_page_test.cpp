// The page of `canyon tradeoff`: what stands in it of missions as a whole.
#include "canyon/report/tradeoff/tradeoff_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/tests/report/browser.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string run(const std::string& name, const std::string& position, const std::string& map, double cpu_s,
                const std::string& closed_loop) {
  return "{\"fidelity\": \"" + name + "\", \"planned\": false, \"position_error_rms_m\": " + position +
         ", \"map_error_rms_m\": " + map +
         ", \"registration_error_rms_m\": null, \"tape_s\": 280.0, \"cpu_s\": " + std::to_string(cpu_s) +
         ", \"cpu_low_s\": " + std::to_string(0.9 * cpu_s) + ", \"cpu_high_s\": " + std::to_string(1.1 * cpu_s) +
         ", \"simulated_s\": 60.0, \"work\": 1, \"closed_loop\": " + closed_loop + "}";
}

std::string summary(const std::string& runs) {
  return "{\"mission\": \"m\", \"fidelity\": \"high\", \"seed\": 1, \"tape\": \"its route\", \"samples\": 20, "
         "\"repetitions\": 5, \"threads\": 1, \"ladders\": [], \"skipped\": [], \"chosen\": null, \"fidelities\": [" +
         runs + "]}";
}

const std::string kDriven =
    R"({"success": 2, "n": 3, "low": 0.208, "high": 0.938, "outcomes": {"success": 2, "collision": 1}, )"
    R"("mission_cpu_s": 21.0, "mission_cpu_low_s": 20.0, "mission_cpu_high_s": 22.0})";

std::string tradeoff_page_of(const TemporaryDirectory& folder, const std::string& runs) {
  EXPECT_TRUE(write_text_file(folder.file("summary.json"), summary(runs)).ok());
  auto page = report::tradeoff_page(folder.file("summary.json"));
  EXPECT_TRUE(page.ok()) << page.error().str();
  return page.ok() ? *page : "";
}

TEST(TradeoffPage, DrawsErrorsAndOutcomesOfMissionsOverTheirTime) {
  const TemporaryDirectory folder;
  const std::string page = tradeoff_page_of(folder, run("low", "0.16", "0.05", 0.099, kDriven) + "," +
                                                        run("high", "0.45", "0.15", 0.105, kDriven) + "," +
                                                        run("high_planned", "0.45", "null", 0.04, kDriven));
  EXPECT_THAT(page, HasSubstr("id=\"runs-errors\""));
  EXPECT_THAT(page, HasSubstr("Position error, RMS"));
  EXPECT_THAT(page, HasSubstr("Map error, RMS"));
  EXPECT_THAT(page, Not(HasSubstr("Registration error, RMS"))) << "none has one";
  EXPECT_THAT(page, HasSubstr("high_planned: no such error")) << "of its map";
  EXPECT_THAT(page, HasSubstr("id=\"runs-outcomes\""));
  EXPECT_THAT(page, HasSubstr("2 of 3"));
  EXPECT_THAT(page, HasSubstr("collision 1"));
}

TEST(TradeoffPage, MissionsThatWereNotDrivenHaveNoOutcomes) {
  const TemporaryDirectory folder;
  const std::string page = tradeoff_page_of(folder, run("high", "0.45", "0.15", 0.105, "null"));
  EXPECT_THAT(page, HasSubstr("id=\"runs-errors\""));
  EXPECT_THAT(page, Not(HasSubstr("id=\"runs-outcomes\"")));
}

TEST(TradeoffPage, ABrowserOpensItWithoutAnyMessage) {
  CANYON_BROWSER(chromium);
  const TemporaryDirectory folder;
  const std::string page = tradeoff_page_of(
      folder, run("low", "0.16", "0.05", 0.099, kDriven) + "," + run("high", "0.45", "0.15", 0.105, kDriven));
  ASSERT_TRUE(write_text_file(folder.file("report.html"), page).ok());
  const BrowserVisit visit = visit_page(chromium, folder.file("report.html"));
  EXPECT_EQ(visit.exit_status, 0);
  EXPECT_THAT(visit.console, ::testing::IsEmpty());
  EXPECT_THAT(visit.dom, Not(HasSubstr("data-readouts=\"0\"")));
}

}  // namespace
}  // namespace canyon::testing
