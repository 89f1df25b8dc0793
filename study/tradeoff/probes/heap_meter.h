#pragma once

namespace canyon::study {

/// How much the heap in use has grown since this was made, MB (all arenas of the C library's allocator and what it has
/// mapped). What was freed in between counts no more: the peak may have been higher.
class HeapMeter {
 public:
  HeapMeter();
  double grown_mb() const;

 private:
  double before_mb_;
};

}  // namespace canyon::study
