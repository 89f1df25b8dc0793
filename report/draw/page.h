#pragma once

#include <string>
#include <string_view>

namespace canyon::report {

/// A whole page with its style and scripts in it, for `colours` runs; no address outside itself. `title` is plain;
/// `main_html` is the header and the sections, `before_html` what must stand before <main>.
std::string whole_page(std::string_view title, std::size_t colours, const std::string& main_html,
                       const std::string& before_html = "");

}  // namespace canyon::report
