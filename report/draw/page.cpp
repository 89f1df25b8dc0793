#include "canyon/report/draw/page.h"

#include "canyon/core/check.h"
#include "canyon/core/process/embedded.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"

namespace canyon::report {
namespace {

std::string asset(std::string_view key) {
  const auto bytes = embedded_file(key);
  CANYON_CHECK(bytes.has_value(), "not embedded: ", key);
  return std::string(*bytes);
}

}  // namespace

std::string whole_page(std::string_view title, std::size_t colours, const std::string& main_html,
                       const std::string& before_html) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
         "content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n<link "
         "rel=\"icon\" href=\"data:,\">\n<title>" +
         escape_html(title) + "</title>\n<style>\n" + theme_css(colours) + asset("report/assets/report.css") +
         "</style>\n</head>\n<body>\n" + before_html + "<main>\n" + main_html + "</main>\n<script>\n" +
         asset("report/assets/report.js") + "</script>\n</body>\n</html>\n";
}

}  // namespace canyon::report
