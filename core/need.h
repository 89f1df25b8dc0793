#pragma once

#include <string>
#include <utility>

namespace canyon {

/// Whether what a model computes is needed where it was asked.
enum class Verdict {
  kNeeded,      ///< it acts, or somebody reads it
  kNotNeeded,   ///< leaving it out moves what was asked for by `bound` at most
  kUndecidable  ///< neither could be shown: it is kept
};
inline const char* name(Verdict verdict) {
  return verdict == Verdict::kNeeded ? "needed" : verdict == Verdict::kNotNeeded ? "not_needed" : "undecidable";
}

/// What a model says of one of its effects, for a piece of a route (core/motion/route_segment.h) or for a whole run.
struct Need {
  std::string effect{};  ///< "reflection off two walls": the same words wherever that effect is spoken of
  Verdict verdict = Verdict::kUndecidable;
  double bound = 0.0;        ///< of a kNotNeeded: how far leaving it out moves its own figure at most; 0 = not a bit
  std::string bound_unit{};  ///< of the bound, "m"
  std::string reason{};      ///< in words, with the numbers that decided
};

/// As the `Make` of a table (core/model_table.h) whose models can say where they are needed: a row's maker, and beside
/// it the function that states its needs. A row that names a maker alone says nothing: its effects are kUndecidable,
/// and kept, so that a new model is one file and one row as in any other table.
template <class Make, class State>
struct MakerAndNeed;

template <class Model, class... At, class State>
struct MakerAndNeed<Model(At...), State> {
  Model (*make)(At...);
  State* need = nullptr;

  constexpr MakerAndNeed(Model (*maker)(At...), State* state = nullptr)  // NOLINT: implicit by intent
      : make(maker), need(state) {}
  Model operator()(At... at) const { return make(std::forward<At>(at)...); }
};

}  // namespace canyon
