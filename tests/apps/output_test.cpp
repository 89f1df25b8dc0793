// What verbs write: single files that replace nothing unasked and survive a full disk, and the standard output.
#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OutputTest : public testing::CommandLineTest {
 protected:
  /// Runs a shell's line in the test's folder, with CANYON for the program; returns the exit status.
  int shell(const std::string& line) const {
    const std::string command = "cd '" + folder_.string() + "' && CANYON='" CANYON_BINARY "' && { " + line + "; }";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// The verb that writes the file `name`: refused where one stands, replaced with --force, and on a full disk (files
  /// may grow to half a kilobyte) the old one stays.
  void expect_careful(const std::string& verb, const std::string& name) const {
    write(name, "old");
    EXPECT_EQ(canyon(verb), 2) << verb;
    EXPECT_EQ(read("stderr"), name + ": output file exists, expected a new name or --force\n");
    EXPECT_EQ(read(name), "old") << verb;

    EXPECT_EQ(shell("(ulimit -f 1; \"$CANYON\" " + verb + " --force > /dev/null 2> stderr)"), 1) << verb;
    EXPECT_THAT(read("stderr"), HasSubstr(name + ": cannot be written to the end (File too large)"));
    EXPECT_EQ(read(name), "old") << verb;
    EXPECT_THAT(leftovers(), ::testing::IsEmpty()) << verb;

    EXPECT_EQ(canyon(verb + " --force"), 0) << verb << read("stderr");
    EXPECT_GT(fs::file_size(path(name)), 512U) << verb;
    EXPECT_THAT(leftovers(), ::testing::IsEmpty()) << verb;
  }
};

// 2026-11-22: these replaced an existing file unasked, and on a full disk left half a file in its place.
TEST_F(OutputTest, SingleFilesAreRefusedReplacedAndSurviveAFullDisk) {
  const std::string simulate = "gnss simulate --at 32.35,-90.88,60 --duration 60 ";
  expect_careful(simulate + "--rinex-obs given.obs", "given.obs");
  expect_careful(simulate + "--rinex-nav given.nav", "given.nav");
  expect_careful(simulate + "--nmea given.nmea", "given.nmea");
  expect_careful("gnss solve --obs given.obs --nav given.nav --out given_p.csv", "given_p.csv");
  for (const char* name : {"given_imu.csv", "given_imu.txt"})
    expect_careful("imu simulate --path circle --duration 10 --out " + std::string(name), name);
  expect_careful("lidar scan --at 213.9,30,0,90 --pcap given.pcap", "given.pcap");
  expect_careful("scene info vicksburg --cell 20 --picture given.svg", "given.svg");
}

// 2026-11-22: of several outputs the first were in place when a later one failed.
TEST_F(OutputTest, SeveralOutputsAppearTogetherOrNotAtAll) {
  const std::string simulate = "gnss simulate --at 32.35,-90.88,60 --duration 600 --rinex-nav given.nav --out given_d ";
  write("given.nav", "old");
  EXPECT_EQ(shell("(ulimit -f 40; \"$CANYON\" " + simulate + "--nmea given.nmea --force > /dev/null 2> stderr)"), 1)
      << read("stderr");
  EXPECT_EQ(read("given.nav"), "old");
  EXPECT_FALSE(fs::exists(path("given_d")));
  EXPECT_FALSE(fs::exists(path("given.nmea")));
  EXPECT_THAT(leftovers(), ::testing::IsEmpty());
  EXPECT_EQ(canyon(simulate + "--nmea given.nav --force"), 2);
  EXPECT_EQ(read("stderr"), "given.nav: named for two outputs, expected a name for each\n");
  EXPECT_EQ(canyon(simulate + "--nmea given_d/log.nmea --force"), 0) << read("stderr");
  EXPECT_TRUE(fs::exists(path("given_d/log.nmea")) && fs::exists(path("given_d/fixes.csv")));
}

TEST_F(OutputTest, AReportOnAFullDiskKeepsTheOldOne) {
  ASSERT_EQ(canyon("run mission.toml --fidelity low --out given_out"), 0) << read("stderr");
  const std::string page = read("given_out/report.html");
  EXPECT_EQ(shell("(ulimit -f 1; \"$CANYON\" report given_out > /dev/null 2> stderr)"), 1);
  EXPECT_EQ(read("given_out/report.html"), page);
  EXPECT_EQ(canyon("report given_out"), 0) << read("stderr");
  EXPECT_EQ(read("given_out/report.html"), page);
}

// 2026-11-22: --json, keys, tables and --help written to a full disk: exit status 0, and the output was lost.
TEST_F(OutputTest, WhatIsPrintedAndDoesNotArriveIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  for (const char* verb : {"keys", "keys --json", "--help", "--version", "compare --help", "imu dead-reckon --help",
                           "imu simulate --path circle --duration 1 --json"}) {
    EXPECT_EQ(shell(std::string("\"$CANYON\" ") + verb + " > /dev/full 2> stderr"), 1) << verb;
    const std::string message = read("stderr");
    EXPECT_EQ(message,
              "standard output: cannot be written to the end (No space left on device), expected a place "
              "that takes it\n")
        << verb;
    EXPECT_EQ(shell(std::string("\"$CANYON\" ") + verb + " >&- 2> stderr"), 1) << verb;
  }
}

// As other programs: `| head -1` ends it by SIGPIPE, silently; who ignores that signal gets exit status 1.
TEST_F(OutputTest, APipeThatNobodyReadsAnyMore) {
  EXPECT_EQ(shell("{ sleep 0.3; \"$CANYON\" keys 2> stderr; echo $? > status; } | true"), 0);
  EXPECT_EQ(read("status"), "141\n");  // 128 + SIGPIPE
  EXPECT_EQ(read("stderr"), "");
  EXPECT_EQ(shell("{ trap '' PIPE; sleep 0.3; \"$CANYON\" keys 2> stderr; echo $? > status; } | true"), 0);
  EXPECT_EQ(read("status"), "1\n");
  EXPECT_THAT(read("stderr"), HasSubstr("standard output: cannot be written to the end"));
}

// A file must not get the number of a standard stream that was closed, or what is printed would be in it.
TEST_F(OutputTest, AClosedStandardOutputIsNotTheNextFile) {
  EXPECT_EQ(shell("\"$CANYON\" imu simulate --path circle --duration 10 --out given.csv >&- 2> stderr"), 1);
  EXPECT_EQ(read("given.csv").rfind("t_s,", 0), 0U);
  EXPECT_EQ(read("given.csv").find("samples at"), std::string::npos);
}

// 2026-11-22: the manifest named neither commit nor command line, and the CPU's instruction set for the ray tracer's.
TEST_F(OutputTest, TheManifestSaysWhatMadeIt) {
  ASSERT_EQ(shell("CANYON_RAY_TRACER_MAX_ISA=sse2 \"$CANYON\" run mission.toml --fidelity low --out 'given out' "
                  "> /dev/null 2> stderr"),
            0)
      << read("stderr");
  const auto manifest = nlohmann::json::parse(read("given out/manifest.json"));
  EXPECT_EQ(manifest["command_line"], "canyon run mission.toml --fidelity low --out 'given out'");
  EXPECT_EQ(manifest["instruction_set"], "sse2");
  ASSERT_TRUE(manifest.contains("commit"));
  if (manifest["commit"].is_string()) {
    const auto commit = manifest["commit"].get<std::string>();
    EXPECT_EQ(commit.find_first_not_of("0123456789abcdef"), commit.size() > 40 ? 40 : std::string::npos) << commit;
    EXPECT_EQ(commit.size() > 40 ? commit.substr(40) : "-modified", "-modified");
  }
  EXPECT_EQ(shell("CANYON_RAY_TRACER_MAX_ISA=neon \"$CANYON\" keys 2> stderr"), 2);
  EXPECT_EQ(read("stderr"), "CANYON_RAY_TRACER_MAX_ISA: \"neon\", expected one of sse2, sse4.2, avx, avx2, avx512\n");
}

// 2026-11-29: gicp was the name of another method before, and no manifest said which of the two had run.
TEST_F(OutputTest, TheManifestSaysWhoseRegistrationEachRunHad) {
  write("given.toml", std::string(testing::kMission) + "[fidelity.high.registration]\nmethod = \"gicp\"\n");
  ASSERT_EQ(canyon("compare given.toml --fidelities low,high --no-2x2 --set time.limit_s=1 --out given_out"), 0)
      << read("stderr");
  const auto methods = nlohmann::json::parse(read("given_out/manifest.json"))["registration_method"];
  ASSERT_EQ(methods.size(), 2U) << methods;
  EXPECT_EQ(methods["low"]["name"], "none");
  EXPECT_EQ(methods["low"]["engine"], "none");
  EXPECT_EQ(methods["high"]["name"], "gicp");
  EXPECT_EQ(methods["high"]["engine"], "own; the method that had this name before is pcl_shell_gicp");
}

// The kinds of docs/results.md, scan for scan. What the CPU does not have is limited to what it has.
TEST_F(OutputTest, ScansDifferByInstructionSetAtEdgesAlone) {
  struct Scan {
    std::string cloud;
    std::vector<std::vector<std::string>> truth;  // true_range_m, cos_incidence, material, object
  };
  const auto scan = [&](const std::string& set) {
    EXPECT_EQ(shell("CANYON_RAY_TRACER_MAX_ISA=" + set +
                    " \"$CANYON\" lidar scan --at 213.9,30,0,90 --scans 2 --out given_" + set + " > /dev/null"),
              0);
    Scan result{read("given_" + set + "/scan_000001.pcd"), {}};
    std::istringstream rows(read("given_" + set + "/scan_000001_truth.csv"));
    for (std::string row, cell; std::getline(rows, row);) {
      std::istringstream cells(row);
      result.truth.emplace_back();
      while (std::getline(cells, cell, ',')) result.truth.back().push_back(cell);
    }
    return result;
  };
  const Scan sse2 = scan("sse2");
  ASSERT_GT(sse2.truth.size(), 20'000U);
  for (const std::string set : {"sse4.2", "avx"}) {
    const Scan same = scan(set);
    EXPECT_EQ(same.cloud, sse2.cloud) << set;
    EXPECT_EQ(same.truth, sse2.truth) << set;
  }
  for (const std::string set : {"avx2", "avx512"}) {
    const Scan other = scan(set);
    ASSERT_EQ(other.truth.size(), sse2.truth.size()) << set;
    int rays = 0;
    for (std::size_t row = 1; row < other.truth.size(); ++row) {
      rays += other.truth[row] != sse2.truth[row] ? 1 : 0;
      EXPECT_NEAR(std::stod(other.truth[row][0]), std::stod(sse2.truth[row][0]), 2e-4) << set << ", row " << row;
    }
    EXPECT_LE(rays, 5) << set;  // of 27,000: two triangles that meet, and a ray through their edge
  }
}

}  // namespace
}  // namespace canyon::apps
