#include "canyon/gnss/products/antex_file.h"
#include "canyon/gnss/products/clock_datum.h"
#include "canyon/gnss/satellites/sun.h"

namespace canyon::gnss {
namespace {

std::string code_of(GnssSystem system, int band) {
  return std::string(1, system_letter(system)) + "0" + std::to_string(band);
}

}  // namespace

Eigen::Vector3d satellite_offset_E(const Antenna& antenna, const Eigen::Vector3d& p_E, GpsTime t) {
  if (!antenna.sv) return Eigen::Vector3d::Zero();
  const GnssSystem system = antenna.sv->system;
  const BandPair bands = precise_clock_bands(system);
  const AntennaPattern* first = antenna.pattern(code_of(system, bands.first));
  const AntennaPattern* second = antenna.pattern(code_of(system, bands.second));
  if (first == nullptr && system == GnssSystem::kBeidou) first = antenna.pattern("C01");  // B1 of older files
  if (first == nullptr) return Eigen::Vector3d::Zero();
  if (second == nullptr) second = first;
  const CombinationWeights weights = ionosphere_free(system, bands);
  const Eigen::Vector3d offset_m = weights.first * first->offset_m + weights.second * second->offset_m;

  const Eigen::Vector3d z = -p_E.normalized();
  const Eigen::Vector3d across = z.cross(sun_direction_E(t));
  // Sun, Earth and satellite in line: the yaw is not defined, nor does it matter for the range.
  if (across.norm() < 1e-9) return offset_m.z() * z;
  const Eigen::Vector3d y = across.normalized(), x = y.cross(z);
  return offset_m.x() * x + offset_m.y() * y + offset_m.z() * z;
}

}  // namespace canyon::gnss
