#include "canyon/tests/report/browser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/report/html_report.h"
#include "canyon/tests/report/synthetic_results.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Browser, OpensTheReportWithoutAnyMessage) {
  CANYON_BROWSER(chromium);
  const TemporaryDirectory folder;
  write_synthetic_results(folder.path());
  const std::string page = folder.file("report.html");
  ASSERT_TRUE(report::write_html_report(folder.path(), page).ok());
  const BrowserVisit visit = visit_page(chromium, page);
  EXPECT_EQ(visit.exit_status, 0);
  EXPECT_THAT(visit.console, IsEmpty());
  // The script ran to its end and found the charts.
  EXPECT_THAT(visit.dom, HasSubstr("data-readouts=\""));
  EXPECT_THAT(visit.dom, Not(HasSubstr("data-readouts=\"0\"")));
  EXPECT_THAT(visit.dom, HasSubstr("class=\"cursor\""));
}

TEST(Browser, HearsWhatAPageComplainsAbout) {  // else the test above could not fail
  CANYON_BROWSER(chromium);
  const TemporaryDirectory folder;
  const std::string page = folder.file("broken.html");
  store(page, "<!DOCTYPE html><title>broken</title><p>text</p><script>missing_function();</script>");
  const BrowserVisit visit = visit_page(chromium, page);
  ASSERT_EQ(visit.console.size(), 1u);
  EXPECT_THAT(visit.console[0], HasSubstr("missing_function is not defined"));
}

}  // namespace
}  // namespace canyon::testing
