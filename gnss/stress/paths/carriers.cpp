// Carriers of waves, and the longest and shortest of them.
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/gnss/paths/plane_waves.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Looks;

/// Of waves each at its own carrier, their lengths and the extremes of them.
StressFigure carriers_of_waves() {
  Looks looks;
  const std::vector<Vector3d> sky{Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};
  const std::vector<double> hz{1227.6e6, 1602e6, 1176.45e6};
  const PlaneWaves waves(sky, hz);
  for (std::size_t i = 0; i < 3; ++i) {
    looks.close(waves.wavelength_m(i), 299792458.0 / hz[i], 4.0);
    looks.right(waves.carrier_hz(i) == hz[i] && waves.direction_W(i) == sky[i]);
  }
  looks.close(waves.shortest_wavelength_m(), 299792458.0 / 1602e6, 4.0);
  looks.close(waves.longest_wavelength_m(), 299792458.0 / 1176.45e6, 4.0);
  looks.right(waves.at(GpsTime{77}).t().ns == 77 && waves.at(GpsTime{77}).carrier_hz(1) == hz[1]);
  const PlaneWaves plain(sky);
  looks.close(plain.shortest_wavelength_m(), 0.190293672798, 1e4);
  looks.close(plain.longest_wavelength_m(), 0.190293672798, 1e4);
  const std::vector<double> bad{1e9, 0.0, 1e9}, few{1e9, 1e9};
  looks.right(stress::not_refused([&] { return PlaneWaves(sky, bad); }) == 0);
  looks.right(stress::not_refused([&] { return PlaneWaves(sky, few); }) == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> carrier_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "carriers of waves", "the longest wave for the shortest",
           "speed of light over the carrier: roundings", "of the bound"});
  rows.add("shortcuts/carriers_of_waves", carriers_of_waves);
  return rows.take();
}

}  // namespace canyon::gnss
