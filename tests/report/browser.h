#pragma once

#include <string>
#include <vector>

namespace canyon::testing {

/// What Chromium made of a page.
struct BrowserVisit {
  int exit_status = -1;
  std::string dom;  ///< after all scripts
  std::vector<std::string>
      console;  ///< lines that the page or the browser wrote about it: script errors, refused requests
};

/// Path of Chromium: $CANYON_CHROMIUM, else chromium, chromium-browser or google-chrome out of $PATH; empty if there is
/// none.
std::string find_chromium();

/// Opens an HTML file without a window, in a new profile, with all names of hosts unresolvable; gives up after two
/// minutes.
BrowserVisit visit_page(const std::string& chromium, const std::string& html_file);

}  // namespace canyon::testing

/// Skips the running test by name where there is no Chromium.
#define CANYON_BROWSER(variable)                                   \
  const std::string variable = ::canyon::testing::find_chromium(); \
  if (variable.empty()) GTEST_SKIP() << "chromium not found (set CANYON_CHROMIUM)"
