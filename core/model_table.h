#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace canyon::gnss {

/// One row of a ladder: a selectable model of one effect. `Make` is the type of the function that builds it.
template <class Make>
struct ModelRow {
  const char* name;
  Make* make;
  const char* doc;
};

template <class Make>
std::vector<std::string> model_names(std::span<const ModelRow<Make>> rows) {
  std::vector<std::string> names;
  for (const auto& row : rows) names.emplace_back(row.name);
  return names;
}

/// The row of that name; nullptr if there is none.
template <class Make>
const ModelRow<Make>* find_model(std::span<const ModelRow<Make>> rows, std::string_view name) {
  for (const auto& row : rows)
    if (name == row.name) return &row;
  return nullptr;
}

}  // namespace canyon::gnss
