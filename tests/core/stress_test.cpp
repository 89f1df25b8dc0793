#include "canyon/core/stress/stress_cases.h"

#include "canyon/tests/support/stress_cases.h"

namespace canyon {
namespace {

CANYON_STRESS_TESTS(Core, canyon::stress_cases())

}  // namespace
}  // namespace canyon
