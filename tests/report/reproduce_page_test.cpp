// The page of `canyon reproduce`.
#include "canyon/report/reproduce/reproduce_page.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/tests/report/browser.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string paper_summary(const std::string& missions, const std::string& value, const std::string& draws = "3") {
  return "{\"paper\": \"Durst & Goodin 2012\", \"ephemeris\": \"built-in\", \"start\": \"2010-11-17T13:00:00\", "
         "\"draws\": " +
         draws + ", \"missions\": " + missions +
         ", \"parts\": [{\"name\": \"table_1\", \"title\": \"Table 1: offsets\", \"paper_says\": \"so & so\", "
         "\"made\": "
         "\"thus\", \"difference\": [\"It <differs>.\"], \"x_label\": \"Time, s\", \"rows\": [{\"what\": "
         "\"ionosphere\", "
         "\"unit\": \"m\", \"paper\": 4.73, \"real\": null, \"ours\": [{\"form\": \"as printed\", \"value\": " +
         value +
         ", \"low\": null, \"high\": null, \"n\": 1}, {\"form\": \"as corrected\", \"value\": 5.09, \"low\": 5.0, "
         "\"high\": "
         "5.2, \"n\": 3}], "
         "\"nearest\": \"as corrected\", \"ratio\": 1.076}], \"curves\": [{\"panel\": \"the circle\", \"unit\": \"m\", "
         "\"name\": \"no error\", \"points\": true, \"from_above\": true, \"labels\": [\"first\", \"\", \"<last>\"], "
         "\"x\": [1, 2, 3], \"y\": [1, null, 4]}, {\"panel\": \"height\", \"unit\": \"m\", \"name\": \"true path\", "
         "\"points\": false, \"from_above\": false, \"labels\": [], \"x\": [0, 60], \"y\": [10, 12]}]}]}";
}

/// The numbers that an attribute begins with, of its first occurrence.
std::vector<double> numbers_of(const std::string& page, const std::string& attribute) {
  const std::size_t at = page.find(attribute + "=\"");
  std::vector<double> out;
  if (at == std::string::npos) return out;
  std::istringstream text(page.substr(at + attribute.size() + 2, 100));
  for (double v; text >> v;) out.push_back(v);
  return out;
}

Result<std::string> page_of(const TemporaryDirectory& folder, const std::string& summary) {
  EXPECT_TRUE(write_text_file(folder.file("summary.json"), summary).ok());
  return report::reproduce_page(folder.file("summary.json"));
}

TEST(ReproducePage, ShowsThePapersNumbersBesideOurs) {
  const TemporaryDirectory folder;
  const auto page = page_of(folder, paper_summary("0", "2.61"));
  ASSERT_TRUE(page.ok()) << page.error().str();
  EXPECT_THAT(*page, HasSubstr("<th scope=\"row\">ionosphere, m</th><td>4.73</td>"));
  EXPECT_THAT(*page, HasSubstr("<td class=\"text\">as printed</td><td>2.61</td><td></td><td></td>"));
  EXPECT_THAT(*page, HasSubstr("<td class=\"text\">as corrected</td><td><b>5.09</b></td><td>5.00 to 5.20, n = 3</td>"));
  EXPECT_THAT(*page, HasSubstr("so &amp; so"));
  EXPECT_THAT(*page, HasSubstr("It &lt;differs&gt;."));
  EXPECT_THAT(*page, HasSubstr("id=\"table_1-0\""));
  EXPECT_THAT(*page, HasSubstr("was not driven: canyon reproduce --missions N."));
}

TEST(ReproducePage, OneDrawIsNoDraws) {
  const TemporaryDirectory folder;
  const auto one = page_of(folder, paper_summary("1", "2.61", "1"));
  ASSERT_TRUE(one.ok()) << one.error().str();
  EXPECT_THAT(*one, HasSubstr("over 1\xC2\xA0"
                              "draw with"));
  EXPECT_THAT(*one, HasSubstr("over 1\xC2\xA0seed with"));
  const auto more = page_of(folder, paper_summary("2", "2.61"));
  ASSERT_TRUE(more.ok()) << more.error().str();
  EXPECT_THAT(*more, HasSubstr("over 3\xC2\xA0"
                               "draws with"));
  EXPECT_THAT(*more, HasSubstr("over 2\xC2\xA0seeds with"));
}

// From above a metre is as long upright as across, and beside points stand their words; else x is what the part says.
TEST(ReproducePage, DrawsFromAboveToScale) {
  const TemporaryDirectory folder;
  const auto page = page_of(folder, paper_summary("0", "2.61"));
  ASSERT_TRUE(page.ok()) << page.error().str();
  const std::string circle = page->substr(page->find("id=\"table_1-0\""));
  const auto x = numbers_of(circle, "data-x"), y = numbers_of(circle, "data-y");
  const auto high_px = numbers_of(circle, "data-height");
  ASSERT_TRUE(x.size() == 2 && y.size() == 2 && high_px.size() == 1);
  // The ends of an axis are written with nine decimals.
  EXPECT_NEAR((x[1] - x[0]) / 1000.0, (y[1] - y[0]) / high_px[0], 1e-9);
  EXPECT_TRUE(x[0] < 1.0 && x[1] > 3.0 && y[0] < 1.0 && y[1] > 4.0);
  const std::string height = page->substr(page->find("id=\"table_1-1\""));
  EXPECT_THAT(circle.substr(0, circle.size() - height.size()), HasSubstr("East, m (north is up)"));
  EXPECT_THAT(circle, HasSubstr(">first</span>"));
  EXPECT_THAT(circle, HasSubstr(">&lt;last&gt;</span>"));
  EXPECT_THAT(height, HasSubstr("<p class=\"xlabel\" aria-hidden=\"true\">Time, s</p>"));
  EXPECT_THAT(height, Not(HasSubstr("north is up")));
}

TEST(ReproducePage, SaysWhatItCannotRead) {
  const TemporaryDirectory folder;
  const auto page = page_of(folder, paper_summary("2", "\"much\""));
  ASSERT_FALSE(page.ok());
  EXPECT_THAT(page.error().str(), HasSubstr("summary.json:1: parts[0].rows[0].ours[0].value: "));
}

TEST(ReproducePage, ABrowserOpensItWithoutAnyMessage) {
  CANYON_BROWSER(chromium);
  const TemporaryDirectory folder;
  const auto page = page_of(folder, paper_summary("2", "2.61"));
  ASSERT_TRUE(page.ok()) << page.error().str();
  ASSERT_TRUE(write_text_file(folder.file("report.html"), *page).ok());
  const BrowserVisit visit = visit_page(chromium, folder.file("report.html"));
  EXPECT_EQ(visit.exit_status, 0);
  EXPECT_THAT(visit.console, ::testing::IsEmpty());
  EXPECT_THAT(visit.dom, Not(HasSubstr("was not driven")));
}

}  // namespace
}  // namespace canyon::testing
