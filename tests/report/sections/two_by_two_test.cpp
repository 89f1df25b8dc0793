// GNSS by IMU on the page, a table for each filter.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/tests/report/results_page.h"

namespace canyon::report {
namespace {

using canyon::testing::after;
using canyon::testing::edit_json;
using canyon::testing::section;
using ::testing::HasSubstr;
using ::testing::Not;

class TwoByTwoPage : public canyon::testing::ResultsPage {};

/// Of low and high, with these position errors.
nlohmann::ordered_json square_of(double base_m, double imu_m, double gnss_m, double both_m) {
  const auto list = [](const auto& a, const auto& b) { return nlohmann::ordered_json::array({a, b}); };
  return {{"gnss", list("low", "high")},
          {"imu", list("low", "high")},
          {"outcome", list(list("success", "stuck"), list("stopped", nullptr))},
          {"position_error_rms_m", list(list(base_m, imu_m), list(gnss_m, both_m))}};
}

TEST_F(TwoByTwoPage, EachFilterHasATableAndASentenceOfItsOwn) {
  edit_json(file("summary.json"), [](auto& summary) {
    summary["two_by_two"] = square_of(77.0, 77.0, 77.0, 77.0);
    summary["two_by_two_by_filter"] = {{"naive", square_of(0.125, 0.25, 3.0, 4.0)},
                                       {"vehicle", square_of(0.5, 0.625, 1.5, 1.25)}};
  });
  const std::string html = section(page(), "two-by-two");
  EXPECT_THAT(html, HasSubstr("GNSS, IMU or filter?"));
  EXPECT_THAT(html, HasSubstr("With filter naive: Changing the GNSS alone from low to high takes the position error "
                              "from 0.125\xC2\xA0m to 3.00\xC2\xA0m, changing the IMU alone to 0.250\xC2\xA0m, "
                              "both to 4.00\xC2\xA0m."));
  EXPECT_THAT(html, HasSubstr("With filter vehicle: Changing the GNSS alone from low to high takes the position error "
                              "from 0.500\xC2\xA0m to 1.50\xC2\xA0m, changing the IMU alone to 0.625\xC2\xA0m, "
                              "both to 1.25\xC2\xA0m."));
  EXPECT_THAT(html, HasSubstr("these are separate drives"));
  EXPECT_THAT(html, Not(HasSubstr("77.0\xC2\xA0m"))) << "theirs alone";

  const std::size_t naive = html.find("<h3>Filter naive</h3>"), vehicle = html.find("<h3>Filter vehicle</h3>");
  ASSERT_NE(vehicle, std::string::npos);
  ASSERT_LT(naive, vehicle);
  // Rows are GNSS, columns IMU, cells in the order of the text.
  EXPECT_THAT(after(html.substr(naive, vehicle - naive), "<dt>position error, RMS</dt><dd>", 5),
              ::testing::ElementsAre("0.125", "0.250", "3.00\xC2", "4.00\xC2"));
  EXPECT_THAT(after(html.substr(vehicle), "<dt>position error, RMS</dt><dd>", 5),
              ::testing::ElementsAre("0.500", "0.625", "1.50\xC2", "1.25\xC2"));
  EXPECT_THAT(html, HasSubstr("aria-label=\"GNSS by IMU with filter vehicle\""));
  for (const char* outcome : {"outcome good\">\xE2\x9C\x93 success", "outcome bad\">\xE2\x9C\x95 stuck",
                              "outcome neither\">\xE2\x97\x8B stopped", "undefined\">no outcome"})
    EXPECT_THAT(html.substr(vehicle), HasSubstr(std::string("<p class=\"") + outcome + "</p>"));
}

TEST_F(TwoByTwoPage, ACellIsOfTheRunWithItsFilter) {
  edit_json(file("summary.json"), [](auto& summary) {
    summary["runs"][1]["filter"] = "vehicle";
    summary["two_by_two_by_filter"] = {{"naive", square_of(0.125, 0.25, 3.0, 4.0)},
                                       {"vehicle", square_of(0.5, 0.625, 1.5, 1.25)}};
  });
  const std::string html = section(page(), "two-by-two"), tag = "<td><p><span class=\"tag keep r";
  const std::size_t vehicle = html.find("<h3>Filter vehicle</h3>");
  ASSERT_NE(vehicle, std::string::npos);
  EXPECT_THAT(html.substr(0, vehicle), Not(HasSubstr(tag))) << "no run has filter naive";
  EXPECT_THAT(after(html.substr(vehicle), tag, 1), ::testing::ElementsAre("1"));
}

TEST_F(TwoByTwoPage, OfASingleFilterNothingIsAskedAboutFilters) {
  edit_json(file("summary.json"), [](auto& summary) {
    summary["two_by_two_by_filter"] = {{"naive", square_of(0.125, 0.25, 3.0, 4.0)}};
  });
  const std::string html = section(page(), "two-by-two");
  EXPECT_THAT(html, HasSubstr("GNSS or IMU?"));
  EXPECT_THAT(html, Not(HasSubstr("<h3>Filter")));
  EXPECT_THAT(html, HasSubstr("these are four drives"));
}

TEST_F(TwoByTwoPage, WhatIsWrongWithATableOfAFilterIsSaid) {
  const auto error_with = [&](const nlohmann::ordered_json& square) {
    edit_json(file("summary.json"), [&](auto& summary) {
      summary["two_by_two_by_filter"] = {{"naive", square_of(0.125, 0.25, 3.0, 4.0)}, {"vehicle", square}};
    });
    return error();
  };
  const std::string place = "summary.json:[0-9]+: two_by_two_by_filter.vehicle";
  EXPECT_THAT(error_with(3), ::testing::MatchesRegex(place + ": number 3, expected an object"));
  nlohmann::ordered_json square = square_of(0.5, 0.625, 1.5, 1.25);
  square["position_error_rms_m"].erase(1);
  EXPECT_THAT(error_with(square),
              ::testing::MatchesRegex(place + ".position_error_rms_m: a list of 1, expected 2 rows"));
  square.erase("gnss");
  EXPECT_THAT(error_with(square), ::testing::MatchesRegex(place + ".gnss: missing, expected a list"));
}

// A value that is no object ended the program by a signal.
TEST_F(TwoByTwoPage, TablesOfFiltersThatAreNoObjectAreAMistake) {
  edit_json(file("summary.json"), [](auto& summary) { summary["two_by_two_by_filter"] = 3; });
  EXPECT_THAT(error(),
              ::testing::MatchesRegex("summary.json:[0-9]+: two_by_two_by_filter: number 3, expected an object"));
}

}  // namespace
}  // namespace canyon::report
