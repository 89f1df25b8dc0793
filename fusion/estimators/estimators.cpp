#include "canyon/fusion/estimators/estimator.h"

namespace canyon::fusion {
namespace {

constexpr ModelRow<MakeEstimator> kEstimators[] = {
    {"joseph", make_joseph, "the covariance itself, corrected in Joseph's form"},
    {"ud", make_ud,
     "its factors U D U' (Bierman and Thornton): what rounding cannot make negative, at 3 times the time"},
    {"invariant", make_invariant,
     "Joseph's form of errors that turn with the estimate: attitudes may be far off at the start"},
};

}  // namespace

ModelTable<MakeEstimator> estimators() {
  return kEstimators;
}

}  // namespace canyon::fusion
