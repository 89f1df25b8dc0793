#include "canyon/fusion/strapdown.h"

#include "canyon/core/check.h"
#include "canyon/fusion/strapdown/models.h"

namespace canyon::fusion {
namespace {

constexpr StrapdownRow kRows[] = {
    {"euler", make_euler, 1, 1, 2,
     "increments as they are: no coning, no sculling, no rotation of the force within the interval"},
    {"trapezoid", make_trapezoid, 2, 2, 2, "the force turned with the mean of the attitudes at both ends; no coning"},
    {"constant_rate", make_constant_rate, 2, 2, 2,
     "exact where rate and force are constant in the body, at any angle per interval; no coning"},
    {"two_sample", make_two_sample, 2, 3, 3, "coning and sculling from the previous and the present increments"},
    {"three_sample", make_three_sample, 4, 4, 4,
     "coning, sculling and position from the last three increments, gravity and Coriolis to matching order"},
};

}  // namespace

std::span<const StrapdownRow> strapdown_models() {
  return kRows;
}

std::vector<std::string> strapdown_names() {
  std::vector<std::string> names;
  for (const StrapdownRow& row : kRows) names.emplace_back(row.name);
  return names;
}

std::unique_ptr<Strapdown> make_strapdown(std::string_view name, GravityFunction gravity) {
  for (const StrapdownRow& row : kRows) {
    if (name == row.name) return row.make(gravity);
  }
  CANYON_CHECK(false, "no strapdown model \"", name, "\"");
  return nullptr;
}

}  // namespace canyon::fusion
