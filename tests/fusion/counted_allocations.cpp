#include "canyon/tests/fusion/counted_allocations.h"

#include <cerrno>
#include <cstddef>

namespace {

thread_local std::int64_t counted = 0;

}  // namespace

namespace canyon::testing {

std::int64_t allocations() {
  return counted;
}

}  // namespace canyon::testing

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define CANYON_SANITIZED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define CANYON_SANITIZED 1
#endif

#if defined(CANYON_SANITIZED)
// The sanitizer's allocator tells of each of them.
#include <sanitizer/allocator_interface.h>

namespace {

[[maybe_unused]] const int kHooked = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { ++counted; }, [](const volatile void*) {});

}  // namespace
#else
// In place of the C library's own, which stand behind them under these names.
extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* at, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++counted;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++counted;
  return __libc_calloc(count, size);
}
void* realloc(void* at, std::size_t size) noexcept {
  ++counted;
  return __libc_realloc(at, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++counted;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** at, std::size_t alignment, std::size_t size) noexcept {
  ++counted;
  *at = __libc_memalign(alignment, size);
  return *at == nullptr ? ENOMEM : 0;
}
}
#endif
