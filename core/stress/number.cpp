#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"

namespace canyon {

namespace {

struct OneNumber {
  double x = 1.0;
  std::int64_t n = 1;
};
void visit(FieldVisitor& f, OneNumber& c) {
  f.number("x", c.x, {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()}, "any");
  f.integer("n", c.n, {-9.0e18, 9.0e18}, "any");
}

bool read(const std::string& toml, OneNumber& number) {
  const auto node = ConfigNode::parse(toml + "\n", "stress.toml");
  return node.ok() && read_config(&*node, "", number).ok();
}

StressFigure refused_numbers() {
  int passed = 0;
  for (const char* line : {"x = nan", "x = -nan", "x = inf", "x = +inf", "x = -inf", "x = 1e999", "x = \"1\"",
                           "n = 1e3", "n = nan", "n = 9223372036854775808", "n = 1.5", "x = 0x1p3", "x = 1,5"}) {
    OneNumber number;
    passed += read(line, number) ? 1 : 0;
  }
  return {1.0 * passed, 0.0};
}

/// Ends of the range of double: read to the bit.
StressFigure read_numbers() {
  int wrong = 0;
  const std::pair<const char*, double> lines[] = {{"x = 1.7976931348623157e308", 1.7976931348623157e308},
                                                  {"x = -1.7976931348623157e308", -1.7976931348623157e308},
                                                  {"x = 4.9406564584124654e-324", 4.9406564584124654e-324},
                                                  {"x = 2.2250738585072014e-308", 2.2250738585072014e-308},
                                                  {"x = -0.0", -0.0},
                                                  {"x = 9007199254740993", 9007199254740992.0},
                                                  {"x = 0.1", 0.1}};
  for (const auto& [line, value] : lines) {
    OneNumber number;
    wrong += read(line, number) && number.x == value && std::signbit(number.x) == std::signbit(value) ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// Columns of text files: a number of any size, or a refusal; nothing that is not finite.
StressFigure text_columns() {
  LineReader in("stress.txt", "one line\n");
  std::string_view line;
  in.next(line);
  int wrong = 0;
  for (const char* word :
       {"nan", "NaN", "inf", "-inf", "infinity", "1e999", "-1e999", "", "-", "+", "1e", "0x10", "1 2", "1.2.3", "--1"})
    wrong += parse_number(in, word).ok() ? 1 : 0;
  for (const char* word : {"1e308", "-1e308", "0", "-0", "1e-300", ".5", "5.", "1E5"})
    wrong += parse_number(in, word).ok() ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> number_cases() {
  const StressMechanism text{
      StressGroup::kData, "text that reads as no number",
      "\"nan\" and \"1e999\" are numbers to the standard library, and no comparison with a range refuses the first",
      "each is refused, and what a double holds is read to the bit: exact", "lines"};
  StressRows rows;
  rows.of(text).add("number/not_finite_in_a_mission", refused_numbers);
  rows.of(text).add("number/largest_and_smallest_in_a_mission", read_numbers);
  rows.of(text).add("number/not_finite_in_a_table", text_columns);
  return rows.take();
}

}  // namespace canyon
