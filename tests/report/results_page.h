#pragma once

#include <string>

#include <gtest/gtest.h>

#include "canyon/report/html_report.h"
#include "canyon/tests/report/markup.h"
#include "canyon/tests/report/synthetic_results.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::testing {

/// Text of the section with this id.
inline std::string section(const std::string& html, const std::string& id) {
  const std::size_t start = html.find("<section id=\"" + id + "\"");
  if (start == std::string::npos) return {};
  return html.substr(start, html.find("</section>", start) - start);
}

/// A small results directory of its own, to be changed, and what its page then is.
class ResultsPage : public ::testing::Test {
 protected:
  void SetUp() override {
    write_synthetic_results(folder_.path(),
                            {.speed_m_s = 16, .paper = false, .mixed = false, .cloud_points_per_keyframe = 5});
  }
  std::string file(const std::string& name) const { return folder_.file(name); }
  std::string page() const {
    const auto html = report::html_report(folder_.path());
    EXPECT_TRUE(html.ok()) << html.error().str();
    return html.ok() ? *html : std::string();
  }
  /// The error with the directory's path cut off.
  std::string error() const {
    const auto html = report::html_report(folder_.path());
    if (html.ok()) return "no error";
    EXPECT_EQ(html.error().exit_code, 2);
    const std::string text = html.error().str();
    return text.rfind(folder_.path() + "/", 0) == 0 ? text.substr(folder_.path().size() + 1) : text;
  }
  TemporaryDirectory folder_;
};

}  // namespace canyon::testing
