#include "canyon/core/files/tape.h"

#include <cmath>
#include <filesystem>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"

namespace canyon {
namespace {

using ::testing::HasSubstr;

class TapeTest : public ::testing::Test {
 protected:
  TapeTest() { std::filesystem::create_directories(folder_); }
  ~TapeTest() override { std::filesystem::remove_all(folder_); }

  std::string written(const std::string& bytes) const {
    EXPECT_TRUE(write_text_file(path_, bytes).ok());
    return path_;
  }
  std::string complaint(const std::string& bytes) const {
    const auto tape = read_tape(written(bytes));
    return tape ? "" : tape.error().str();
  }

  static Tape example() {
    Tape tape{.source = "low of t", .scene_hash = "abc", .traffic = "", .nodes = {}};
    for (int i = 0; i < 5; ++i) {
      TapeNode node;
      node.motion.t.ns = 10'000'000 * i;
      node.motion.X_WB.p = {0.1 * i, -1.0 / 3.0, 7e-9};
      node.motion.w_WB_B = {1e-300, 2.0, 3.0};
      node.distance_m = 0.1 * i;
      node.command = {5.0, -0.01};
      tape.nodes.push_back(node);
    }
    return tape;
  }
  static std::string bytes_of(const Tape& tape) {
    std::string bytes = tape_header(tape);
    for (const TapeNode& node : tape.nodes) append_tape_node(bytes, node);
    return bytes;
  }

  std::string folder_ = ::testing::TempDir() + "canyon_tape_" + std::to_string(getpid());
  std::string path_ = folder_ + "/a.tape";
};

TEST_F(TapeTest, ComesBackToTheBit) {
  const Tape tape = example();
  const auto read = read_tape(written(bytes_of(tape)));
  ASSERT_TRUE(read.ok()) << read.error().str();
  EXPECT_EQ(read->source, tape.source);
  EXPECT_EQ(read->scene_hash, tape.scene_hash);
  EXPECT_EQ(bytes_of(*read), bytes_of(tape));
  EXPECT_DOUBLE_EQ(read->duration_s(), 0.04);
}

TEST_F(TapeTest, WhatIsNoTapeIsToldInOneLine) {
  const std::string good = bytes_of(example());
  EXPECT_EQ(complaint("hello"), path_ + ": does not begin as a tape, expected a tape that canyon wrote");
  EXPECT_EQ(complaint(""), path_ + ": does not begin as a tape, expected a tape that canyon wrote");
  EXPECT_EQ(complaint("{\"kind\": 3}\n"), path_ + ": does not begin as a tape, expected a tape that canyon wrote");
  EXPECT_EQ(complaint(good.substr(0, good.size() - 5)),
            path_ + ": ends within a node, expected a tape that canyon wrote");
  EXPECT_EQ(complaint(tape_header(example())), path_ + ": 0 nodes, expected a tape that canyon wrote");
  Tape bad = example();
  bad.nodes[2].motion.v_WB_W.x() = std::nan("");
  EXPECT_EQ(complaint(bytes_of(bad)), path_ + ": node 3 is no motion, expected a tape that canyon wrote");
  bad = example();
  bad.nodes[2].motion.t = bad.nodes[1].motion.t;
  EXPECT_EQ(complaint(bytes_of(bad)),
            path_ + ": node 3 does not come after the one before, expected a tape that canyon wrote");
  EXPECT_THAT(read_tape(folder_ + "/none").error().str(), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace canyon
