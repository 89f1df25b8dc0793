#include "canyon/core/result.h"

#include <memory>

#include <gtest/gtest.h>

namespace canyon {
namespace {

Error example() {
  Error e;
  e.file = "my.toml";
  e.line = 7;
  e.key = "gnss.rate_hz";
  e.what = "500 is out of range";
  e.expected = "a number from 0.1 to 20";
  return e;
}

TEST(Error, TextWithAllParts) {
  EXPECT_EQ(example().str(), "my.toml:7: gnss.rate_hz: 500 is out of range, expected a number from 0.1 to 20");
}

TEST(Error, EmptyPartsAreLeftOut) {
  Error e = example();
  e.line = 0;
  EXPECT_EQ(e.str(), "my.toml: gnss.rate_hz: 500 is out of range, expected a number from 0.1 to 20");
  e.key.clear();
  EXPECT_EQ(e.str(), "my.toml: 500 is out of range, expected a number from 0.1 to 20");
  e.file.clear();
  e.line = 3;  // a line without a file says nothing
  EXPECT_EQ(e.str(), "500 is out of range, expected a number from 0.1 to 20");
  e.expected.clear();
  EXPECT_EQ(e.str(), "500 is out of range");
  EXPECT_EQ(e.exit_code, 2);
}

Result<std::unique_ptr<int>> make(bool good) {
  if (!good) return example();
  return std::make_unique<int>(5);
}

Result<int> twice(bool good) {
  CANYON_TRY(const auto value, make(good));
  return 2 * *value;
}

Status only_status(bool good) {
  CANYON_TRY_STATUS(twice(good));
  return Ok{};
}

// 2026-11-22: a damaged mission named a scene file of 100,000 brackets, and all of them were printed.
TEST(Error, AFileNameThatNoFileCanHaveIsShortened) {
  const auto text = [](std::size_t length) { return Error{.file = std::string(length, '['), .what = "missing"}.str(); };
  EXPECT_EQ(text(4096), std::string(4096, '[') + ": missing");
  EXPECT_EQ(text(100000), std::string(60, '[') + "..." + std::string(40, '[') + ": missing");
}

TEST(Result, TryPassesValuesAndErrorsOn) {
  ASSERT_TRUE(twice(true).ok());
  EXPECT_EQ(*twice(true), 10);
  ASSERT_FALSE(twice(false).ok());
  EXPECT_EQ(twice(false).error().str(), example().str());
  EXPECT_TRUE(only_status(true).ok());
  EXPECT_EQ(only_status(false).error().line, 7);
}

TEST(Result, AccessToTheMissingOneThrowsAndTells) {
  const Result<int> good(3);
  EXPECT_THROW((void)good.error(), ProgramError);
  const Result<int> bad(example());
  try {
    (void)*bad;
    FAIL() << "no exception";
  } catch (const ProgramError& e) {
    EXPECT_NE(std::string(e.what()).find("my.toml:7: gnss.rate_hz"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace canyon
