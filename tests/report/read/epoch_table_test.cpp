#include "canyon/report/read/epoch_table.h"

#include <cmath>

#include <gtest/gtest.h>

namespace canyon::report {
namespace {

const EpochColumns kColumns{{"t_s", "x_m"}, {"status"}};

std::string error_of(std::string_view csv) {
  const auto table = parse_epoch_table(csv, "f.csv", kColumns);
  return table.ok() ? "no error" : table.error().str();
}

TEST(EpochTable, ReadsColumnsByName) {
  const auto table =
      parse_epoch_table("status,more,x_m,t_s\r\nnone,1,,0.5\r\n\"a, \"\"b\"\"\",2,true,1\n", "f.csv", kColumns);
  ASSERT_TRUE(table.ok()) << table.error().str();
  EXPECT_EQ(table->rows, 2u);
  EXPECT_EQ((*table)["t_s"], (std::vector<double>{0.5, 1}));
  EXPECT_TRUE(std::isnan((*table)["x_m"][0]));
  EXPECT_EQ((*table)["x_m"][1], 1);
  EXPECT_EQ(table->text("status"), (std::vector<std::string>{"none", "a, \"b\""}));
}

TEST(EpochTable, MayBeEmpty) {
  const auto table = parse_epoch_table("t_s, x_m, status\n", "f.csv", kColumns);
  ASSERT_TRUE(table.ok());
  EXPECT_EQ(table->rows, 0u);
}

TEST(EpochTable, TellsMistakesByLineAndColumn) {
  EXPECT_EQ(error_of("t_s,status\n"), "f.csv:1: x_m: column missing, expected a column of that name");
  EXPECT_EQ(error_of("t_s,x_m,status\n1,2,a\n2,1.5x,a\n"),
            "f.csv:3: x_m: '1.5x', expected a finite number or an empty field");
  EXPECT_EQ(error_of("t_s,x_m,status\n1,nan,a\n"), "f.csv:2: x_m: 'nan', expected a finite number or an empty field");
  EXPECT_EQ(error_of("t_s,x_m,status\n1,2\n"), "f.csv:2: 2 fields, expected 3 as in the first line");
  EXPECT_EQ(error_of("t_s,x_m,status\n2,0,a\n1,0,a\n"), "f.csv:3: t_s: '1', expected times that do not run backwards");
  EXPECT_EQ(error_of("t_s,x_m,status\n,0,a\n"), "f.csv:2: t_s: '', expected times that do not run backwards");
  EXPECT_EQ(error_of(""), "f.csv:1: t_s: column missing, expected a column of that name");
}

}  // namespace
}  // namespace canyon::report
