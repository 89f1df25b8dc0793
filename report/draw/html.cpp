#include "canyon/report/draw/html.h"

#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"

namespace canyon::report {

std::string section(std::string_view id, std::string_view title, const std::string& intro_html,
                    const std::string& body_html) {
  std::string out = "<section id=\"" + std::string(id) + "\" aria-labelledby=\"" + std::string(id) +
                    "-h\">\n<h2 id=\"" + std::string(id) + "-h\">" + escape_html(title) + "</h2>\n";
  if (!intro_html.empty()) out += "<p class=\"intro\">" + intro_html + "</p>\n";
  return out + body_html + "</section>\n";
}

std::string figure(const std::string& body_html, const std::string& caption_html) {
  std::string out = "<figure>\n" + body_html;
  if (!caption_html.empty()) out += "<figcaption>" + caption_html + "</figcaption>\n";
  return out + "</figure>\n";
}

std::string note(std::string_view text) {
  return "<p class=\"note\">" + escape_html(text) + "</p>\n";
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) out += i + 1 == names.size() ? " and " : ", ";
    out += names[i];
  }
  return out;
}

std::string run_tag(const std::vector<Run>& runs, std::size_t i) {
  return "<span class=\"tag keep " + run_class(i) +
         "\"><svg class=\"swatch\" viewBox=\"0 0 22 8\" aria-hidden=\"true\"><path d=\"M1 4H21\"/></svg>" +
         escape_html(runs[i].fidelity) + "</span>";
}

std::string run_legend(const std::vector<Run>& runs, const std::vector<std::size_t>& which) {
  std::string out = "<p class=\"legend\">";
  for (const std::size_t i : which) out += run_tag(runs, i) + " ";
  return out + "</p>\n";
}

std::vector<std::size_t> pure_runs(const Results& results) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    if (results.runs[i].is_pure()) out.push_back(i);
  }
  return out;
}

}  // namespace canyon::report
