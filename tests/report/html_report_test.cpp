#include "canyon/report/html_report.h"

#include <cstdlib>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/tests/report/results_page.h"

namespace canyon::report {
namespace {

using canyon::testing::after;
using canyon::testing::attributes;
using canyon::testing::has_word;
using canyon::testing::load;
using canyon::testing::section;
using canyon::testing::store;
using canyon::testing::TemporaryDirectory;
using canyon::testing::without;
using canyon::testing::write_synthetic_results;
using ::testing::HasSubstr;
using ::testing::Not;

/// A complete synthetic directory and its page, made once.
class HtmlReport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryDirectory;
    write_synthetic_results(folder_->path());
    const auto page = html_report(folder_->path());
    ASSERT_TRUE(page.ok()) << page.error().str();
    page_ = new std::string(*page);
    // For a look at it: CANYON_KEEP_REPORT=FILE.
    if (const char* keep = std::getenv("CANYON_KEEP_REPORT")) store(keep, *page);
  }
  static void TearDownTestSuite() {
    delete folder_;
    delete page_;
  }
  static const std::string& page() { return *page_; }

 private:
  static inline TemporaryDirectory* folder_ = nullptr;
  static inline std::string* page_ = nullptr;
};

TEST_F(HtmlReport, IsWrittenToTheFile) {
  const TemporaryDirectory folder;
  write_synthetic_results(folder.path(),
                          {.speed_m_s = 16, .paper = false, .mixed = false, .cloud_points_per_keyframe = 5});
  const std::string out = folder.file("report.html");
  ASSERT_TRUE(write_html_report(folder.path(), out).ok());
  EXPECT_EQ(load(out), *html_report(folder.path()));
}

TEST_F(HtmlReport, HasAllSectionsInOrder) {
  std::size_t last = 0;
  for (const char* id : {"verdict", "figures", "scene-section", "errors", "filter", "satellites", "multipath", "maps",
                         "registration", "two-by-two", "cost", "made"}) {
    const std::size_t at = page().find("<section id=\"" + std::string(id) + "\"");
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_GT(at, last) << id;
    last = at;
  }
}

TEST_F(HtmlReport, SaysWhatOfTheFilterDoesNotFit) {
  const std::string filter = section(page(), "filter");
  EXPECT_THAT(filter,
              HasSubstr("<li class=\"bad\">height overconfident by 2.3 (error 4.6 m where 2 m are claimed)</li>"));
  EXPECT_THAT(filter, HasSubstr("<li class=\"soft\">mounting x not observed</li>"));
  // What is beyond the band is bold: 2.3 times, of up to 1.2.
  EXPECT_THAT(filter, HasSubstr("<th scope=\"row\">height</th><td class=\"strong\">2.30</td><td>up to 1.20</td>"));
  EXPECT_THAT(filter, HasSubstr("<th scope=\"row\">position</th><td>1.00</td>"));
  EXPECT_THAT(filter, HasSubstr("209, 7 refused"));
}

TEST_F(HtmlReport, RefersToNothingOutsideItself) {
  EXPECT_THAT(page(), Not(HasSubstr("http:")));
  EXPECT_THAT(page(), Not(HasSubstr("https:")));
  EXPECT_THAT(page(), Not(HasSubstr("@import")));
  EXPECT_THAT(page(), Not(HasSubstr("url(")));
  // Every href and src is a place on the page or data inside it.
  int references = 0;
  for (const char* name : {"href", "src", "srcset", "action", "data"}) {
    for (const std::string& target : attributes(page(), name)) {
      EXPECT_TRUE(target[0] == '#' || target.rfind("data:", 0) == 0) << target.substr(0, 80);
      ++references;
    }
  }
  EXPECT_GT(references, 10);
}

TEST_F(HtmlReport, RefersOnlyToIdentifiersThatExistOnce) {
  std::set<std::string> ids;
  for (const std::string& id : attributes(page(), "id")) EXPECT_TRUE(ids.insert(id).second) << id;
  EXPECT_GT(ids.size(), 20u);
  for (const std::string& target : attributes(page(), "href")) {
    EXPECT_TRUE(target[0] != '#' || ids.count(target.substr(1)) == 1) << target;
  }
  for (const std::string& target : attributes(page(), "for")) EXPECT_EQ(ids.count(target), 1u) << target;
  for (const std::string& targets : attributes(page(), "aria-labelledby")) {
    std::istringstream words(targets);
    for (std::string word; words >> word;) EXPECT_EQ(ids.count(word), 1u) << word;
  }
}

TEST_F(HtmlReport, TagsAreBalanced) {
  std::vector<std::string> open;
  const std::set<std::string> empty{"meta", "link", "input", "br", "!DOCTYPE"};
  // Scripts and styles hold < that are no tags; attributes hold neither < nor >, as everything in them is escaped.
  const std::string body = without(without(page(), "<script>", "</script>"), "<style>", "</style>");
  for (std::size_t at = body.find('<'); at != std::string::npos; at = body.find('<', at + 1)) {
    const std::size_t end = body.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const bool closing = body[at + 1] == '/';
    const std::size_t first = at + (closing ? 2 : 1);
    const std::string name = body.substr(first, body.find_first_of(" >\n/", first) - first);
    if (body[end - 1] == '/' || empty.count(name)) continue;
    if (!closing) {
      open.push_back(name);
      continue;
    }
    ASSERT_FALSE(open.empty()) << name;
    ASSERT_EQ(open.back(), name) << body.substr(at - 200, 220);
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
}

TEST_F(HtmlReport, EveryDrawingHasATitleOrIsHidden) {
  int drawings = 0;
  for (const std::string& start : after(page(), "<svg ", 400)) {
    const std::size_t end = start.find('>');
    ASSERT_NE(end, std::string::npos);
    const std::string tag = start.substr(0, end);
    if (tag.find("aria-hidden=\"true\"") != std::string::npos) continue;
    EXPECT_NE(tag.find("role=\"img\""), std::string::npos) << tag;
    EXPECT_TRUE(tag.find("aria-label=") != std::string::npos || start.compare(end + 1, 6, "<title") == 0) << tag;
    ++drawings;
  }
  EXPECT_GE(drawings, 15);
}

TEST_F(HtmlReport, IsBelowFiveMegabytes) {
  EXPECT_LT(page().size(), 5'000'000u);
}

TEST_F(HtmlReport, HasNoUndefinedNumbersInIt) {
  const std::string body = without(page(), "base64,", "\"");
  for (const char* undefined : {"nan", "NaN", "inf"}) EXPECT_FALSE(has_word(body, undefined)) << undefined;
}

TEST_F(HtmlReport, SaysTheVerdictFromTheNumbers) {
  EXPECT_THAT(page(), HasSubstr("<h1>Run low completes the mission; run high fails after "));
  const std::string verdict = section(page(), "verdict");
  EXPECT_THAT(verdict,
              HasSubstr("<strong>low</strong> completed the mission: 11 of 11 waypoints and 3 of 3 mission waypoints"));
  EXPECT_THAT(verdict, HasSubstr("<strong>high</strong> failed: it hit an obstacle after "));
  EXPECT_THAT(verdict, HasSubstr("it had reached 6 of 11 waypoints and 0 of 3 mission waypoints."));
  EXPECT_THAT(verdict, HasSubstr("Front right corner touched building 217."));
  EXPECT_THAT(page(), Not(HasSubstr("ellipsoidal height")));
  EXPECT_THAT(page(), HasSubstr("<code>summary.json</code>, <code>epochs/</code> and <code>clouds/</code>"));
  EXPECT_THAT(page(), HasSubstr("CPU time per simulated second"));
}

TEST_F(HtmlReport, TellsThatALowGnssHasNoSatellites) {
  EXPECT_THAT(section(page(), "satellites"), HasSubstr("Run low has no satellites"));
  EXPECT_THAT(section(page(), "multipath"), HasSubstr("Run low has no satellites to show"));
}

TEST(HtmlReportErrors, AMissingDirectoryIsTold) {
  const auto html = html_report("/no/such/results");
  ASSERT_FALSE(html.ok());
  EXPECT_EQ(html.error().str(), "/no/such/results: no such directory, expected a results directory");
}

}  // namespace
}  // namespace canyon::report
