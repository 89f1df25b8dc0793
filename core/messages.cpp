#include "canyon/core/messages.h"

#include "canyon/core/check.h"

namespace canyon {

char system_letter(GnssSystem system) {
  switch (system) {
    case GnssSystem::kGps:
      return 'G';
    case GnssSystem::kGlonass:
      return 'R';
    case GnssSystem::kGalileo:
      return 'E';
    case GnssSystem::kBeidou:
      return 'C';
    case GnssSystem::kQzss:
      return 'J';
    case GnssSystem::kSbas:
      return 'S';
  }
  throw_failed_check("system is one of GnssSystem", __FILE__, __LINE__, join_values(static_cast<int>(system)));
}

std::string SatelliteId::str() const {
  std::string number = std::to_string(prn);
  if (number.size() < 2) number.insert(0, 1, '0');
  return system_letter(system) + number;
}

}  // namespace canyon
