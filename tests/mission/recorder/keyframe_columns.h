#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/mission/recorder/epoch_files.h"

namespace canyon::mission::testing {

inline std::vector<std::string> cells(std::string_view line, char border = ',') {
  std::vector<std::string> out(1);
  for (const char c : line)
    if (c == border)
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

/// What stands in epochs/RUN_keyframes.csv, by column.
inline std::map<std::string, std::string> keyframe_columns(const KeyframeRow& row, bool registers = true) {
  CsvWriter csv(kKeyframeColumns);
  write(csv, row,
        {.frame = LocalFrame(Geodetic{0.56, -1.58, 60.0}),
         .start = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0),
         .registers = registers});
  const std::string& text = csv.text();
  const std::size_t header = text.find('\n');
  const std::vector<std::string> names = cells(text.substr(0, header)),
                                 values = cells(text.substr(header + 1, text.size() - header - 2));
  EXPECT_EQ(values.size(), names.size()) << text;
  std::map<std::string, std::string> out;
  for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) out[names[i]] = values[i];
  return out;
}

/// The numbers of one field.
inline std::vector<double> numbers_in(const std::string& field) {
  std::vector<double> out;
  for (const std::string& one : cells(field, ' ')) out.push_back(std::stod(one));
  return out;
}

}  // namespace canyon::mission::testing
