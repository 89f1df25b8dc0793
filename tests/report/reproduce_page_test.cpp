// The page of `canyon reproduce`.
#include "canyon/report/reproduce/reproduce_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/tests/report/browser.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string paper_summary(const std::string& missions, const std::string& value) {
  return "{\"paper\": \"Durst & Goodin 2012\", \"ephemeris\": \"built-in\", \"start\": \"2010-11-17T13:00:00\", "
         "\"draws\": 3, \"missions\": " +
         missions +
         ", \"parts\": [{\"name\": \"table_1\", \"title\": \"Table 1: offsets\", \"paper_says\": \"so & so\", "
         "\"made\": "
         "\"thus\", \"difference\": [\"It <differs>.\"], \"x_label\": \"East, m\", \"rows\": [{\"what\": "
         "\"ionosphere\", "
         "\"unit\": \"m\", \"paper\": 4.73, \"real\": null, \"ours\": [{\"form\": \"as printed\", \"value\": " +
         value +
         ", \"low\": null, \"high\": null}, {\"form\": \"as corrected\", \"value\": 5.09, \"low\": 5.0, \"high\": "
         "5.2}], "
         "\"nearest\": \"as corrected\", \"ratio\": 1.076}], \"curves\": [{\"panel\": \"North\", \"unit\": \"m\", "
         "\"name\": \"no error\", \"points\": true, \"x\": [1, 2, 3], \"y\": [1, null, 4]}]}]}";
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
  EXPECT_THAT(*page, HasSubstr("<td class=\"text\">as corrected</td><td><b>5.09</b></td>"));
  EXPECT_THAT(*page, HasSubstr("so &amp; so"));
  EXPECT_THAT(*page, HasSubstr("It &lt;differs&gt;."));
  EXPECT_THAT(*page, HasSubstr("id=\"table_1-0\""));
  EXPECT_THAT(*page, HasSubstr("was not driven: canyon reproduce --missions N."));
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
