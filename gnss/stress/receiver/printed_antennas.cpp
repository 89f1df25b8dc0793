// Antennas as their makers and the IGS print them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/receiver/receiver_antenna.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::Looks;

/// As igs05.atx prints them for G01, by zenith angle from 0 to 90 in steps of 5 degrees: north, east and up of the mean
/// phase centre, mm, then the variation without azimuth.
struct PrintedAntenna {
  const char* name;
  double north, east, up;
  std::array<double, 19> by_zenith;
};
constexpr PrintedAntenna kPrinted[] = {
    {"survey",
     1.35,
     0.30,
     66.76,
     {0.00, -0.01, -0.05, -0.12, -0.22, -0.33, -0.45, -0.58, -0.71, -0.82, -0.93, -1.00, -1.00, -0.88, -0.58, -0.11,
      0.49, 1.11, 1.59}},
    {"choke_ring",
     0.60,
     -0.46,
     91.24,
     {0.00, -0.24, -0.92, -1.97, -3.28, -4.69, -6.05, -7.19, -7.97, -8.30, -8.14, -7.46, -6.27, -4.54, -2.20, 0.87,
      4.79, 9.56, 14.88}},
    {"patch", 0.0, 0.0, 8.9, {}},
    {"isotropic", 0.0, 0.0, 0.0, {}},
};
/// As data sheets have them, right hand and left by zenith angle from 0 to 180 in steps of 15 degrees, dB.
struct PrintedGain {
  const char* name;
  std::array<double, 13> right, left;
};
constexpr PrintedGain kGains[] = {
    {"patch",
     {0.0, -0.1, -0.5, -1.3, -2.6, -4.3, -7, -10, -13, -16, -19, -21, -22},
     {-18.8, -18, -16, -14, -12.5, -11.5, -11.5, -12.5, -14, -15.5, -17, -19, -20}},
    {"survey",
     {0.0, -0.2, -1.0, -2.4, -4.6, -8.0, -12.5, -18.5, -24, -28, -30, -31, -32},
     {-25, -24, -23, -22, -21, -20, -20.5, -24, -26, -27, -28, -29, -30}},
    {"choke_ring",
     {0.0, -0.3, -1.0, -2.3, -4.3, -7.2, -11.5, -20, -27, -31, -33, -34, -35},
     {-30, -29, -27, -25, -23, -22, -24, -27, -29, -30, -31, -32, -32}},
    {"isotropic", {}, {-100, -100, -100, -100, -100, -100, -100, -100, -100, -100, -100, -100, -100}},
};

StressFigure antennas_as_printed() {
  Looks looks;
  const RandomStream draws(1, "stress.asked");
  for (const PrintedAntenna& printed : kPrinted) {
    const auto antenna = model_row(antenna_models(), printed.name).make({});
    for (std::uint64_t k = 0; k < 200; ++k) {
      Vector3d u = draws.direction(0, k);
      if (k < 19) u = Vector3d(std::sin(5.0 * k * kDegree), 0.0, std::cos(5.0 * k * kDegree));
      const double zenith = std::min(std::acos(std::clamp(u.z(), -1.0, 1.0)) / kDegree, 90.0) / 5.0;
      const auto i = static_cast<std::size_t>(std::min(std::floor(zenith), 17.0));
      const double part = zenith - static_cast<double>(i);
      const double variation = (1.0 - part) * printed.by_zenith[i] + part * printed.by_zenith[i + 1];
      // The mean phase centre lies towards the satellite: the range is the shorter by that.
      const double offset = printed.east * u.x() + printed.north * u.y() + printed.up * u.z();
      looks.near(antenna->phase_centre_m(u), 1e-3 * (variation - offset), 1e-11);
    }
  }
  for (const PrintedGain& printed : kGains) {
    const auto antenna = model_row(antenna_models(), printed.name).make({});
    for (double zenith = 0.0; zenith <= 180.0; zenith += 2.5) {
      const auto i = static_cast<std::size_t>(std::min(std::floor(zenith / 15.0), 11.0));
      const double part = zenith / 15.0 - static_cast<double>(i), e = (90.0 - zenith) * kDegree;
      looks.near(antenna->rhcp_db(e), (1.0 - part) * printed.right[i] + part * printed.right[i + 1], 1e-10);
      looks.near(antenna->lhcp_db(e), (1.0 - part) * printed.left[i] + part * printed.left[i + 1], 1e-10);
    }
  }
  const auto sine = make_sine_antenna({.horizon_loss_db = 6.5, .lhcp_rejection_db = 9.0});
  for (double e = -1.57; e < 1.57; e += 0.1) {
    looks.near(sine->rhcp_db(e), 6.5 * (std::sin(e) - 1.0), 1e-13);
    looks.near(sine->lhcp_db(e), 6.5 * (std::sin(e) - 1.0) - 9.0, 1e-13);
    looks.right(sine->phase_centre_m(Vector3d::UnitZ()) == 0.0);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> printed_antenna_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "antennas as their makers and the IGS print them",
           "a figure in the next column, east for north", "by zenith angle, straight between: roundings",
           "of the bound"});
  rows.add("asked/antennas_as_printed", antennas_as_printed)
      .loose("an arc cosine beside the zenith loses half of its digits, an arc sine does not");
  return rows.take();
}

}  // namespace canyon::gnss
