// What ladders.toml says, against the configuration and the tables of models.
#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/gnss/paths/path_model.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/mission/config/mission_file.h"
#include "canyon/study/tradeoff/ladders/rungs.h"
#include "canyon/study/tradeoff/probes/probe.h"

namespace canyon::study {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

std::vector<std::string> names_of(const RungList& list) {
  std::vector<std::string> names;
  for (const Rung& rung : list.rungs) names.push_back(rung.name);
  for (const LeftOut& one : list.left_out) names.push_back(one.name);
  return names;
}

const Ladder& ladder_of(const std::string& key) {
  for (const Ladder& ladder : built_in_ladders().ladder)
    if (ladder.key == key) return ladder;
  throw std::runtime_error("no ladder " + key);
}

TEST(Ladders, EveryChoiceIsALadderOrHasItsReason) {
  mission::MissionConfig config;
  std::set<std::string> choices;
  for (const ConfigKey& key : config_keys_of(config))
    if (!key.choices.empty()) choices.insert(key.key);
  EXPECT_GT(choices.size(), 30u);
  std::set<std::string> told;
  for (const Ladder& ladder : built_in_ladders().ladder)
    for (const std::string& key : {ladder.key, ladder.for_each})
      if (choices.contains(key)) told.insert(key);
  for (const NoLadder& none : built_in_ladders().no_ladder) {
    EXPECT_TRUE(told.insert(none.key).second) << none.key << " is a ladder too, or stands there twice";
    EXPECT_TRUE(choices.contains(none.key)) << none.key << " is no choice";
    EXPECT_GT(none.reason.size(), 10u) << none.key;
  }
  for (const std::string& key : choices) EXPECT_TRUE(told.contains(key)) << key << " is neither";
}

TEST(Ladders, EveryLadderHasItsKeyAndItsProbe) {
  mission::MissionConfig config;
  const auto mission_keys = config_keys_of(config);
  const auto own_keys = probe_keys();
  for (const Ladder& ladder : built_in_ladders().ladder) {
    const bool list = ladder.key == "imu.leave_out";
    EXPECT_TRUE(list || find_key(mission_keys, ladder.key) || find_key(own_keys, ladder.key)) << ladder.key;
    EXPECT_NE(find_model(probes(), ladder.probe), nullptr) << ladder.key << ": " << ladder.probe;
    EXPECT_NE(ladder.rungs.empty(), ladder.values.empty()) << ladder.key << ": rungs or values, one of them";
    const bool truth = ladder.reference == kTruth;
    EXPECT_TRUE(!truth || model_row(probes(), ladder.probe).make.knows_truth) << ladder.key;
  }
}

TEST(Ladders, AreAtLeastTwentyFourInAllParts) {
  const auto file = mission::MissionFile::load("");
  std::size_t lists = 0;
  std::set<std::string> parts;
  for (const Ladder& ladder : built_in_ladders().ladder) {
    const auto made = make_rungs(ladder, *file, "high", probe_keys());
    ASSERT_TRUE(made) << ladder.key << ": " << made.error().str();
    lists += made->size();
    parts.insert(ladder.part);
    for (const RungList& list : *made) EXPECT_GE(list.rungs.size(), 2u) << ladder.key;
  }
  EXPECT_GE(built_in_ladders().ladder.size(), 24u);
  EXPECT_GE(lists, built_in_ladders().ladder.size());
  EXPECT_EQ(parts.size(), tradeoff_parts().size());
}

TEST(Ladders, RowsAreThoseOfTheKeysOwnTable) {
  const auto file = mission::MissionFile::load("");
  const auto paths = make_rungs(ladder_of("gnss.paths"), *file, "high", probe_keys());
  ASSERT_TRUE(paths) << paths.error().str();
  EXPECT_THAT(names_of(paths->front()), ElementsAreArray(model_names(gnss::path_models())));
  const RungList& list = paths->front();
  EXPECT_EQ(list.rungs.at(*list.reference).name, "specular3");
  for (const Rung& rung : list.rungs) {
    EXPECT_EQ(rung.config.gnss.propagation.paths.name, rung.name);
    EXPECT_EQ(rung.config.gnss.propagation.diffraction.name, "none");  // fixed
    EXPECT_EQ(rung.in_use, rung.name == "specular2");                  // of high
  }
  const auto links = make_rungs(ladder_of("imu.leave_out"), *file, "high", probe_keys());
  ASSERT_TRUE(links) << links.error().str();
  EXPECT_EQ(links->front().rungs.size(), inertial::error_links().size() + 1);
  EXPECT_TRUE(links->front().rungs.front().config.imu.leave_out.empty());
  EXPECT_EQ(links->front().rungs.back().name, "without " + links->front().rungs.back().config.imu.leave_out.at(0));
}

TEST(Ladders, TheMissionsOwnNumberStandsAmongTheRungs) {
  const auto file = mission::MissionFile::parse("base = \"vicksburg\"\n[registration]\nleaf_m = 0.7\n", "m.toml");
  const auto made = make_rungs(ladder_of("registration.leaf_m"), *file, "high", probe_keys());
  ASSERT_TRUE(made) << made.error().str();
  EXPECT_THAT(names_of(made->front()), ElementsAreArray({"2", "1", "0.7", "0.5", "0.25"}));
  EXPECT_TRUE(made->front().rungs.at(2).in_use);
}

TEST(Ladders, AMistakeInTheDataIsTold) {
  const auto unknown = parse_ladders("[[ladder]]\npart = \"gnss\"\nrung = [\"rows\"]\n", "ladders.toml");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().str(), HasSubstr("ladders.toml:3"));
  EXPECT_THAT(unknown.error().str(), HasSubstr("rungs"));
}

}  // namespace
}  // namespace canyon::study
