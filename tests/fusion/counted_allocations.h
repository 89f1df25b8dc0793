#pragma once

#include <cstdint>

namespace canyon::testing {

/// How often this thread has asked for memory from the heap: by malloc, calloc, realloc or aligned_alloc, on which
/// operator new and Eigen stand.
std::int64_t allocations();

}  // namespace canyon::testing
