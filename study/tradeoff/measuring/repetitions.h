#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "canyon/study/tradeoff/probes/probe.h"

namespace canyon::study {

/// What repeating one probe gave.
struct Repeated {
  ProbeRun first;             ///< of the warm-up, whose time does not count
  std::vector<double> cpu_s;  ///< of each repetition
  double median_s() const;
  double least_s() const;
  double most_s() const;
};

/// The order in which `count` probes run in a repetition: drawn anew for each from the stream "tradeoff.order", so that
/// no probe always comes after the same other, or always when the machine is warm.
std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t seed, std::uint64_t repetition);

/// Runs every probe once to warm up, then all of them `repetitions` times, interleaved in random order. What takes less
/// than 2 ms is done so often within a repetition that it takes as much. Values and work must be the same bits each
/// time: else it throws.
Result<std::vector<Repeated>> repeat(const std::vector<std::unique_ptr<Probe>>& probes, int repetitions,
                                     std::uint64_t seed);

}  // namespace canyon::study
