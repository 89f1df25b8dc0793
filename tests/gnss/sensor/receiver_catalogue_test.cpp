#include "canyon/gnss/sensor/receiver_catalogue.h"

#include <gtest/gtest.h>

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
