#include "canyon/core/model_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/config/config.h"

namespace canyon {
namespace {

using Law = double(double);
double square(double x) {
  return x * x;
}
double cube(double x) {
  return x * x * x;
}
constexpr ModelRow<Law> kLaws[] = {{"square", square, "x^2"}, {"cube", cube, "x^3", nullptr, 3}};
const ModelTable<Law> kTable(kLaws);

enum class Side { kLeft, kRight };
constexpr ModelRow<Side> kSides[] = {{"left", Side::kLeft, "seen from above"}, {"right", Side::kRight, "the other"}};

struct Road {
  Side side = Side::kRight;
  std::optional<double> limit_m_s;
};
void visit(FieldVisitor& f, Road& c) {
  f.old_key("speed_kmh", "road.limit_m_s, in m/s");
  f.choice("side", c.side, ModelTable<Side>(kSides), "where one drives");
  f.optional_number("limit_m_s", c.limit_m_s, -1.0, {0.0, 100.0}, "largest speed; -1 = none");
}

Result<Road> road_of(const std::string& toml) {
  CANYON_TRY(const ConfigNode node, ConfigNode::parse(toml, "my.toml"));
  Road road;
  CANYON_TRY_STATUS(read_config(&node, "road", road));
  return road;
}

TEST(ModelTable, AChoiceGivesTheRow) {
  const auto row = choose(kTable, "cube", "law");
  ASSERT_TRUE(row.ok());
  EXPECT_EQ((*row)->make(2.0), 8.0);
  EXPECT_EQ((*row)->order, 3.0);
  EXPECT_EQ(model_row(kTable, "square").make(3.0), 9.0);
  EXPECT_FALSE(model_row(kTable, "square").order.has_value());
  EXPECT_THAT(model_names(kTable), ::testing::ElementsAre("square", "cube"));
  EXPECT_EQ(with_rows("which law", kTable), "which law: square = x^2; cube = x^3");
}

TEST(ModelTable, AnUnknownNameIsOneMessageThatNamesTheNearest) {
  EXPECT_EQ(choose(kTable, "qube", "law").error().str(),
            "law: unknown name \"qube\", expected one of \"square\", \"cube\"; nearest is \"cube\"");
  EXPECT_EQ(choose(kTable, "exponential", "--law").error().str(),
            "--law: unknown name \"exponential\", expected one of \"square\", \"cube\"");
  EXPECT_THROW((void)model_row(kTable, "qube"), ProgramError);
  // A file's mistake reads the same, with its place before it.
  EXPECT_EQ(road_of("side = \"rihgt\"").error().str(),
            "my.toml:1: road.side: unknown name \"rihgt\", expected one of \"left\", \"right\"; nearest is \"right\"");
}

TEST(ModelTable, AChoiceIsAnEnumerationAfterTheReader) {
  EXPECT_EQ(road_of("")->side, Side::kRight);
  EXPECT_EQ(road_of("side = \"left\"")->side, Side::kLeft);
  Road left{.side = Side::kLeft, .limit_m_s = {}};
  EXPECT_EQ(fields_as_json([&](FieldVisitor& f) { visit(f, left); }), R"({"side":"left","limit_m_s":-1.0})");
}

TEST(ModelTable, ANumberThatIsNotSetIsNone) {
  EXPECT_FALSE(road_of("")->limit_m_s.has_value());
  EXPECT_FALSE(road_of("limit_m_s = -1")->limit_m_s.has_value());
  EXPECT_EQ(road_of("limit_m_s = 0")->limit_m_s, 0.0);
  for (const std::string other : {"-0.5", "-2", "101"})
    EXPECT_EQ(road_of("limit_m_s = " + other).error().str(),
              "my.toml:1: road.limit_m_s: " + other + " is out of range, expected a number from 0 to 100, or -1");
}

TEST(ModelTable, AnOldKeyNamesWhatTookItsPlace) {
  EXPECT_EQ(road_of("side = \"left\"\nspeed_kmh = 50").error().str(),
            "my.toml:2: road.speed_kmh: is a key of an earlier version, expected road.limit_m_s, in m/s");
}

}  // namespace
}  // namespace canyon
