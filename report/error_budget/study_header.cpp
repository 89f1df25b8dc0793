#include "canyon/report/error_budget/study_header.h"

#include "canyon/report/draw/html.h"
#include "canyon/report/format.h"
#include "canyon/report/read/json_fields.h"

namespace canyon::report {

std::string study_header(const JsonFields& summary, const std::string& further, const std::string& title,
                         const std::string& lead) {
  return "<header>\n<p class=\"kicker\">Canyon \xC2\xB7 mission " + escape_html(summary.required_text("mission")) +
         " \xC2\xB7 " + escape_html(summary.required_text("fidelity")) + " \xC2\xB7 " +
         count_of(summary.number("seeds"), "seed", "seeds") + further + "</p>\n<h1>" + title + "</h1>\n" + lead +
         "</header>\n";
}

}  // namespace canyon::report
