#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/process/child_process.h"
#include "canyon/tests/mutation/format.h"

/// Whether a reader survives what it is given.
namespace canyon::testing {

struct Finding {
  std::uint64_t variant = 0;
  std::string how;   ///< the file was damaged
  std::string what;  ///< the reader did
};

/// Reads the variants first .. first + count - 1 of a format, two side by side, each in a process of its own, and
/// collects those that end otherwise than by success (0) or by one line that says what is wrong (2): by a signal, an
/// exception, another exit status, with several lines or control characters, with JSON that is none, with files left
/// behind, or beyond the limits of time and memory. Stops after twenty.
std::vector<Finding> findings(const Format& format, std::uint64_t first, std::uint64_t count,
                              const ChildLimits& limits = {});

/// The same of the seeds, undamaged: they must be read with exit status 0, or what is damaged is not the format.
std::vector<Finding> findings_of_seeds(const Format& format, const ChildLimits& limits = {});

/// Writes one variant with its companions to `folder`, runs it in a process of its own and prints how it ended, the
/// command, and what it said. Returns 0 if there is nothing to find.
int reproduce(const Format& format, std::uint64_t variant, const std::string& folder);

}  // namespace canyon::testing
