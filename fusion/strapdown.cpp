#include "canyon/fusion/strapdown.h"

#include "canyon/fusion/strapdown/models.h"

namespace canyon::fusion {
namespace {

constexpr StrapdownRow kRows[] = {
    {"euler",
     {make_euler, 1, 2, earth_rate_alone},
     "increments as they are: no coning, no sculling, no rotation of the force within the interval",
     nullptr,
     1},
    {"trapezoid",
     {make_trapezoid, 2, 2, earth_rate_alone},
     "the force turned with the mean of the attitudes at both ends; no coning",
     nullptr,
     2},
    {"constant_rate",
     {make_constant_rate, 2, 2, earth_rate_alone},
     "exact where rate and force are constant in the body, at any angle per interval; no coning",
     nullptr,
     2},
    {"two_sample",
     {make_two_sample, 3, 3, two_sample_effects},
     "coning and sculling from the previous and the present increments",
     nullptr,
     2},
    {"three_sample",
     {make_three_sample, 4, 4},
     "coning, sculling and position from the last three increments, gravity and Coriolis to matching order",
     nullptr,
     4},
};

}  // namespace

ModelTable<StrapdownModel> strapdown_models() {
  return kRows;
}

std::unique_ptr<Strapdown> make_strapdown(std::string_view name, GravityFunction gravity) {
  return model_row(strapdown_models(), name).make.make(gravity);
}

}  // namespace canyon::fusion
