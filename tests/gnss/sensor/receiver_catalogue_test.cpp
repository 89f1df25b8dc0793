#include "canyon/gnss/sensor/receiver_catalogue.h"

#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/process/embedded.h"
#include "canyon/gnss/sensor/gnss_config.h"

namespace canyon::gnss {
namespace {

std::string refusal(const std::string& toml) {
  const auto sheet = parse_receiver(toml, "mine.toml");
  return sheet ? "none" : sheet.error().str();
}

/// A built-in sheet as text, with one line of it exchanged.
std::string changed(const std::string& receiver, const std::string& line, const std::string& by) {
  std::string text(*embedded_file("gnss/receivers/" + receiver + ".toml"));
  const auto at = text.find(line);
  EXPECT_NE(at, std::string::npos) << line;
  return text.replace(at, line.size(), by);
}

TEST(ReceiverCatalogue, EveryFigureOfEveryReceiverHasASource) {
  EXPECT_EQ(receiver_names(),
            (std::vector<std::string>{"dgps_2010", "f9p", "m8", "phone", "snapshot_gps", "survey_multi"}));
  for (const std::string& name : receiver_names()) {
    const auto sheet = load_receiver(name);
    ASSERT_TRUE(sheet.ok()) << sheet.error().str();
    EXPECT_EQ(sheet->name, name);
    EXPECT_EQ(sheet->sources.size(), sheet->figures.table()->size());
    for (const auto& [key, source] : sheet->sources) EXPECT_GT(source.size(), 10u) << name << " " << key;
  }
}

TEST(ReceiverCatalogue, WhatIsMissingAndWhatContradictsIsToldAtOnce) {
  EXPECT_EQ(refusal("name = \"mine\"\ndescription = \"d\"\nsystems = \"G\"\n").substr(0, 60),
            std::string("mine.toml: mode: is missing, and so are mask_deg, receiver_clock").substr(0, 60));
  std::string text = changed("m8", "mask_deg = 5.0\n", "");
  text.replace(text.find("smoothing_s_source"), std::string("smoothing_s_source").size(), "#");
  text.replace(text.find("front_end_mhz = 4.0"), 19, "front_end_mhz = 1.5");
  text += "second_frequency = \"L5\"\nsecond_frequency_source = \"a dream\"\n";
  EXPECT_EQ(
      refusal(text),
      "mine.toml: mask_deg: is missing, and so are smoothing_s_source; contradictory: second_frequency with mode "
      "= \"single\"; contradictory: front_end_mhz = 1.5 with the main lobes of G, 2.046 MHz, expected every figure "
      "of a receiver, each with its source or \"assumed\"");
  EXPECT_EQ(refusal(changed("m8", "integration_ms = 20.0", "integration_ms = 40.0") + "carrier_lop_hz = 3\n"),
            "mine.toml:114: carrier_lop_hz: is not a figure of a receiver, expected \"carrier_loop_hz\"?");
  EXPECT_EQ(refusal(changed("phone", "integration_ms = 20.0", "integration_ms = 40.0")),
            "mine.toml:49: carrier_loop_hz: contradictory: carrier_loop_hz = 15 with integration_ms = 40, expected "
            "figures of one receiver");
}

// 2026-11-29: a misspelt key, or a value out of range, was told alone, and all else only when it was right.
TEST(ReceiverCatalogue, WhatIsMisspeltOrOutOfRangeIsToldWithAllElse) {
  std::string text = changed("m8", "mask_deg = 5.0", "mask_deg = 95.0");
  EXPECT_EQ(refusal(text), "mine.toml:13: mask_deg: 95 is out of range, expected a number from 0 to 60");
  const auto exchange = [&text](const std::string& word, const std::string& by) {
    const auto at = text.find(word);
    ASSERT_NE(at, std::string::npos) << word;
    text.replace(at, word.size(), by);
  };
  exchange("max_gdop = ", "max_gdp = ");
  exchange("estimator = \"kalman\"", "estimator = \"particles\"");
  text += "colour = \"red\"\nsecond_frequency = \"L5\"\nsecond_frequency_source = \"a dream\"\n";
  EXPECT_EQ(
      refusal(text),
      "mine.toml:13: mask_deg: 95 is out of range (expected a number from 0 to 60); line 67: estimator: unknown "
      "name \"particles\" (expected one of \"least_squares\", \"kalman\"); line 88: max_gdp: is not a figure of a "
      "receiver (expected \"max_gdop\"?); line 114: colour: is not a figure of a receiver (expected one of those "
      "that docs/gnss.md lists); missing: max_gdop; contradictory: second_frequency with mode = \"single\", "
      "expected every figure of a receiver, each with its source or \"assumed\"");
  EXPECT_EQ(refusal(changed("m8", "name = \"m8\"", "name = 3")), "mine.toml:1: name: found integer 3, expected a text");
  // What could not be read contradicts nothing: 60 ms would contradict the loop of 15 Hz.
  EXPECT_EQ(refusal(changed("phone", "integration_ms = 20.0", "integration_ms = 60.0")),
            "mine.toml:52: integration_ms: 60 is out of range, expected a number from 1 to 40");
}

/// Every figure that a sheet must or may have, out of what is missing of sheets that say as little as they can.
std::set<std::string> all_figures() {
  std::set<std::string> out;
  for (const std::string mode : {"single", "dual", "dgps", "dgps_base"}) {
    const auto sheet = parse_receiver("name = \"n\"\ndescription = \"d\"\nmode = \"" + mode +
                                          "\"\nantenna = \"sine\"\nestimator = \"kalman\"\nraim = \"greedy\"\n"
                                          "reported_covariance = \"environment\"\n",
                                      "little.toml");
    EXPECT_FALSE(sheet.ok());
    if (sheet) continue;
    out.insert(sheet.error().key);
    const std::string before = "is missing, and so are ";
    EXPECT_TRUE(sheet.error().what.starts_with(before)) << sheet.error().what;
    std::istringstream words(sheet.error().what.substr(before.size()));
    const std::string source = "_source";  // of those that the sheet has
    for (std::string word; words >> word;) {
      if (word.ends_with(',')) word.pop_back();
      out.insert(word.ends_with(source) ? word.substr(0, word.size() - source.size()) : word);
    }
  }
  return out;
}

/// Words in backquotes of a table of docs/gnss.md that look like keys.
std::set<std::string> keys_in_table(const std::string& heading) {
  std::set<std::string> out;
  const auto page = read_text_file(CANYON_SOURCE_DIR "/docs/gnss.md");
  EXPECT_TRUE(page.ok()) << page.error().str();
  if (!page) return out;
  const auto at = page->find(heading);
  EXPECT_NE(at, std::string::npos) << heading;
  if (at == std::string::npos) return out;
  std::istringstream lines(page->substr(at));
  for (std::string line; std::getline(lines, line) && line.starts_with("|");) {
    std::istringstream parts(line);
    std::string part;
    for (int i = 0; std::getline(parts, part, '`'); ++i)
      if (i % 2 == 1 && part.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos)
        out.insert(part);
  }
  return out;
}

// An unknown figure sends its reader to docs/gnss.md, which lists what a sheet takes, and no more.
TEST(ReceiverCatalogue, ThePageListsEveryFigure) {
  const std::set<std::string> figures = all_figures();
  EXPECT_GT(figures.size(), 40u);
  EXPECT_EQ(keys_in_table("| where | figures of a receiver's file |"), figures);
}

TEST(ReceiverCatalogue, AnUnknownReceiverNamesTheNearest) {
  const auto sheet = load_receiver("f9");
  ASSERT_FALSE(sheet.ok());
  EXPECT_EQ(sheet.error().str(), "gnss.receiver: no receiver \"f9\" in the catalogue, expected \"f9p\"?");
}

TEST(ReceiverCatalogue, FiguresGiveWayToWhatStandsBesideTheNameAndReplaceWhatStandsBelow) {
  auto tree = *ConfigNode::parse("[gnss]\nsmoothing_s = 7.0\nmask_deg = 20.0\nrate_hz = 4.0\n", "below.toml");
  const auto over = *ConfigNode::parse("[gnss]\nreceiver = \"f9p\"\nmask_deg = 12.0\n", "m.toml");
  ASSERT_TRUE(lay_with_receiver(tree, over).ok());
  GnssConfig c;
  ASSERT_TRUE(read_config(tree.find("gnss"), "gnss", c).ok());
  EXPECT_EQ(c.position.smoothing_s, 30.0);
  EXPECT_EQ(c.mask_deg, 12.0);
  EXPECT_EQ(c.rate_hz, 4.0);
  EXPECT_EQ(c.satellites.systems, "GREC");
  EXPECT_EQ(c.receiver, "f9p");
}

}  // namespace
}  // namespace canyon::gnss
