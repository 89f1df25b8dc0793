#include "canyon/report/drive_check/drive_page.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/report/html_report.h"
#include "canyon/tests/report/markup.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSummary = R"({"epochs": 2, "reference_instants": 2,
 "simulated": {"fix_h50_m": 4.5, "hidden_error_m": [10, 84], "cn0_auc": null},
 "measured": {"fix_h50_m": 25.5, "hidden_error_m": [31, 122], "cn0_auc": 0.91},
 "distributions": {"fix_horizontal_error_m": {"simulated": {"count": 2, "percentiles": [1.5, 4.5, null]},
                                              "measured": {"count": 2, "percentiles": [15.0, 25.5, 70.0]}}},
 "figures": [{"key": "fix_h50_m", "label": "fix, 50 %"}, {"key": "hidden_error_m", "label": "|error| <hidden>"},
             {"key": "cn0_auc", "label": "AUC"}],
 "measured_interval": {"fix_h50_m": [20, 30], "hidden_error_m": [[25, 40], [90, 150]], "cn0_auc": [0.88, 0.93]},
 "simulated_draws": {"fix_h50_m": [4, 5], "hidden_error_m": [[9, 11], [80, 90]], "cn0_auc": [null, null]},
 "score": {"draws": 20, "signals": 12, "crps_simulation_m": 11.5, "crps_blind_m": 13.5, "crps_elevation_m": 12.5,
           "against_blind_m": [-4, 1], "against_elevation_m": [-3, 2]}})";
constexpr const char* kSignals =
    "side,gps_week,sow,satellite,elevation_deg,azimuth_deg,in_sight,cn0_dbhz,error_m,rate_error_m_s\n"
    "simulated,1900,100.000,G05,40.0,10.0,1,44.0,0.5,\n"
    "simulated,1900,100.200,R07,20.0,90.0,0,30.0,12.5,0.1\n"
    "measured,1900,100.000,G05,40.0,10.0,1,41.0,-0.7,0.2\n"
    "measured,1900,100.200,R07,20.0,90.0,0,31.0,44.0,\n"
    "measured,1900,100.200,R08,25.0,90.0,0,31.0,,\n";

class DrivePage : public ::testing::Test {
 protected:
  void write(const std::string& summary, const std::string& signals) {
    std::ofstream(directory_.file("summary.json")) << summary;
    std::ofstream(directory_.file("signals.csv")) << signals;
  }
  canyon::testing::TemporaryDirectory directory_;
};

TEST_F(DrivePage, ShowsBothSidesWithTheirIntervals) {
  write(kSummary, kSignals);
  const auto page = html_report(directory_.path());
  ASSERT_TRUE(page) << page.error().str();
  const std::string text = canyon::testing::without(*page, "<", ">");
  EXPECT_THAT(text, HasSubstr("4.50\xC2\xA0m off in the median, of the recorded 25.5\xC2\xA0m, over 2\xC2\xA0"
                              "epochs."));
  EXPECT_THAT(
      text,
      HasSubstr("|error| &lt;hidden&gt;10.0 / 84.09.00 to 11.0 / 80.0 to 90.031.0 / 12225.0 to 40.0 / 90.0 to 150"));
  EXPECT_THAT(text, HasSubstr("CRPS 11.5\xC2\xA0m"));
  EXPECT_THAT(text, HasSubstr("R07"));
  for (const char* title : {"C/N0 of satellites in sight, dB-Hz", "Range error of hidden satellites, m",
                            "Range-rate error of hidden satellites, m/s", "Horizontal error of fixes, m"})
    EXPECT_THAT(text, HasSubstr(title));
  EXPECT_THAT(*page, HasSubstr("measured: median 25.5\xC2\xA0m."));
  EXPECT_THAT(*page, Not(HasSubstr("http")));
}

TEST_F(DrivePage, WithoutDrawsThereIsNoScore) {
  write(R"({"epochs": 0, "simulated": {}, "measured": {}, "figures": []})",
        "side,gps_week,sow,satellite,elevation_deg,azimuth_deg,in_sight,cn0_dbhz,error_m,rate_error_m_s\n");
  const auto page = drive_page(directory_.path());
  ASSERT_TRUE(page) << page.error().str();
  EXPECT_THAT(*page, Not(HasSubstr("CRPS")));
  EXPECT_THAT(*page, HasSubstr("Nothing was tracked."));
}

TEST_F(DrivePage, DamageIsOneLine) {
  write("{}", kSignals);
  const auto page = drive_page(directory_.path());
  ASSERT_FALSE(page);
  EXPECT_THAT(page.error().str(), HasSubstr("summary.json"));
}

}  // namespace
}  // namespace canyon::report
