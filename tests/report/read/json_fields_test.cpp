#include "canyon/report/read/json_fields.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace canyon::report {
namespace {

TEST(JsonFile, RemembersLines) {
  const auto file = JsonFile::parse("{\n \"b\": [\n  2,\n  3\n ],\n \"a\": 1,\n \"c\": {\"d\": null}\n}", "f.json");
  ASSERT_TRUE(file.ok());
  const JsonNode& root = file->root();
  EXPECT_EQ(file->line_of(root), 1);
  EXPECT_EQ(file->line_of(root["b"]), 2);
  EXPECT_EQ(file->line_of(root["b"][0]), 3);
  EXPECT_EQ(file->line_of(root["b"][1]), 4);  // the lexer has read the line feed after it
  EXPECT_EQ(file->line_of(root["a"]), 6);
  EXPECT_EQ(file->line_of(root["c"]["d"]), 7);
  EXPECT_EQ(file->line_of(JsonNode()), 0);
}

TEST(JsonFile, NoKeyComesTwice) {
  EXPECT_EQ(JsonFile::parse("{\"a\": 1,\n\"a\": 2}", "f.json").error().str(),
            "f.json:2: a: key given twice, expected each key once");
}

TEST(JsonFields, KeepsTheDigitsOfIntegers) {
  const auto root = JsonFile::parse("{\"seed\": 18446744073709551615, \"x\": 1.5}", "f.json");
  std::optional<Error> error;
  const JsonFields fields(&root->root(), *root, "", error);
  EXPECT_EQ(fields.digits("seed"), "18446744073709551615");
  EXPECT_EQ(fields.digits("x"), "");
  EXPECT_EQ(error->str(), "f.json:1: x: number 1.50000, expected an integer or null");
}

TEST(JsonFields, ReadsWhatIsThereAndTakesNullForUndefined) {
  const auto root = JsonFile::parse("{\"n\": 2.5, \"s\": \"x\", \"t\": true, \"z\": null, \"v\": [1, null]}", "f.json");
  std::optional<Error> error;
  const JsonFields fields(&root->root(), *root, "", error);
  EXPECT_EQ(fields.number("n"), 2.5);
  EXPECT_EQ(fields.text("s"), "x");
  EXPECT_TRUE(fields.flag("t"));
  EXPECT_TRUE(std::isnan(fields.number("z")));
  EXPECT_TRUE(std::isnan(fields.number("missing")));
  EXPECT_EQ(fields.text("missing"), "");
  EXPECT_EQ(fields.numbers("v", 2)[0], 1);
  EXPECT_TRUE(std::isnan(fields.numbers("v", 2)[1]));
  EXPECT_TRUE(std::isnan(fields.object("missing").number("deeper")));
  EXPECT_FALSE(error.has_value());
}

TEST(JsonFields, KeepsTheFirstMistake) {
  const auto root = JsonFile::parse("{\"o\": {\n\"n\": \"x\",\n\"s\": 3}}", "f.json");
  std::optional<Error> error;
  const JsonFields fields = JsonFields(&root->root(), *root, "", error).object("o");
  EXPECT_TRUE(std::isnan(fields.number("n")));
  EXPECT_EQ(fields.text("s"), "");
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->str(), "f.json:2: o.n: string \"x\", expected a number or null");
}

TEST(JsonFields, RequiredFieldsMustBeThere) {
  const auto root = JsonFile::parse("{\n\"a\": null}", "f.json");
  std::optional<Error> missing, null;
  JsonFields(&root->root(), *root, "", missing).required_text("b");
  EXPECT_EQ(missing->str(), "f.json:1: b: missing, expected a string");
  JsonFields(&root->root(), *root, "", null).required_number("a");
  EXPECT_EQ(null->str(), "f.json:2: a: null, expected a number");
}

}  // namespace
}  // namespace canyon::report
