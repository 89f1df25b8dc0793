#include "canyon/mission/part_clock.h"

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
    case Part::kOther:
      return "other";
    case Part::kCount:
      break;
  }
  return "";
}

double PartClock::total_s() const {
  double sum_s = 0.0;
  for (const CpuAccount& account : accounts_) sum_s += account.seconds();
  return sum_s;
}

}  // namespace canyon::mission
