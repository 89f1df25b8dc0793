#include "canyon/study/stress/sweep/finite_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "canyon/core/files/files.h"
#include "canyon/core/files/pcd.h"
#include "canyon/study/stress/sweep/absent_values.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;

// Where a value may be absent depends on the row that it is of (2026-11-22: no empty field was looked at).
TEST(FiniteResults, AFieldIsEmptyOnlyWhereItsRowSaysSo) {
  const auto gnss = [](const std::string& row) {
    return not_finite_in_csv("status,satellites,gdop,nis,accepted,reason\n" + row + "\n", "gnss");
  };
  EXPECT_EQ(gnss("single,8,2.5,1.5,1,"), "");
  EXPECT_EQ(gnss("none,0,,,0,blocked"), "");
  EXPECT_EQ(gnss("single,,,1.5,1,"), "") << "a model without satellites";
  EXPECT_EQ(gnss("single,8,,1.5,1,"), "2: gdop is empty");
  EXPECT_EQ(gnss("single,8,2.5,,1,"), "2: nis is empty");
  EXPECT_EQ(gnss("single,8,2.5,,1,filter restarted"), "");
  EXPECT_EQ(gnss("single,8,2.5,,0,withheld"), "");
  EXPECT_EQ(gnss(",8,2.5,1.5,1,"), "2: status is empty");
  EXPECT_EQ(gnss("single,8,-inf,1.5,1,"), "2: gdop is -inf");
  EXPECT_EQ(gnss("single,8,1e999,1.5,1,"), "2: gdop is 1e999");
  EXPECT_EQ(gnss("single,8,2.5,1.5,1"), "2: 5 fields for 6 columns");
  EXPECT_EQ(not_finite_in_csv("t_s,x_m\n0,1", "nav"), "the last line has no end");
  const auto keyframe = [](const std::string& row) {
    return not_finite_in_csv("status,iterations,rms_m\n" + row + "\n", "keyframes");
  };
  EXPECT_EQ(keyframe("degenerate,29,"), "") << "matched, but nothing that determines a pose";
  EXPECT_EQ(keyframe("converged,29,"), "2: rms_m is empty");
  const auto alignment = [](const std::string& row) {
    return not_finite_in_csv("status,open_directions,align_nees,open_vectors\n" + row + "\n", "keyframes");
  };
  EXPECT_EQ(alignment("ambiguous,,,"), "");
  EXPECT_EQ(alignment("converged,0,5.1,"), "");
  EXPECT_EQ(alignment("converged,,5.1,"), "") << "a method that tells of no directions";
  EXPECT_EQ(alignment("converged,0,,"), "2: align_nees is empty");
  EXPECT_EQ(alignment("converged,1,5.1,"), "2: open_vectors is empty");
}

TEST(FiniteResults, ANullStandsOnlyWhereItsObjectSaysSo) {
  const auto run = [](const std::string& members) {
    return not_finite_in_json("{\"runs\": [{" + members + "}]}", "summary.json");
  };
  EXPECT_EQ(run(R"("outcome": "success", "failure": null)"), "");
  EXPECT_EQ(run(R"("outcome": "stopped", "failure": null)"), "runs[0].failure is null");
  EXPECT_EQ(run(R"("fixes_due": 3, "fixes_lost": 3, "fix_error_rms_m": null)"), "");
  EXPECT_EQ(run(R"("fixes_due": 3, "fixes_lost": 2, "fix_error_rms_m": null)"), "runs[0].fix_error_rms_m is null");
  EXPECT_EQ(run(R"("map_points_level_prior": 0, "map_error_up_prior_rms_m": null)"), "");
  EXPECT_EQ(run(R"("map_points_level_prior": 1, "map_error_up_prior_rms_m": null)"),
            "runs[0].map_error_up_prior_rms_m is null");
  EXPECT_EQ(run(R"("distance_m": 0.0, "phantoms_per_km": null)"), "");
  EXPECT_EQ(run(R"("distance_m": 1e-9, "phantoms_per_km": null)"), "runs[0].phantoms_per_km is null");
  EXPECT_EQ(run(R"("closest_m": [1, null])"), "runs[0].closest_m[1] is null");
  EXPECT_THAT(run(R"("distance_m": NaN)"), HasSubstr("summary.json:1: "));
}

TEST(FiniteResults, CloudsAndPagesToo) {
  const canyon::testing::TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    ASSERT_TRUE(write_text_file(folder.file(name), text).ok());
  };
  EXPECT_THAT(not_finite_in_results(folder.file("none")), HasSubstr("left no none: "));
  EXPECT_EQ(not_finite_in_results(folder.path().string()), "left no summary.json");
  write("summary.json", "{}");
  write("manifest.json", "{}");
  EXPECT_EQ(not_finite_in_results(folder.path().string()), "");
  write("report.html", "<path d=\"M nan 3\">");
  EXPECT_EQ(not_finite_in_results(folder.path().string()), "report.html: a number that is not finite");
  write("report.html", "<p>a tenant of the nanosecond</p>");
  EXPECT_EQ(not_finite_in_results(folder.path().string()), "");
  const float point[] = {1.0F, std::numeric_limits<float>::infinity()};
  write("a.pcd", pcd_header({{.name = "x"}, {.name = "y"}}, 1) +
                     std::string(reinterpret_cast<const char*>(point), sizeof point));
  EXPECT_EQ(not_finite_in_results(folder.path().string()), "a.pcd: a point that is not finite");
}

std::string with_or(std::string_view values) {
  std::string text;
  for (const char c : values) text += c == ',' ? " or " : std::string(1, c);
  return text;
}

/// The rows in Markdown.
std::string absent_list() {
  std::string text = "| file | values | where | because |\n|---|---|---|---|\n";
  for (const MayBeAbsent& row : may_be_absent()) {
    const std::string_view file = row.file;
    text +=
        "| `" + (file.ends_with(".json") ? std::string(file) : "epochs/RUN_" + std::string(file) + ".csv") + "` | `";
    for (const char c : std::string_view(row.values)) text += c == ',' ? "`, `" : std::string(1, c);
    text += "` | ";
    const std::string_view is = row.is;
    if (*row.when != '\0')
      text += "`" + std::string(row.when) + "` " +
              (is.empty()            ? "is absent"
               : is.starts_with('=') ? "= `" + std::string(is.substr(1)) + "`"
                                     : "= " + with_or(is));
    text += std::string(" | ") + row.why + " |\n";
  }
  return text;
}

TEST(AbsentValues, StandInTheDocumentation) {
  const auto page = read_text_file(CANYON_SOURCE_DIR "/docs/results.md");
  ASSERT_TRUE(page.ok());
  EXPECT_NE(page->find(absent_list()), std::string::npos) << "docs/results.md is to have:\n" << absent_list();
}

}  // namespace
}  // namespace canyon::study
