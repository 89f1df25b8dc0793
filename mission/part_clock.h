#pragma once

#include <array>
#include <cstddef>

#include "canyon/core/process/cpu_time.h"

namespace canyon::mission {

/// The parts of a run whose CPU time is told apart. kOther: making the sensors, moving things, keeping the record.
enum class Part : std::size_t {
  kVehicle,
  kImu,
  kFilter,
  kGnss,
  kLidar,
  kAutonomy,
  kRegistration,
  kScoring,
  kOther,
  kCount
};
const char* name(Part part);

/// CPU time by part of the run, of all threads that worked on it. Parts may lie within one another: each instant counts
/// for the innermost.
class PartClock {
 public:
  /// Runs f and charges its CPU time to `part`; returns what f returns.
  template <class F>
  decltype(auto) charge(Part part, F&& f) {
    const ChargeCpu charge(&accounts_[static_cast<std::size_t>(part)]);
    return f();
  }
  double cpu_s(Part part) const { return accounts_[static_cast<std::size_t>(part)].seconds(); }
  double total_s() const;

 private:
  std::array<CpuAccount, static_cast<std::size_t>(Part::kCount)> accounts_;
};

}  // namespace canyon::mission
