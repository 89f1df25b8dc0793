#pragma once

#include <any>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/core/config/config.h"
#include "canyon/core/model_table.h"

namespace canyon {

/// Structs of parameters, at most one of each type, by type; a copy is independent. Each has defaults and its
/// visit(FieldVisitor&, P&), which stand in the file of the model that takes them.
class ModelParameters {
 public:
  /// Adds a P with its defaults, if none is there. A row names this of its own struct: add<P>, or a function that calls
  /// it where P is known in the model's file only.
  template <class P>
  void add() {
    if (find<P>() == nullptr) held_.push_back({P{}, [](FieldVisitor& f, std::any& p) { visit(f, *as<P>(p)); }});
  }
  /// Throws ProgramError for a type that no row of the table has added.
  template <class P>
  P& get() {
    P* p = find<P>();
    CANYON_CHECK(p != nullptr, "no such parameters in this table");
    return *p;
  }
  template <class P>
  const P& get() const {
    return const_cast<ModelParameters*>(this)->get<P>();
  }
  /// All of them as fields of one section, in the order in which they were added.
  void visit_all(FieldVisitor& f) {
    for (Held& held : held_) held.visit_fields(f, held.value);
  }

 private:
  struct Held {
    std::any value;
    void (*visit_fields)(FieldVisitor&, std::any&);
  };
  template <class P>
  static P* as(std::any& value) {
    return std::any_cast<P>(&value);
  }
  template <class P>
  P* find() {
    for (Held& held : held_)
      if (P* p = as<P>(held.value)) return p;
    return nullptr;
  }

  std::vector<Held> held_;
};

/// As a row's `parameters`: the struct P.
template <class P>
void parameters_of(ModelParameters& section) {
  section.add<P>();
}

/// As a row's maker: Make, a model's that has no keys of its own.
template <auto Make, class... At>
auto without_keys(const ModelParameters&, const At&... at) {
  return Make(at...);
}

template <class T>
struct AsResult {
  using type = Result<T>;
};
template <class T>
struct AsResult<Result<T>> {
  using type = Result<T>;
};

/// What a configuration says of one effect: the name of a row, and the parameters of all rows of that table, whichever
/// is chosen, so that a key is known and keeps its value when another model is laid over it. `Rows` is the function
/// that gives the table.
template <auto Rows>
class ModelChoice {
 public:
  explicit ModelChoice(std::string row_name) : name(std::move(row_name)) {
    for (const auto& row : Rows())
      if (row.parameters != nullptr) row.parameters(own);
  }

  std::string name;
  ModelParameters own;

  /// The row; an Error of `key` that names the nearest.
  auto row(const char* key) const { return choose(Rows(), name, key); }
  /// Builds the model; the maker takes the parameters of its table, then `at`.
  template <class... At>
  auto make(const char* key, const At&... at) const ->
      typename AsResult<decltype(Rows().front().make(own, at...))>::type {
    const auto chosen = row(key);
    if (!chosen) return chosen.error();
    return (*chosen)->make(own, at...);
  }
};

/// The key itself, then those of the models.
template <auto Rows>
void visit_choice(FieldVisitor& f, const char* key, ModelChoice<Rows>& c, const char* doc) {
  f.choice(key, c.name, model_names(Rows()), doc);
  c.own.visit_all(f);
}

}  // namespace canyon
