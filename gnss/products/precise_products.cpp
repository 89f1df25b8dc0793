#include "canyon/gnss/products/precise_products.h"

namespace canyon::gnss {

PreciseOptions PreciseProducts::options(const std::string& systems) const {
  return {.systems = systems, .clocks = clocks ? &*clocks : nullptr, .antennas = antennas ? &*antennas : nullptr};
}

std::vector<std::string> PreciseProducts::warnings() const {
  std::vector<std::string> out = orbits.warnings;
  if (clocks) out.insert(out.end(), clocks->warnings.begin(), clocks->warnings.end());
  if (antennas) out.insert(out.end(), antennas->warnings.begin(), antennas->warnings.end());
  return out;
}

Result<PreciseProducts> read_precise_products(const std::vector<std::string>& sp3, const std::string& clk,
                                              const std::string& antex) {
  PreciseProducts out;
  CANYON_TRY(out.orbits, read_sp3_files(sp3));
  if (!clk.empty()) {
    CANYON_TRY(out.clocks, read_clock_file(clk));
  }
  if (!antex.empty()) {
    CANYON_TRY(out.antennas, read_antex_file(antex));
  }
  return out;
}

}  // namespace canyon::gnss
