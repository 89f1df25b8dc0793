#include "canyon/report/sections/why_details.h"

#include "canyon/report/format.h"

namespace canyon::report {

std::string why_details(const Why& why, const std::string& summary) {
  std::string body = "<details class=\"more\"><summary>" + escape_html(summary) + "</summary>\n<ul>\n";
  for (const std::string& line : why.chain) body += "<li>" + escape_html(line) + "</li>\n";
  body +=
      "</ul>\n<table><thead><tr><th scope=\"col\" class=\"text\">taken away</th><th scope=\"col\">succeeds</th><th "
      "scope=\"col\">difference, 95 %</th><th scope=\"col\">p</th></tr></thead>\n<tbody><tr><th scope=\"row\">nothing, "
      "other noise</th><td>" +
      show_count(why.successes_as_it_was) + " of " + show_count(why.draws) + "</td><td></td><td></td></tr>\n";
  for (const Why::Removal& removal : why.removals)
    body += "<tr><th scope=\"row\">" + escape_html(removal.name) + "</th><td>" + show_count(removal.successes) +
            " of " + show_count(why.draws) + "</td><td>" + show_number(100.0 * removal.difference.low, 2) + " to " +
            show_number(100.0 * removal.difference.high, 2) + " %</td><td>" + show_number(removal.p, 2) +
            (removal.rescues ? ", rescues" : "") + "</td></tr>\n";
  return body + "</tbody></table>\n</details>\n";
}

}  // namespace canyon::report
