#include "canyon/study/tradeoff/probes/heap_meter.h"

#include <cstdlib>  // __GLIBC__
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace canyon::study {
namespace {

double heap_in_use_mb() {
#ifdef __GLIBC__
  const auto info = mallinfo2();
  return 1e-6 * (static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd));
#else
  return 0.0;
#endif
}

}  // namespace

HeapMeter::HeapMeter() : before_mb_(heap_in_use_mb()) {}

double HeapMeter::grown_mb() const {
  return heap_in_use_mb() - before_mb_;
}

}  // namespace canyon::study
