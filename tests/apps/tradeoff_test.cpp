// canyon tradeoff through the binary: what it prints and writes, and what is wrong with a call.
#include <cstdio>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "canyon/tests/apps/command_line_fixture.h"

namespace canyon::apps::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// The short drive without a LIDAR, whose scans would be most of the time.
class TradeoffTest : public CommandLineTest {
 protected:
  void SetUp() override {
    CommandLineTest::SetUp();
    write("mission.toml", std::string(kMission) + "[lidar]\nblinded = true\n");
  }
};

TEST_F(TradeoffTest, GivesTheContractsKeysAndTheFilesBeside) {
  ASSERT_EQ(canyon("tradeoff mission.toml --part fusion --samples 4 --out out --json"), 0) << read("stderr");
  const Json out = Json::parse(read("stdout"));
  EXPECT_TRUE(out["chosen"].is_null());
  ASSERT_GE(out["ladders"].size(), 18u);  // the filter's three, and five integrators by three figures
  int observed = 0;
  for (const Json& ladder : out["ladders"]) {
    EXPECT_EQ(ladder["part"], "fusion");
    for (const char* key : {"key", "models", "order_observed", "order_theory", "reference_error"})
      EXPECT_TRUE(ladder.contains(key)) << key;
    if (!ladder["order_theory"].is_null()) {
      ++observed;
      EXPECT_NEAR(ladder["order_observed"].get<double>(), ladder["order_theory"].get<double>(), 0.2);
    }
    for (const Json& model : ladder["models"]) {
      for (const char* key : {"name", "error", "error_unit", "error_sigma", "cpu_s", "cpu_spread_s", "work",
                              "memory_mb", "on_front", "tied_with"})
        EXPECT_TRUE(model.contains(key)) << key;
      EXPECT_GT(model["cpu_s"].get<double>(), 0.0);
      EXPECT_GT(model["work"].get<std::int64_t>(), 0);
    }
  }
  EXPECT_EQ(observed, 15);
  const std::string csv = read("out/tradeoff.csv");
  EXPECT_THAT(csv, HasSubstr("part,key,of,probe,model,error"));
  EXPECT_THAT(csv, HasSubstr("fusion,fusion.integrator,,filter,two_sample,"));
  const std::string page = read("out/report.html");
  EXPECT_THAT(page, HasSubstr("Order observed"));
  EXPECT_THAT(page, HasSubstr("</html>"));
  EXPECT_EQ(page.find("http://"), std::string::npos);
  EXPECT_EQ(page.find("https://"), std::string::npos);
  EXPECT_EQ(Json::parse(read("out/summary.json"))["ladders"].size(), out["ladders"].size());
}

TEST_F(TradeoffTest, FindsTheCheapestSettingsAndWritesThem) {
  ASSERT_EQ(canyon("tradeoff mission.toml --part registration,fusion --tolerance position_error_rms_m=0.5 --validate 2 "
                   "--write answer.toml --out out --json"),
            0)
      << read("stderr");
  const Json chosen = Json::parse(read("stdout"))["chosen"];
  ASSERT_TRUE(chosen["found"].get<bool>());
  EXPECT_LE(chosen["error"].get<double>(), 0.5);
  EXPECT_EQ(chosen["validated_seeds"].size(), 2u);
  EXPECT_EQ(canyon("run answer.toml --fidelity tradeoff --out again"), 0) << read("stderr");
  // 2026-11-22: the answer was appended to itself.
  EXPECT_EQ(canyon("tradeoff answer.toml --fidelity tradeoff --tolerance position_error_rms_m=0.5 --write more.toml"),
            2);
  EXPECT_THAT(read("stderr"), HasSubstr("--write: answer.toml has a fidelity \"tradeoff\" already"));
}

TEST_F(TradeoffTest, WhatIsWrongIsOneLine) {
  expect_mistake("tradeoff --part radar", "--part: unknown name \"radar\", expected one of \"gnss\"");
  expect_mistake("tradeoff --part gnss,gnss", "--part: \"gnss\" stands there twice");
  expect_mistake("tradeoff --tolerance position_error=1",
                 "--tolerance: \"position_error\" is no figure, expected one that canyon keys --figures lists");
  expect_mistake("tradeoff --tolerance position_error_rms_m=0",
                 "--tolerance: position_error_rms_m: \"0\", expected a number above 0");
  expect_mistake("tradeoff --fidelity medium", "--fidelity");
  expect_mistake("tradeoff --write x.toml", "--write: nothing is chosen, expected --tolerance or --budget-cpu");
  expect_mistake("tradeoff --validate 5",
                 "--validate: nothing is chosen, expected --tolerance or --budget-cpu beside it\n");
  expect_mistake("tradeoff --seconds 5",
                 "--seconds: nothing is chosen, expected --tolerance or --budget-cpu beside it\n");
  expect_mistake("tradeoff --tolerance position_error_rms_m=1 --figure gdop_median",
                 "--figure: stands alone, expected --budget-cpu beside it\n");
  expect_mistake("tradeoff --repetitions 4", "--repetitions");
  expect_mistake("tradeoff mission.toml --part fusion,imu --tolerance position_error_rms_m=1e-9 --validate 1",
                 "is below what high itself errs against its finest rungs, expected at least ");
  expect_mistake("tradeoff mission.toml --part fusion --budget-cpu 1e-6 --validate 1",
                 "--budget-cpu: 1e-06 s per simulated s is below the cheapest rungs, expected at least ");
}

}  // namespace
}  // namespace canyon::apps::testing
