#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "canyon/core/process/parallel.h"

namespace canyon {

/// out = what keep(begin, end, to) makes of [0, n), chunk by chunk and in order: it writes at most end - begin values
/// from `to` on, and returns where it ended. Chunks close up behind what they drop. The same for any number of threads,
/// as of parallel_for.
template <class T, class Keep>
void parallel_keep(std::size_t n, std::size_t chunk, std::vector<T>& out, const Keep& keep) {
  out.resize(n);
  if (n == 0) return;
  std::vector<T*> ends((n - 1) / chunk + 1);
  parallel_for(n, chunk,
               [&](std::size_t begin, std::size_t end) { ends[begin / chunk] = keep(begin, end, out.data() + begin); });
  T* next = ends[0];
  for (std::size_t k = 1; k < ends.size(); ++k) {
    T* const from = out.data() + k * chunk;
    next = next == from ? ends[k] : std::copy(from, ends[k], next);
  }
  out.resize(static_cast<std::size_t>(next - out.data()));
}

}  // namespace canyon
