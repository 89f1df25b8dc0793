// What a plan says that leaving out a delay moves a range by: reached to more than half by the worst that the model can
// draw, so that a bound halved would be broken.
#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/errors/gauss_markov.h"
#include "canyon/gnss/receiver/modes/receiver_mode.h"

namespace canyon::gnss {
namespace {

constexpr double kMask_rad = 10.0 * kDegree, kLat_rad = 32.35 * kDegree;
const GpsTime kTime = GpsTime::from_week_sow(1590, 396000.0);
constexpr std::uint64_t kSeed = 3;

double bound_m(const std::vector<Need>& needs, const char* effect) {
  for (const Need& need : needs)
    if (need.effect == effect) return need.bound;
  ADD_FAILURE() << effect;
  return kNaN;
}

// 2026-11-22: tests halved numbers of their own, not what the mode says.
TEST(DelayBounds, OfDgpsAreReachedToMoreThanHalf) {
  const auto& row = model_row(receiver_modes(), "dgps");
  const ModelChoice<receiver_modes> choice("dgps");
  const double largest_ephemeris_m = 6.5;
  const std::vector<Need> needs = row.make.need(choice.own, {.ionosphere_m = 10.0,
                                                             .troposphere_m = 25.0,
                                                             .ephemeris_m = largest_ephemeris_m,
                                                             .lowest_elevation_rad = kMask_rad,
                                                             .lat_rad = kLat_rad});
  const auto mode = *choice.make("gnss.mode", ReceiverModeSetup{.seed = kSeed});
  CorrectionInput in;
  in.sv = {GnssSystem::kGps, 7};
  in.t = kTime;
  in.range_m = 2.02e7;  // a satellite overhead: the nearest
  in.true_view = {.t = kTime, .receiver = {kLat_rad, 0.0, 60.0}, .elevation_rad = kMask_rad, .azimuth_rad = 0.0};
  in.acting = {.ionosphere_m = 10.0, .troposphere_m = 25.0, .ephemeris_m = largest_ephemeris_m};
  const Correction c = mode->correction(in);

  // What base and rover do not share, at the mask, as drawn, carried to 6.5 sigma.
  const double ionosphere_sigmas = GaussMarkov(kSeed, "gnss.dgps.ionosphere", 1800.0).at(in.sv.entity(), kTime);
  const double troposphere_sigmas = GaussMarkov(kSeed, "gnss.dgps.troposphere", 3600.0).at(0, kTime);
  const double worst_ionosphere_m = 6.5 * std::abs((10.0 - c.modelled.ionosphere_m) / ionosphere_sigmas);
  const double worst_troposphere_m = 6.5 * std::abs((25.0 - c.modelled.troposphere_m) / troposphere_sigmas);
  for (const auto& [worst_m, effect] :
       {std::pair(worst_ionosphere_m, kIonosphereDifference), std::pair(worst_troposphere_m, kTroposphereDifference),
        std::pair(std::abs(largest_ephemeris_m - c.modelled.ephemeris_m), kEphemeris)}) {
    const double bound = bound_m(needs, effect);
    EXPECT_LE(worst_m, bound) << effect;
    EXPECT_GT(worst_m, 0.5 * bound) << effect;
  }

  // What cancels but for the satellite's way meanwhile: GPS satellites reach 930 m/s seen from the ground (their speed
  // of 3.87 km/s times the sine of the largest nadir angle, 13.9 degrees), more than half of what is taken.
  const double rate_m_s = 3870.0 * std::sin(13.9 * kDegree);
  for (const auto& [delay_m, effect] : {std::pair(10.0, kIonosphere), std::pair(25.0, kTroposphere)}) {
    EXPECT_LE(delay_m * rate_m_s / kSpeedOfLight, bound_m(needs, effect));
    EXPECT_GT(delay_m * rate_m_s / kSpeedOfLight, 0.5 * bound_m(needs, effect));
  }
}

}  // namespace
}  // namespace canyon::gnss
