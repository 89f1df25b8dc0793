#pragma once

#include <array>
#include <cstddef>

namespace canyon::mission {

/// The parts of a run whose CPU time is told apart.
enum class Part : std::size_t { kVehicle, kImu, kFilter, kGnss, kLidar, kAutonomy, kRegistration, kScoring, kCount };
const char* name(Part part);

/// CPU time of the calling thread by part of the run.
class PartClock {
 public:
  /// Runs f and charges its CPU time to `part`; returns what f returns.
  template <class F>
  auto charge(Part part, F&& f) {
    const Charge charge(*this, part);
    return f();
  }
  double cpu_s(Part part) const { return seconds_[static_cast<std::size_t>(part)]; }
  double total_s() const;

 private:
  struct Charge {
    Charge(PartClock& clock, Part part);
    ~Charge();
    PartClock& clock_;
    Part part_;
    double start_s_;
  };
  std::array<double, static_cast<std::size_t>(Part::kCount)> seconds_{};
};

/// CPU time of the calling thread, s.
double thread_cpu_s();

}  // namespace canyon::mission
