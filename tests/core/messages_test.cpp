#include "canyon/core/messages.h"

#include <set>

#include <gtest/gtest.h>

#include "canyon/core/check.h"

namespace canyon {
namespace {

TEST(SatelliteId, NamesAsInRinex) {
  EXPECT_EQ((SatelliteId{GnssSystem::kGps, 1}.str()), "G01");
  EXPECT_EQ((SatelliteId{GnssSystem::kGlonass, 24}.str()), "R24");
  EXPECT_EQ((SatelliteId{GnssSystem::kGalileo, 30}.str()), "E30");
  EXPECT_EQ((SatelliteId{GnssSystem::kBeidou, 5}.str()), "C05");
  EXPECT_EQ((SatelliteId{GnssSystem::kQzss, 2}.str()), "J02");
  EXPECT_EQ((SatelliteId{GnssSystem::kSbas, 20}.str()), "S20");
}

TEST(SatelliteId, EntitiesAreDistinctAndOrderIsBySystemThenNumber) {
  std::set<std::uint32_t> entities;
  for (int system = 0; system <= 5; ++system) {
    for (int prn = 0; prn < 256; ++prn) {
      entities.insert(SatelliteId{static_cast<GnssSystem>(system), static_cast<std::uint8_t>(prn)}.entity());
    }
  }
  EXPECT_EQ(entities.size(), 6u * 256u);
  EXPECT_LT((SatelliteId{GnssSystem::kGps, 32}), (SatelliteId{GnssSystem::kGalileo, 1}));
  EXPECT_LT((SatelliteId{GnssSystem::kGps, 2}), (SatelliteId{GnssSystem::kGps, 10}));
}

TEST(GnssSystem, AValueOutsideTheListIsAProgramError) {
  EXPECT_THROW((void)system_letter(static_cast<GnssSystem>(17)), ProgramError);
}

TEST(GnssObservation, CorrectedPseudorangeAddsTheClockAndTakesOffTheAtmosphere) {
  GnssObservation o;
  o.pseudorange_m = 100.0;
  o.clock_m = 7.0;
  o.correction_m = 2.5;
  EXPECT_EQ(o.corrected_m(), 104.5);
}

}  // namespace
}  // namespace canyon
