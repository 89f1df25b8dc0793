// Results that are damaged, hostile or extreme.
#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/tests/report/results_page.h"

namespace canyon::report {
namespace {

using canyon::testing::after;
using canyon::testing::edit_json;
using canyon::testing::load;
using canyon::testing::replaced;
using canyon::testing::store;
using ::testing::HasSubstr;
using ::testing::Not;

class DamagedResults : public canyon::testing::ResultsPage {};

TEST_F(DamagedResults, EveryFigureMayBeNull) {
  edit_json(file("summary.json"), [](auto& json) {
    for (auto& run : json["runs"]) {
      for (auto& [key, value] : run.items()) {
        if (value.is_number()) value = nullptr;
      }
      run["timing"] = nullptr;
      run["counters"] = nullptr;
      if (!run["failure"].is_null())
        run["failure"] = {{"kind", "stuck"}, {"t_s", nullptr}, {"x_m", nullptr}, {"y_m", nullptr}, {"detail", nullptr}};
    }
    json["scene"] = nullptr;
    json["timing"] = nullptr;
    json["hash"] = nullptr;
  });
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("<td class=\"undefined\"><span aria-label=\"undefined\">"));
  EXPECT_THAT(html, HasSubstr("; run high fails.</h1>"));
  EXPECT_THAT(html, HasSubstr("failed: it got stuck."));
  EXPECT_THAT(html, HasSubstr("The results hold no CPU times of the parts."));
}

TEST_F(DamagedResults, EmptyTablesAndCloudsAreNoMistake) {
  for (const char* name : {"low_nav.csv", "low_gnss.csv", "low_keyframes.csv", "high_satellites.csv"}) {
    const std::string path = file(std::string("epochs/") + name);
    const std::string csv = load(path);
    store(path, csv.substr(0, csv.find('\n') + 1));
  }
  const std::string cloud = load(file("clouds/low_prior.pcd"));
  std::string header = cloud.substr(0, cloud.find("DATA binary\n") + 12);
  const std::string n = after(header, "POINTS ", 20)[0];
  const std::string points = n.substr(0, n.find('\n'));
  header = replaced(replaced(header, "POINTS " + points, "POINTS 0"), "WIDTH " + points, "WIDTH 0");
  store(file("clouds/low_prior.pcd"), header);
  EXPECT_THAT(page(), HasSubstr("Run low: the results hold no prior map cloud with points."));
}

TEST_F(DamagedResults, NamesAreEscaped) {
  const std::string evil = "<script>alert('x')</script>\"&";
  edit_json(file("summary.json"), [&](auto& json) {
    json["mission"]["name"] = evil;
    json["mission"]["waypoints"][3]["name"] = evil;
    json["scene"]["name"] = evil;
    json["runs"][1]["failure"]["detail"] = evil;
    json["runs"][1]["failure"]["kind"] = evil;
    json["runs"][1]["outcome"] = evil;
    json["runs"][1]["counters"][evil] = 3;
    json["runs"][1]["timing"]["parts"][0]["name"] = evil;
    json["runs"][1]["mission_waypoints"][0]["name"] = evil;
    json["hash"] = evil;
  });
  edit_json(file("manifest.json"), [&](auto& json) { json["version"] = evil; });
  edit_json(file("scene.json"), [&](auto& json) { json["buildings"][0]["name"] = evil; });
  std::string csv = load(file("epochs/high_satellites.csv"));
  csv = replaced(csv, "G02", "<b>G02");
  store(file("epochs/high_satellites.csv"), csv);
  const std::string html = page();
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(html, Not(HasSubstr("<b>G02")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&quot;&amp;"));
}

TEST_F(DamagedResults, AFidelityNameIsEscapedToo) {
  edit_json(file("summary.json"), [](auto& json) {
    for (const char* key : {"fidelity", "gnss", "imu"}) json["runs"][1][key] = "a<b>\"c";
  });
  const std::string html = page();
  EXPECT_THAT(html, Not(HasSubstr("a<b>")));
  EXPECT_THAT(html, HasSubstr("a&lt;b&gt;&quot;c"));
}

TEST_F(DamagedResults, MistakesAreToldByFileLineAndKey) {
  const std::string summary = load(file("summary.json"));
  const auto line_of = [&](const std::string& needle) {
    const std::string text = load(file("summary.json"));
    return std::to_string(
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(needle)), '\n'));
  };
  edit_json(file("summary.json"), [](auto& json) { json["runs"][1]["gdop_max"] = "high"; });
  EXPECT_EQ(error(), "summary.json:" + line_of("\"gdop_max\": \"high\"") +
                         ": runs[1].gdop_max: string \"high\", expected a number or null");

  store(file("summary.json"), summary);
  edit_json(file("summary.json"), [](auto& json) { json["runs"][0].erase("outcome"); });
  EXPECT_THAT(error(), ::testing::MatchesRegex("summary.json:[0-9]+: runs\\[0\\].outcome: missing, expected a string"));

  store(file("summary.json"), summary);
  edit_json(file("summary.json"), [](auto& json) { json["runs"][1]["nlos_share"] = 12; });
  EXPECT_THAT(error(), ::testing::MatchesRegex(
                           "summary.json:[0-9]+: runs\\[1\\].nlos_share: number 12, expected a share between 0 and 1"));

  store(file("summary.json"), summary.substr(0, summary.size() / 2));
  EXPECT_THAT(error(), ::testing::MatchesRegex(
                           "summary.json:[0-9]+: the JSON text ends too early, expected a complete JSON value"));

  store(file("summary.json"), "{\n\"schema\": 1,\n \"mission\": oops }");
  EXPECT_THAT(error(), HasSubstr("summary.json:3: not JSON near"));

  store(file("summary.json"), summary);
  edit_json(file("summary.json"), [](auto& json) { json["schema"] = 2; });
  EXPECT_EQ(error(), "summary.json:2: schema: number 2, expected 1");

  std::filesystem::remove(file("summary.json"));
  EXPECT_THAT(error(), HasSubstr("summary.json"));
}

TEST_F(DamagedResults, MistakesInEpochsAreToldByLineAndColumn) {
  const std::string path = file("epochs/high_nav.csv");
  const std::string csv = load(path);
  const std::size_t second_row = csv.find('\n', csv.find('\n') + 1) + 1;
  store(path, csv.substr(0, second_row) + "abc" + csv.substr(csv.find(',', second_row)));
  EXPECT_EQ(error(), "epochs/high_nav.csv:3: t_s: 'abc', expected a finite number or an empty field");
  store(path, csv.substr(0, second_row) + "1,2,3\n");
  EXPECT_EQ(error(), "epochs/high_nav.csv:3: 3 fields, expected 31 as in the first line");
  store(path, replaced(csv, "sigma_n_m", "sigma_x_m"));
  EXPECT_EQ(error(), "epochs/high_nav.csv:1: sigma_n_m: column missing, expected a column of that name");
}

TEST_F(DamagedResults, MistakesInCloudsAndSceneAreTold) {
  const std::string path = file("clouds/high_registered.pcd");
  const std::string cloud = load(path);
  store(path, cloud.substr(0, cloud.size() - 30));
  EXPECT_THAT(
      error(),
      ::testing::MatchesRegex(
          "clouds/high_registered.pcd: POINTS: the file holds [0-9]+ points, expected [0-9]+ as its header says"));
  store(path, cloud);
  edit_json(file("scene.json"), [](auto& json) { json["buildings"][2]["footprint"][1] = "corner"; });
  EXPECT_THAT(
      error(),
      ::testing::MatchesRegex(
          "scene.json:[0-9]+: buildings\\[2\\].footprint\\[1\\]: string \"corner\", expected a list of 2 numbers"));
}

// 2026-11-22: a number beyond the range of numbers, or one whose square is, ended the program by a failed check.
TEST_F(DamagedResults, NumbersBeyondAllMeasureAreTold) {
  const std::string summary = load(file("summary.json"));
  for (const char* huge : {"1e308", "-1.7976931348623157e308", "99999999999999999999"}) {
    edit_json(file("summary.json"), [](auto& json) { json["runs"][1]["failure"]["x_m"] = 12345678; });
    store(file("summary.json"), replaced(load(file("summary.json")), "12345678", huge));
    EXPECT_THAT(error(), ::testing::MatchesRegex("summary.json:[0-9]+: runs\\[1\\].failure.x_m: number .*, expected a "
                                                 "number of at most 1e15 in size"))
        << huge;
    store(file("summary.json"), summary);
  }
  // JSON itself has no bound.
  edit_json(file("summary.json"), [](auto& json) { json["mission"]["route"][1][0] = 12345678; });
  store(file("summary.json"), replaced(load(file("summary.json")), "12345678", "1e999"));
  EXPECT_THAT(error(),
              ::testing::MatchesRegex("summary.json:[0-9]+: number 1e999, expected one that a double can hold"));
  store(file("summary.json"), summary);

  const std::string scene = load(file("scene.json"));
  edit_json(file("scene.json"), [](auto& json) { json["buildings"][2]["footprint"][1][0] = 12345678; });
  store(file("scene.json"), replaced(load(file("scene.json")), "12345678", "1e308"));
  EXPECT_THAT(error(), ::testing::MatchesRegex("scene.json:[0-9]+: buildings\\[2\\].footprint\\[1\\]: number .*, "
                                               "expected a number of at most 1e15 in size"));
  store(file("scene.json"), scene);

  const std::string path = file("epochs/high_gnss.csv");
  const std::string csv = load(path);
  const std::size_t second_row = csv.find('\n', csv.find('\n') + 1) + 1;
  store(path, csv.substr(0, second_row) + "1e308" + csv.substr(csv.find(',', second_row)));
  EXPECT_EQ(error(), "epochs/high_gnss.csv:3: t_s: '1e308', expected a number of at most 1e15 in size");
}

// 2026-11-22: a logarithmic axis that began at the smallest of all numbers ended the program by a failed check.
TEST_F(DamagedResults, NumbersTooSmallToBeAreNothing) {
  const std::string path = file("epochs/high_gnss.csv");
  std::string csv = load(path);
  const std::size_t nis_at = [&] {
    const std::string head = csv.substr(0, csv.find('\n'));
    return static_cast<std::size_t>(
               std::count(head.begin(), head.begin() + static_cast<std::ptrdiff_t>(head.find(",nis")), ',')) +
           1;
  }();
  std::size_t at = csv.find('\n') + 1;
  for (std::size_t k = 0; k < nis_at; ++k) at = csv.find(',', at) + 1;
  csv.replace(at, csv.find_first_of(",\n", at) - at, "4.9e-324");
  store(path, csv);
  EXPECT_THAT(page(), HasSubstr("</html>"));
}

}  // namespace
}  // namespace canyon::report
