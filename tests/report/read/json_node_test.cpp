#include "canyon/report/read/json_node.h"

#include <cmath>

#include <gtest/gtest.h>

namespace canyon::report {
namespace {

std::string error_of(std::string_view text) {
  const auto node = parse_json(text, "f.json");
  return node.ok() ? "no error" : node.error().str();
}

TEST(JsonNode, RemembersLines) {
  const auto root = parse_json("{\n \"a\": 1,\n \"b\": [\n  2,\n  3\n ],\n \"c\": {\"d\": null}\n}", "f.json");
  ASSERT_TRUE(root.ok());
  EXPECT_EQ(root->line, 1);
  EXPECT_EQ(root->find("a")->line, 2);
  EXPECT_EQ(root->find("b")->line, 3);
  EXPECT_EQ((*root->find("b")->array())[0].line, 4);
  EXPECT_EQ((*root->find("b")->array())[1].line, 5);  // the lexer has read the line feed after it
  EXPECT_EQ(root->find("c")->find("d")->line, 7);
  EXPECT_EQ(root->find("x"), nullptr);
}

TEST(JsonNode, KeepsTheDigitsOfIntegers) {
  const auto root = parse_json("{\"seed\": 18446744073709551615, \"x\": 1.5}", "f.json");
  ASSERT_TRUE(root.ok());
  EXPECT_EQ(root->find("seed")->text, "18446744073709551615");
  EXPECT_EQ(root->find("x")->text, "");
}

TEST(JsonNode, TellsWhereTheTextIsNoJson) {
  EXPECT_EQ(error_of("{\"a\": 1,\n\"b\": }"), "f.json:2: not JSON near '\"b\": }', expected a JSON value");
  EXPECT_EQ(error_of("{\n\"a\": [1, 2"), "f.json:2: the JSON text ends too early, expected a complete JSON value");
  EXPECT_EQ(error_of(""), "f.json:1: the JSON text ends too early, expected a complete JSON value");
  EXPECT_EQ(error_of("{\"a\": NaN}"), "f.json:1: not JSON near '\"a\": N', expected a JSON value");
  EXPECT_EQ(error_of("{\"a\": 1,\n\"a\": 2}"), "f.json:2: a: key given twice, expected each key once");
  EXPECT_EQ(error_of(std::string(200, '[')), "f.json:1: nested more than 100 deep, expected a results file of Canyon");
}

TEST(JsonFields, ReadsWhatIsThereAndTakesNullForUndefined) {
  const auto root = parse_json("{\"n\": 2.5, \"s\": \"x\", \"t\": true, \"z\": null, \"v\": [1, null]}", "f.json");
  std::optional<Error> error;
  const JsonFields fields(&*root, "f.json", "", error);
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
  const auto root = parse_json("{\"o\": {\n\"n\": \"x\",\n\"s\": 3}}", "f.json");
  std::optional<Error> error;
  const JsonFields fields = JsonFields(&*root, "f.json", "", error).object("o");
  EXPECT_TRUE(std::isnan(fields.number("n")));
  EXPECT_EQ(fields.text("s"), "");
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->str(), "f.json:2: o.n: string \"x\", expected a number or null");
}

TEST(JsonFields, RequiredFieldsMustBeThere) {
  const auto root = parse_json("{\n\"a\": null}", "f.json");
  std::optional<Error> missing, null;
  JsonFields(&*root, "f.json", "", missing).required_text("b");
  EXPECT_EQ(missing->str(), "f.json:1: b: missing, expected a string");
  JsonFields(&*root, "f.json", "", null).required_number("a");
  EXPECT_EQ(null->str(), "f.json:2: a: null, expected a number");
}

}  // namespace
}  // namespace canyon::report
