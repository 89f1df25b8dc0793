#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <Eigen/Core>

#include "canyon/core/files/files.h"
#include "canyon/core/time.h"

namespace canyon::gnss {

/// Positions that rnx2rtkp finds in single point mode, by time in ns. `systems`: its bits 1 GPS, 4 GLONASS, 8 Galileo,
/// 32 BeiDou. `atmosphere`: broadcast ionosphere and Saastamoinen, or none.
inline std::map<std::int64_t, Eigen::Vector3d> rtklib_positions(const std::string& observations,
                                                                const std::string& navigation, int systems,
                                                                bool atmosphere, const std::string& scratch) {
  const std::string conf = scratch + ".conf", out = scratch + ".pos";
  std::ofstream(conf) << "pos1-posmode=single\npos1-elmask=10\npos1-ionoopt=" << (atmosphere ? "brdc" : "off")
                      << "\npos1-tropopt=" << (atmosphere ? "saas" : "off") << "\npos1-navsys=" << systems
                      << "\nout-solformat=xyz\nout-timesys=gpst\nout-timeform=tow\n";
  const std::string command = "rnx2rtkp -k '" + conf + "' -o '" + out + "' '" + observations + "' '" + navigation +
                              "' > /dev/null 2>&1 < /dev/null";
  if (std::system(command.c_str()) != 0) return {};
  std::map<std::int64_t, Eigen::Vector3d> positions;
  std::ifstream in(out);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '%') continue;
    std::istringstream words(line);
    int week = 0;
    double sow_s = 0.0;
    Eigen::Vector3d p_E;
    words >> week >> sow_s >> p_E.x() >> p_E.y() >> p_E.z();
    positions[GpsTime::from_week_sow(week, sow_s).ns] = p_E;
  }
  return positions;
}

}  // namespace canyon::gnss
