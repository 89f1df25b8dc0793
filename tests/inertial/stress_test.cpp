#include "canyon/inertial/stress/stress_cases.h"

#include "canyon/tests/support/stress_cases.h"

namespace canyon::inertial {
namespace {

CANYON_STRESS_TESTS(Inertial, canyon::inertial::stress_cases())

}  // namespace
}  // namespace canyon::inertial
