#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canyon/gnss/products/antex_file.h"
#include "canyon/gnss/products/clock_file.h"
#include "canyon/gnss/products/precise_orbits.h"

namespace canyon::gnss {

/// Files of an analysis centre: SP3 orbits, and a RINEX clock file and an ANTEX file where there are such.
struct PreciseProducts {
  PreciseOrbits orbits;
  std::optional<ClockFile> clocks;
  std::optional<AntexFile> antennas;

  /// What to place satellites with; points into this object.
  PreciseOptions options(const std::string& systems) const;
  /// Of all the files, `file:line: what`.
  std::vector<std::string> warnings() const;
};
/// An empty name: no such file.
Result<PreciseProducts> read_precise_products(const std::vector<std::string>& sp3, const std::string& clk,
                                              const std::string& antex);

}  // namespace canyon::gnss
