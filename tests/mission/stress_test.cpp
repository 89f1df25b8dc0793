#include "canyon/mission/stress/stress_cases.h"

#include "canyon/tests/support/stress_cases.h"

namespace canyon::mission {
namespace {

CANYON_STRESS_TESTS(Mission, canyon::mission::stress_cases())

}  // namespace
}  // namespace canyon::mission
