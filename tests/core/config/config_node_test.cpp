#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/config/config.h"
#include "canyon/core/files/files.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon {
namespace {

constexpr const char* kToml = R"(# a mission
title = "recon"
seed = 42

[gnss]
rate_hz = 5.0   # fixes
mask_deg = 10
systems = ["GPS", "Galileo"]
base = { east_m = 3.5, on = true }

[[waypoint]]
at_m = [1, 2.5]

[[waypoint]]
at_m = [
  3,
  4,
]

[time]
start = 2010-07-01T13:00:00
utc = 2010-07-01T13:00:00Z
)";

ConfigNode parsed(const std::string& toml, const std::string& name = "my.toml") {
  auto node = ConfigNode::parse(toml, name);
  EXPECT_TRUE(node.ok()) << (node.ok() ? "" : node.error().str());
  return node.ok() ? *node : ConfigNode{};
}

TEST(ConfigNode, ValuesOfEveryType) {
  const ConfigNode root = parsed(kToml);
  EXPECT_EQ(std::get<std::string>(root.find("title")->value_), "recon");
  EXPECT_EQ(std::get<std::int64_t>(root.find("seed")->value_), 42);
  EXPECT_EQ(std::get<double>(root.find("gnss.rate_hz")->value_), 5.0);
  EXPECT_EQ(std::get<bool>(root.find("gnss.base.on")->value_), true);
  ASSERT_NE(root.find("gnss.systems")->array(), nullptr);
  EXPECT_EQ(std::get<std::string>(root.find("gnss.systems")->array()->at(1).value_), "Galileo");
  EXPECT_EQ(root.find("waypoint")->array()->size(), 2u);
  EXPECT_EQ(root.find("gnss.nothing"), nullptr);
  EXPECT_EQ(root.find("gnss.rate_hz.deeper"), nullptr);
  EXPECT_EQ(root.find("nothing.at.all"), nullptr);
}

TEST(ConfigNode, DatesWithoutQuotesAreText) {
  const ConfigNode root = parsed(kToml);
  EXPECT_EQ(std::get<std::string>(root.find("time.start")->value_), "2010-07-01T13:00:00");
  EXPECT_EQ(std::get<std::string>(root.find("time.utc")->value_), "2010-07-01T13:00:00Z");
}

TEST(ConfigNode, EveryNodeKnowsItsFileAndLine) {
  const ConfigNode root = parsed(kToml);
  const struct {
    const char* key;
    int line;
  } rows[] = {{"title", 2},        {"seed", 3},         {"gnss", 5},
              {"gnss.rate_hz", 6}, {"gnss.systems", 8}, {"gnss.base.east_m", 9},
              {"time.start", 21}};
  for (const auto& row : rows) {
    EXPECT_EQ(root.find(row.key)->line_, row.line) << row.key;
    EXPECT_EQ(root.find(row.key)->file_, "my.toml");
  }
  const ConfigNode& second = root.find("waypoint")->array()->at(1);
  EXPECT_EQ(second.line_, 14);
  EXPECT_EQ(second.find("at_m")->array()->at(1).line_, 17);
}

TEST(ConfigNode, DescribesItself) {
  const ConfigNode root = parsed("a = 3.5\nb = \"x\"\nc = 7\nd = false\ne = [1, 2]\n[f]\n[g]\nh = nan\n");
  EXPECT_EQ(root.find("a")->describe(), "float 3.5");
  EXPECT_EQ(root.find("b")->describe(), "string \"x\"");
  EXPECT_EQ(root.find("c")->describe(), "integer 7");
  EXPECT_EQ(root.find("d")->describe(), "boolean false");
  EXPECT_EQ(root.find("e")->describe(), "array of 2");
  EXPECT_EQ(root.find("f")->describe(), "a table");
  EXPECT_EQ(root.find("g.h")->describe(), "float nan");
  EXPECT_EQ(ConfigNode().describe(), "nothing");
}

TEST(ConfigNode, ErrorsOfTheParserHaveFileAndLine) {
  const auto bad = ConfigNode::parse("a = 1\nb = = 2\n", "my.toml");
  ASSERT_FALSE(bad.ok());
  const std::string text = bad.error().str();
  EXPECT_EQ(text.find("my.toml:2: not valid TOML: "), 0u) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const auto twice = ConfigNode::parse("a = 1\na = 2\n", "my.toml");
  ASSERT_FALSE(twice.ok());
  EXPECT_EQ(twice.error().line, 2);
  EXPECT_FALSE(ConfigNode::parse("[open\n", "my.toml").ok());
  EXPECT_FALSE(ConfigNode::parse("a = \"\xff\"\n", "my.toml").ok());
}

TEST(ConfigNode, LoadsFiles) {
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(write_text_file(folder.file("m.toml"), "a = 1\r\nb = 2\r\n").ok());
  const auto node = ConfigNode::load(folder.file("m.toml"));
  ASSERT_TRUE(node.ok());
  EXPECT_EQ(node->find("b")->line_, 2);
  EXPECT_EQ(node->find("b")->file_, folder.file("m.toml"));
  EXPECT_EQ(ConfigNode::load(folder.file("no.toml")).error().str(),
            folder.file("no.toml") + ": cannot be read (No such file or directory), expected a readable file");
}

TEST(ConfigNode, OverlayMergesTablesAndReplacesTheRest) {
  ConfigNode base = parsed("a = 1\nlist = [1, 2, 3]\n[t]\nx = 1\ny = 2\n[t.u]\nv = 1\n", "base.toml");
  base.overlay(parsed("\n\nlist = [9]\nb = 5\n[t]\ny = 20\nu = 3\n", "over.toml"));
  EXPECT_EQ(std::get<std::int64_t>(base.find("a")->value_), 1);
  EXPECT_EQ(std::get<std::int64_t>(base.find("b")->value_), 5);
  EXPECT_EQ(base.find("list")->array()->size(), 1u);
  EXPECT_EQ(std::get<std::int64_t>(base.find("t.x")->value_), 1);
  EXPECT_EQ(std::get<std::int64_t>(base.find("t.y")->value_), 20);
  EXPECT_EQ(std::get<std::int64_t>(base.find("t.u")->value_), 3);
  // Each value still knows where it was written.
  EXPECT_EQ(base.find("t.x")->file_, "base.toml");
  EXPECT_EQ(base.find("t.y")->file_, "over.toml");
  EXPECT_EQ(base.find("t.y")->line_, 6);
  ConfigNode empty;
  empty.overlay(base);
  EXPECT_EQ(std::get<std::int64_t>(empty.find("t.y")->value_), 20);
  base.overlay(base);  // onto itself changes nothing
  EXPECT_EQ(std::get<std::int64_t>(base.find("t.y")->value_), 20);
}

TEST(ConfigNode, SetMakesTablesOnTheWayAndNamesItsOrigin) {
  ConfigNode root = parsed("[run]\nseed = 1\n");
  root.set("run.seed", ConfigNode::of(std::int64_t{7}), "--seed");
  root.set("gnss.receiver.rate_hz", ConfigNode::of(2.5), "--set");
  root.set("run.quiet", ConfigNode::of(true), "--quiet");
  root.set("title", ConfigNode::of(std::string("x")), "--title");
  EXPECT_EQ(std::get<std::int64_t>(root.find("run.seed")->value_), 7);
  EXPECT_EQ(root.find("run.seed")->error("run.seed", "7 is odd", "an even one").str(),
            "--seed: run.seed: 7 is odd, expected an even one");
  EXPECT_EQ(std::get<double>(root.find("gnss.receiver.rate_hz")->value_), 2.5);
  EXPECT_EQ(root.find("gnss")->file_, "--set");
  EXPECT_EQ(root.find("run")->file_, "my.toml");
  EXPECT_EQ(std::get<bool>(root.find("run.quiet")->value_), true);
  EXPECT_EQ(std::get<std::string>(root.find("title")->value_), "x");
  root.set("title.inner", ConfigNode::of(1.0), "--set");  // a plain value gives way to a table
  EXPECT_NE(root.find("title.inner"), nullptr);
  EXPECT_THROW(root.set("", ConfigNode::of(1.0), "--set"), ProgramError);
}

TEST(ConfigNode, SetMarksWholeTrees) {
  ConfigNode root;
  root.set("scene", parsed("[a]\nb = [1]\n"), "--scene");
  EXPECT_EQ(root.find("scene.a.b")->array()->at(0).file_, "--scene");
  EXPECT_EQ(root.find("scene.a.b")->array()->at(0).line_, 0);
}

TEST(ConfigNode, EraseRemovesAKeyIfThere) {
  ConfigNode root = parsed("a = 1\nb = 2\n");
  root.erase("a");
  root.erase("nothing");
  EXPECT_EQ(root.find("a"), nullptr);
  EXPECT_NE(root.find("b"), nullptr);
  ConfigNode::of(1.0).erase("a");  // not a table: nothing to remove
}

TEST(NearestWord, ByEditDistance) {
  const std::vector<std::string> known = {"rate_hz", "mask_deg", "seed"};
  EXPECT_EQ(nearest_word("rate_hzz", known), "rate_hz");
  EXPECT_EQ(nearest_word("ratehz", known), "rate_hz");
  EXPECT_EQ(nearest_word("mask", {"mast"}), "mast");
  EXPECT_EQ(nearest_word("sed", known), "seed");
  EXPECT_EQ(nearest_word("sede", known), "seed");  // swapped letters are one mistake
  EXPECT_EQ(nearest_word("elevation", known), "");
  EXPECT_EQ(nearest_word("rate_hz", {}), "");
  EXPECT_EQ(nearest_word("", known), "");
}

TEST(NearestWord, ElseOneThatHoldsTheOther) {
  const std::vector<std::string> known = {"ionosphere_gradient", "ionosphere", "mask_deg", "rate_hz", "id"};
  EXPECT_EQ(nearest_word("iono", known), "ionosphere");  // the shorter of two that begin so
  EXPECT_EQ(nearest_word("ionosphere_model", known), "ionosphere");
  EXPECT_EQ(nearest_word("elevation_mask_deg", known), "mask_deg");
  EXPECT_EQ(nearest_word("rate", known), "rate_hz");
  EXPECT_EQ(nearest_word("identity_of_it", known), "");  // two letters in common are no hint
}

}  // namespace
}  // namespace canyon
