#include "canyon/core/files/json_text.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace canyon {
namespace {

std::string json_error_of(std::string_view text, const JsonReading& reading = {}) {
  const auto tree = parse_json(text, "f.json", reading);
  return tree.ok() ? "no error" : tree.error().str();
}

TEST(JsonText, IsTheTreeThatItsLibraryMakes) {
  const char* text =
      "{\"b\": [1, -2, 1.5e3, true, null, {}], \"a\": {\"c\": \"\\u00e9\"}, \"d\": 18446744073709551615}";
  const auto tree = parse_json(text, "f.json");
  ASSERT_TRUE(tree.ok()) << tree.error().str();
  EXPECT_EQ(*tree, nlohmann::json::parse(text));
  const auto ordered = parse_ordered_json(text, "f.json");
  ASSERT_TRUE(ordered.ok());
  EXPECT_EQ(ordered->dump(), nlohmann::ordered_json::parse(text).dump());
}

// 2026-11-22: a file's name that is no UTF-8 ended the program where it was written to a summary or a tape.
TEST(JsonText, WhatIsNoUtf8IsReplaced) {
  const nlohmann::ordered_json tree{{"file", "d\xff.tum"}, {"n", 1}};
  EXPECT_EQ(json_text(tree), "{\"file\":\"d\xef\xbf\xbd.tum\",\"n\":1}");
  EXPECT_EQ(json_text(nlohmann::json(tree), 1), "{\n \"file\": \"d\xef\xbf\xbd.tum\",\n \"n\": 1\n}");
}

TEST(JsonText, TellsTheLineOfEveryValue) {
  std::vector<int> lines;
  ASSERT_TRUE(
      parse_ordered_json("{\n \"b\": [\n  2,\n  3\n ],\n \"a\": {}}", "f.json", {.first_line = 11, .lines = &lines})
          .ok());
  EXPECT_EQ(lines, (std::vector{11, 12, 13, 14, 16}));
}

TEST(JsonText, TellsWhereMembersBegin) {
  const char* text =
      "{\"x\": {\"list\": [7]},\n\"list\": [\n{\"list\": [1]},\n\n[2]],\n\"o\": {\"a\\\"b\": 1,\n \"c\": {}}}";
  std::vector<JsonMember> members;
  ASSERT_TRUE(parse_json(text, "f.json", {.key = "list", .members = &members}).ok());
  ASSERT_EQ(members.size(), 2u);
  EXPECT_EQ(members[0].line, 3);
  EXPECT_EQ(members[1].line, 5);
  members.clear();
  ASSERT_TRUE(parse_json(text, "f.json", {.key = "o", .members = &members}).ok());
  ASSERT_EQ(members.size(), 2u);
  EXPECT_EQ(members[0].name, "a\"b");
  EXPECT_EQ(members[1].name, "c");
  EXPECT_EQ(members[1].line, 7);
}

TEST(JsonText, OfTheSameKeyTwiceTheLastCounts) {
  const char* text = "{\"a\": [1, 2],\n\"a\": [3]}";
  std::vector<JsonMember> members;
  const auto tree = parse_json(text, "f.json", {.key = "a", .members = &members});
  ASSERT_TRUE(tree.ok());
  EXPECT_EQ(tree->dump(), "{\"a\":[3]}");
  ASSERT_EQ(members.size(), 1u);
  EXPECT_EQ(members[0].line, 2);
  EXPECT_EQ(json_error_of(text, {.same_key_twice = false}), "f.json:2: a: key given twice, expected each key once");
}

TEST(JsonText, TellsWhereTheTextIsNoJson) {
  EXPECT_EQ(json_error_of("{\"a\": 1,\n\"b\": }"), "f.json:2: not JSON near '\"b\": }', expected a JSON value");
  EXPECT_EQ(json_error_of("{\n\"a\": [1, 2"), "f.json:2: the JSON text ends too early, expected a complete JSON value");
  EXPECT_EQ(json_error_of(""), "f.json:1: the JSON text ends too early, expected a complete JSON value");
  EXPECT_EQ(json_error_of("{\"a\": NaN}"), "f.json:1: not JSON near '\"a\": N', expected a JSON value");
  EXPECT_EQ(json_error_of("[1e999]"), "f.json:1: number 1e999, expected one that a double can hold");
  EXPECT_EQ(json_error_of(std::string(100, '[') + std::string(100, ']')), "no error");
  EXPECT_EQ(json_error_of(std::string(101, '[')), "f.json:1: nested more than 100 deep, expected at most 100 levels");
}

}  // namespace
}  // namespace canyon
