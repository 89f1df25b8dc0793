// What CONTRIBUTING.md shows is compiled and works; tests/contributing/quoted_test.py checks that it is what stands
// here.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/scene/importers/importer.h"
#include "canyon/tests/contributing/fix_share_figure.h"

namespace canyon {
namespace apps {
Verb gravity_verb();
}
namespace scene {
Result<RawScene> read_boxes(const std::string& path, const ReadOptions& options);
}

namespace {

TEST(WorkedExample, AFigureIsOneRow) {
  study::RunSummary run;
  EXPECT_TRUE(std::isnan(study::estimate(study::kFixShare, run).value));
  run.fixes_due = 8;
  run.fixes_lost = 2;
  EXPECT_EQ(study::estimate(study::kFixShare, run).value, 0.75);
  // It reads as those of the product do: under one of their headings, and shares are shown in per cent.
  EXPECT_TRUE(std::any_of(study::figures().begin(), study::figures().end(),
                          [](const study::Figure& f) { return std::string_view(f.group) == study::kFixShare.group; }));
  for (const study::Figure& f : study::figures()) {
    const bool share = f.kind == study::Figure::Kind::kShare;
    EXPECT_TRUE(!share || std::string_view(f.unit) == study::kFixShare.unit) << f.key;
  }
  EXPECT_STREQ(study::kFixShare.unit, "%");
  EXPECT_EQ(study::find_figure("fix_share"), nullptr) << "a figure of the product has this key: show another one";
}

TEST(WorkedExample, AVerbDeclaresCallsAndPrints) {
  const apps::Verb verb = apps::gravity_verb();
  CLI::App app;
  apps::Arguments arguments(app);
  const apps::VerbAction action = verb.declare(arguments);
  app.parse("--lat 90");
  ::testing::internal::CaptureStdout();
  const Result<int> status = action();
  // WGS 84's normal gravity at the poles: 9.8321849378 m/s^2, all the digits that NIMA TR8350.2 (third edition, 2000),
  // table 3.4, prints. The verb prints one digit less.
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "9.832184938 m/s^2\n");
  ASSERT_TRUE(status.ok());
  EXPECT_EQ(*status, 0);
}

class BoxesReader : public ::testing::Test {
 protected:
  Result<scene::RawScene> read(const std::string& text) {
    std::ofstream(path_) << text;
    return scene::read_boxes(path_, {});
  }
  ~BoxesReader() override { std::filesystem::remove(path_); }
  const std::string path_ = ::testing::TempDir() + "canyon_worked_example_" + std::to_string(::getpid()) + ".boxes";
};

TEST_F(BoxesReader, ReadsALineABuilding) {
  const auto scene = read("# a yard\n0 0 10 20 8\n30 5 4 4 3\n");
  ASSERT_TRUE(scene.ok()) << scene.error().str();
  ASSERT_EQ(scene->footprints.size(), 2u);
  EXPECT_EQ(scene->footprints[1].height_m, 3.0);
  EXPECT_EQ(scene->footprints[0].rings[0][2], Eigen::Vector2d(5.0, 10.0));
}

TEST_F(BoxesReader, NamesTheLineOfAMistake) {
  EXPECT_EQ(read("0 0 10 20 8\n1 2 3\n").error().str(), path_ + ":2: 3 numbers, expected x y width depth height");
  EXPECT_EQ(read("0 0 0 20 8\n").error().str(), path_ + ":1: a box without extent, expected sizes above zero");
  EXPECT_EQ(read("").error().str(), path_ + ": holds no box, expected at least one line of numbers");
}

}  // namespace
}  // namespace canyon
