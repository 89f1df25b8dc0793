#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/core/files/json_text.h"
#include "canyon/report/html_report.h"

namespace canyon::apps {

namespace {

VerbAction declare(Arguments& arguments) {
  struct Options {
    CommonOptions common;
    std::string directory;
  };
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments.option("directory", options->directory, "results directory of compare or run").required();
  return [options]() -> Result<int> {
    const std::string file = options->directory + "/report.html";
    CANYON_TRY_STATUS(report::write_html_report(options->directory, file));
    if (options->common.json) {
      const nlohmann::json json{{"report", file}};
      std::printf("%s\n", json_text(json).c_str());
    } else {
      std::printf("Report: %s\n", std::filesystem::absolute(file).lexically_normal().c_str());
    }
    return 0;
  };
}

}  // namespace

Verb report_verb() {
  return {"report", "the HTML report again, from a stored results directory", "canyon report results/first", declare};
}

}  // namespace canyon::apps
