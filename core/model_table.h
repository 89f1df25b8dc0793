#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/core/result.h"

namespace canyon {

class ModelParameters;

/// One row of a table: a selectable model of one effect, or one value of an enumeration with its name. `Make` is the
/// type of the function that builds the model, else of the value itself; what a table knows of its models beside the
/// columns here is part of that type.
template <class Make>
struct ModelRow {
  using Maker = std::conditional_t<std::is_function_v<Make>, Make*, Make>;

  const char* name;
  Maker make;
  const char* doc;
  /// Adds what the model is told beside what all of its table are: its own struct of keys (core/model_choice.h).
  void (*parameters)(ModelParameters&) = nullptr;
  std::optional<double> order{};  ///< theoretical order of the error in the step; none: no error, or no step
};

/// All models of one effect, or all values of an enumeration.
template <class Make>
using ModelTable = std::span<const ModelRow<Make>>;

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

/// key: unknown name "iri", expected one of "none", ...; nearest is "ionex". For whatever is chosen by a name.
Error unknown_name(std::string key, std::string_view name, const std::vector<std::string>& known);

/// The row that a user names; the Error is that of `key`, a key or an option.
template <class Make>
Result<const ModelRow<Make>*> choose(std::span<const ModelRow<Make>> rows, std::string_view name, std::string key) {
  if (const auto* row = find_model(rows, name)) return row;
  return unknown_name(std::move(key), name, model_names(rows));
}

/// The row of a name that has been checked; throws ProgramError for one that is not in the table.
template <class Make>
const ModelRow<Make>& model_row(std::span<const ModelRow<Make>> rows, std::string_view name) {
  const auto* row = find_model(rows, name);
  CANYON_CHECK(row != nullptr, "no model of the name \"", name, "\"");
  return *row;
}

/// The row of an enumeration's value.
template <class Value>
const ModelRow<Value>& row_of(std::span<const ModelRow<Value>> rows, std::type_identity_t<Value> value) {
  for (const auto& row : rows)
    if (row.make == value) return row;
  CANYON_CHECK(false, "a value without a row");
  return rows.front();
}

/// "which way: first = the nearest; last = the farthest", for the documentation of a key.
template <class Make>
std::string with_rows(std::string doc, std::span<const ModelRow<Make>> rows) {
  const char* apart = ": ";
  for (const auto& row : rows) {
    doc.append(apart).append(row.name).append(" = ").append(row.doc);
    apart = "; ";
  }
  return doc;
}

}  // namespace canyon
