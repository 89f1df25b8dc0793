#include "gnss/errors/ephemeris_error.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace canyon::gnss {
namespace {

const GpsTime kStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

SatelliteState at(const Eigen::Vector3d& p_E) {
  SatelliteState s;
  s.p_E = p_E;
  s.v_E = Eigen::Vector3d::UnitY();
  return s;
}

TEST(EphemerisError, PaperAsPrintedAndCorrected) {
  const EphemerisErrorParameters p;
  const auto printed = make_paper_printed_ephemeris(p), corrected = make_paper_corrected_ephemeris(p);
  const SatelliteId sv{GnssSystem::kGps, 1};
  const double r = 26550e3;
  const Eigen::Vector3d equator(r, 0, 0);
  const double top = std::sin(55.0 * 3.14159265358979 / 180.0);
  const Eigen::Vector3d north(r * std::sqrt(1 - top * top), 0, r * top), south(north.x(), 0, -north.z());
  // Figures of the paper's formula, to their digits: 10.05 m (7.7 to 11.9 over +-55 deg) and 1.09 m (0.88 to 1.26).
  EXPECT_NEAR(printed->range_m(sv, at(equator), Eigen::Vector3d::UnitZ(), kStart), 10.05, 0.005);
  EXPECT_NEAR(printed->range_m(sv, at(south), Eigen::Vector3d::UnitZ(), kStart), 7.7, 0.05);
  EXPECT_NEAR(printed->range_m(sv, at(north), Eigen::Vector3d::UnitZ(), kStart), 11.9, 0.05);
  EXPECT_NEAR(corrected->range_m(sv, at(equator), Eigen::Vector3d::UnitZ(), kStart), 1.09, 0.005);
  EXPECT_NEAR(corrected->range_m(sv, at(south), Eigen::Vector3d::UnitZ(), kStart), 0.88, 0.005);
  EXPECT_NEAR(corrected->range_m(sv, at(north), Eigen::Vector3d::UnitZ(), kStart), 1.26, 0.005);
}

TEST(EphemerisError, GaussMarkovScalesWithSigma) {
  const auto one = make_gauss_markov_ephemeris({3, 1.0, 3600.0}), two = make_gauss_markov_ephemeris({3, 2.0, 3600.0});
  const SatelliteId sv{GnssSystem::kGps, 7};
  EXPECT_DOUBLE_EQ(two->range_m(sv, at(Eigen::Vector3d::Ones()), Eigen::Vector3d::UnitZ(), kStart),
                   2.0 * one->range_m(sv, at(Eigen::Vector3d::Ones()), Eigen::Vector3d::UnitZ(), kStart));
  EXPECT_EQ(find_model(ephemeris_error_models(), "none")
                ->make({})
                ->range_m(sv, at(Eigen::Vector3d::Ones()), Eigen::Vector3d::UnitZ(), kStart),
            0.0);
}

}  // namespace
}  // namespace canyon::gnss
