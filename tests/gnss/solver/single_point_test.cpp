#include "canyon/gnss/single_point/single_point.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/gnss/rinex/observation/hatanaka.h"
#include "canyon/gnss/single_point/position_statistics.h"
#include "canyon/gnss/single_point/recorded_data.h"
#include "canyon/tests/gnss/rinex/rtklib_runner.h"
#include "canyon/tests/support/outside_program.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

/// A recorded station with its true antenna. Frames and epochs:
///   USNO  ITRF at the epoch of the observations, 2005-01-20 (the position in the header is 13 cm off in X)
///   ESBC  marker of the header + 0.2160 m up. That marker is in ETRS89, as the Danish network keeps it: carried over
///   to
///         ITRF2000 at 2020.48 with the EUREF transformation it lies 0.52 m east and 0.54 m north of there, and that is
///         where dual-frequency solutions lie. The figures of RTKLIB that bound ours are against the header, so ours
///         are too; antenna_of_esbc_itrf() is the other
///   ARL   WGS 84 (G1762), NGA's monitor station 85408, of the header; 2015-07-19
struct Station {
  std::string observations, navigation;
  Eigen::Vector3d truth_E;
};

struct Solved {
  PositionStatistics statistics;
  SinglePointResult result;
};

/// With `sp3`: its orbits and clocks, without antennas.
Solved solve(const Station& station, const SinglePointConfig& config, const std::string& sp3 = "") {
  std::vector<std::string> orbits;
  if (!sp3.empty()) orbits.push_back(sp3);
  const auto data = read_recorded_data({.observations = station.observations,
                                        .navigation = {station.navigation},
                                        .sp3 = orbits,
                                        .antex = "",
                                        .ionex = ""},
                                       config);
  EXPECT_TRUE(data.ok()) << data.error().str();
  auto result = solve_observations(data->observations, data->inputs(), config);
  EXPECT_TRUE(result.ok()) << result.error().str();
  std::vector<GnssFix> fixes;
  for (const auto& e : result->epochs) fixes.push_back(e.fix);
  const Eigen::Vector3d truth_E = station.truth_E;
  const auto statistics = position_statistics(fixes, [&](GpsTime) {
    return std::optional(TruePlace{truth_E, Eigen::Vector3d::Zero().eval()});
  });
  return {statistics, std::move(*result)};
}

SinglePointConfig rtklib_equivalent(const char* systems) {
  const auto c = read_single_point_config(CANYON_SOURCE_DIR "/examples/rtklib_equivalent.toml");
  EXPECT_TRUE(c.ok()) << c.error().str();
  SinglePointConfig out = *c;
  out.systems = systems;
  return out;
}

/// What Canyon recommends for one frequency, the same for every station: the defaults.
SinglePointConfig recommended(const char* systems) {
  SinglePointConfig c;
  c.systems = systems;
  return c;
}

#define CANYON_USNO(station)                                        \
  CANYON_REAL_DATA(usno_obs, "gnss/usno_2005_020/usno0200.05o.gz"); \
  CANYON_REAL_DATA(usno_nav, "gnss/usno_2005_020/brdc0200.05n");    \
  const Station station {                                           \
    usno_obs, usno_nav, {                                           \
      1112189.770, -4842955.030, 3985352.263                        \
    }                                                               \
  }
#define CANYON_ESBC(station)                                                                  \
  CANYON_REAL_DATA(esbc_obs, "gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz"); \
  CANYON_REAL_DATA(esbc_nav, "gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_MN.rnx.gz");     \
  const Station station {                                                                     \
    esbc_obs, esbc_nav, antenna_of_esbc()                                                     \
  }

Eigen::Vector3d antenna_of_esbc() {
  const Eigen::Vector3d marker_E(3582105.2910, 532589.7313, 5232754.8054);
  return marker_E + 0.2160 * rotation_E_from_enu(geodetic_from_ecef(marker_E)).col(2);
}

/// The same in ITRF2000 at 2020.48: x_ETRS = x_ITRF + T + (t - 1989) R x (Boucher & Altamimi, EUREF memo on the
/// transformation, T = (5.4, 5.1, -4.8) cm, R = (0.081, 0.490, -0.792) mas a year).
Eigen::Vector3d antenna_of_esbc_itrf() {
  const Eigen::Vector3d etrs_E = antenna_of_esbc();
  const Eigen::Vector3d rates_rad(0.081e-3 / 3600.0 * kDegree, 0.490e-3 / 3600.0 * kDegree,
                                  -0.792e-3 / 3600.0 * kDegree);
  return etrs_E - Eigen::Vector3d(0.054, 0.051, -0.048) - (2020.48 - 1989.0) * rates_rad.cross(etrs_E);
}

// Bounds: the 3-D RMS of RTKLIB 2.4.3 b34 on the same data with the same options.
TEST(SinglePoint, UsnoLikeForLikeAndRecommended) {
  CANYON_USNO(usno);
  const auto like = solve(usno, rtklib_equivalent("G")).statistics;
  EXPECT_EQ(like.solved, 2880);
  EXPECT_LE(like.rms_3d_m, 4.36);
  const auto best = solve(usno, recommended("G")).statistics;
  EXPECT_EQ(best.solved, 2880);
  EXPECT_LE(best.rms_3d_m, 3.9);
}

TEST(SinglePoint, UsnoDualFrequencyHasNoBiasInHeight) {
  CANYON_USNO(usno);
  auto config = recommended("G");
  config.frequencies = Frequencies::kDual;
  const auto s = solve(usno, config).statistics;
  EXPECT_EQ(s.solved, 2880);
  EXPECT_LE(std::abs(s.mean_enu_m.z()), 1.5);
}

// A static station: what its Dopplers say is their error. 30 s data of a survey receiver whose D1 are averaged over a
// second or so: a few centimetres per second.
TEST(SinglePoint, DopplerVelocityOfAStaticStation) {
  CANYON_USNO(usno);
  const auto s = solve(usno, recommended("G")).statistics;
  ASSERT_TRUE(s.velocity_rms_enu_m_s.allFinite());
  EXPECT_LT(s.velocity_rms_enu_m_s.norm(), 0.03);
}

TEST(SinglePoint, EsbcLikeForLikeAndRecommended) {
  CANYON_ESBC(esbc);
  for (const auto& [systems, bound_m] : {std::pair("G", 1.93), {"GREC", 1.49}}) {
    const auto like = solve(esbc, rtklib_equivalent(systems)).statistics;
    EXPECT_EQ(like.solved, 2880);
    EXPECT_LE(like.rms_3d_m, bound_m) << systems;
    const auto best = solve(esbc, recommended(systems)).statistics;
    EXPECT_EQ(best.solved, 2880);
    EXPECT_LE(best.rms_3d_m, like.rms_3d_m) << systems;
  }
}

// In the frame of the orbits the bias in position goes: horizontally below 0.3 m with two frequencies and all systems,
// where the header's frame leaves 0.6 m.
TEST(SinglePoint, EsbcIsInEtrs89) {
  CANYON_ESBC(esbc);
  auto config = recommended("GREC");
  config.frequencies = Frequencies::kDual;
  const auto etrs = solve(esbc, config).statistics;
  const auto itrf = solve({esbc.observations, esbc.navigation, antenna_of_esbc_itrf()}, config).statistics;
  EXPECT_GT(etrs.mean_enu_m.head<2>().norm(), 0.5);
  EXPECT_LT(itrf.mean_enu_m.head<2>().norm(), 0.3);
  EXPECT_LT(itrf.rms_3d_m, etrs.rms_3d_m);
}

// Precise orbits and clocks, in the frame that they are in (ITRF); ANTEX of that day is not at hand, so ranges err by
// the satellites' antenna offsets, most of which goes into the clock. The file ends at 23:45, and orbits 7.5 minutes
// later.
TEST(SinglePoint, EsbcWithPreciseOrbits) {
  CANYON_ESBC(esbc);
  CANYON_REAL_DATA(sp3, "gnss/esbc_2020_177/GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz");
  const Station itrf{esbc.observations, esbc.navigation, antenna_of_esbc_itrf()};
  const auto gps = solve(itrf, recommended("G"), sp3).statistics;
  EXPECT_EQ(gps.solved, 2866);
  EXPECT_LT(gps.rms_3d_m, 1.4);  // measured 1.347; broadcast 1.711
  // SP3 does not tell GLONASS's channels. With channel 0 for all of them: 17.3 m and 2.16 m/s.
  const auto glonass = solve(itrf, recommended("R"), sp3).statistics;
  EXPECT_LT(glonass.rms_3d_m, 5.2);                      // measured 5.133
  EXPECT_LT(glonass.velocity_rms_enu_m_s.norm(), 0.05);  // measured 0.041
}

TEST(SinglePoint, ArlLikeForLikeAndRecommended) {
  CANYON_REAL_DATA(navigation, "gnss/arl_2015_200/arlm2000.15n");
  for (const auto& [hour, bound_m] : {std::pair("a", 3.595), {"b", 3.795}, {"z", 2.405}}) {
    CANYON_REAL_DATA(observations, std::string("gnss/arl_2015_200/arlm200") + hour + ".15o");
    const Station arl{observations, navigation, {-740289.918, -5457071.734, 3207245.542}};
    const auto like = solve(arl, rtklib_equivalent("G")).statistics;
    EXPECT_GE(like.solved, 119);
    EXPECT_LE(like.rms_3d_m, bound_m) << hour;
    EXPECT_LE(solve(arl, recommended("G")).statistics.rms_3d_m, like.rms_3d_m) << hour;
  }
}

/// Root mean square distance between the two solvers' positions, at the epochs that both have.
double rms_to_rtklib_m(const Solved& ours, const std::map<std::int64_t, Eigen::Vector3d>& theirs) {
  double square = 0.0;
  int n = 0;
  for (const auto& e : ours.result.epochs) {
    const auto found = theirs.find(e.fix.t.ns);
    if (found == theirs.end() || e.fix.status == FixStatus::kNone) continue;
    square += (found->second - e.fix.p_A_E).squaredNorm();
    ++n;
  }
  EXPECT_GE(n, static_cast<int>(ours.result.epochs.size()) - 1);
  return std::sqrt(square / n);
}

/// rnx2rtkp takes neither gzip nor Hatanaka by itself: our own unpacked text is what it gets.
void expect_agreement(const Station& station, const char* systems, int rtklib_systems) {
  const canyon::testing::ScratchDirectory scratch;
  const auto packed = read_text_or_gzip_file(station.observations);
  ASSERT_TRUE(packed.ok());
  const auto plain = is_hatanaka(*packed) ? undo_hatanaka(*packed, "f")->text : *packed;
  ASSERT_TRUE(write_text_file(scratch.file("f.obs"), plain).ok());
  ASSERT_TRUE(write_text_file(scratch.file("f.nav"), *read_text_or_gzip_file(station.navigation)).ok());
  const auto theirs =
      rtklib_positions(scratch.file("f.obs"), scratch.file("f.nav"), rtklib_systems, true, scratch.file("s"));
  EXPECT_LT(rms_to_rtklib_m(solve(station, rtklib_equivalent(systems)), theirs), 0.3) << systems;
}

TEST(SinglePoint, AgreesWithRtklibEpochByEpochUsno) {
  CANYON_OUTSIDE_PROGRAM("rnx2rtkp");
  CANYON_USNO(usno);
  expect_agreement(usno, "G", 1);
}

TEST(SinglePoint, AgreesWithRtklibEpochByEpochEsbc) {
  CANYON_OUTSIDE_PROGRAM("rnx2rtkp");
  CANYON_ESBC(esbc);
  expect_agreement(esbc, "G", 1);
  expect_agreement(esbc, "GREC", 45);
}

TEST(SinglePoint, AgreesWithRtklibEpochByEpochArl) {
  CANYON_OUTSIDE_PROGRAM("rnx2rtkp");
  CANYON_REAL_DATA(observations, "gnss/arl_2015_200/arlm200b.15o");
  CANYON_REAL_DATA(navigation, "gnss/arl_2015_200/arlm2000.15n");
  expect_agreement({observations, navigation, {-740289.918, -5457071.734, 3207245.542}}, "G", 1);
}

}  // namespace
}  // namespace canyon::gnss
