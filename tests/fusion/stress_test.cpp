#include "canyon/fusion/stress/stress_cases.h"

#include "canyon/tests/support/stress_cases.h"

namespace canyon::fusion {
namespace {

CANYON_STRESS_TESTS(Fusion, canyon::fusion::stress_cases())

}  // namespace
}  // namespace canyon::fusion
