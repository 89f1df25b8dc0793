#include "mission/part_clock.h"

#include <ctime>
#include <numeric>

namespace canyon::mission {

const char* name(Part part) {
  switch (part) {
    case Part::kVehicle:
      return "vehicle";
    case Part::kImu:
      return "IMU";
    case Part::kFilter:
      return "filter";
    case Part::kGnss:
      return "GNSS";
    case Part::kLidar:
      return "LIDAR";
    case Part::kAutonomy:
      return "autonomy";
    case Part::kRegistration:
      return "registration";
    case Part::kScoring:
      return "scoring";
    case Part::kCount:
      break;
  }
  return "";
}

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double PartClock::total_s() const {
  return std::accumulate(seconds_.begin(), seconds_.end(), 0.0);
}

PartClock::Charge::Charge(PartClock& clock, Part part) : clock_(clock), part_(part), start_s_(thread_cpu_s()) {}
PartClock::Charge::~Charge() {
  clock_.seconds_[static_cast<std::size_t>(part_)] += thread_cpu_s() - start_s_;
}

}  // namespace canyon::mission
