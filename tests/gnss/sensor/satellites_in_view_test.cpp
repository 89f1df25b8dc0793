#include "canyon/gnss/sensor/satellites_in_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/stress/counted_sky.h"

namespace canyon::gnss {
namespace {

const GpsTime kViewStart = GpsTime::from_calendar(2020, 6, 25, 12, 0, 0);

class SatellitesInViewTest : public ::testing::Test {
 protected:
  /// The satellites' names at a time and a place in W: as found by one that goes on, which must be as by a fresh one.
  void look(double t_s, const Eigen::Vector3d& p_W) {
    const GpsTime t = kViewStart + t_s;
    const Eigen::Vector3d p_E = frame_.to_E(p_W);
    const Horizon horizon(p_E);
    const auto found = going_on_.at(t, t, p_E, horizon);
    SatellitesInView fresh(sky_, frame_, kMask_rad);
    const auto expected = fresh.at(t, t, p_E, horizon);
    ASSERT_EQ(found.size(), expected.size()) << "after " << t_s << " s";
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].sv.str(), expected[i].sv.str());
      EXPECT_EQ(found[i].direction_W, expected[i].direction_W);
    }
    if (found.size() != last_) ++changes_;
    last_ = found.size();
  }

  static constexpr double kMask_rad = 5.0 * kDegree;
  std::shared_ptr<CountedSky> sky_ = std::make_shared<CountedSky>(make_nominal("GRECJ"));
  LocalFrame frame_{Geodetic{52.5 * kDegree, 13.4 * kDegree, 40.0}};
  SatellitesInView going_on_{sky_, frame_, kMask_rad};
  std::size_t last_ = 0;
  int changes_ = 0;
};

TEST_F(SatellitesInViewTest, AreThoseThatLookingAtAllEachTimeFinds) {
  for (int i = 0; i < 10'800; ++i) look(i, {10.0 * i, 3.0 * i, 0.0});
  EXPECT_GT(changes_, 30);  // that rise and set: 60 satellites over 3 h
}

TEST_F(SatellitesInViewTest, AfterALeapOfTimeOrPlaceAsWell) {
  const double steps_s[] = {0.1, 5.0, 59.0, 61.0, 3600.0, -20.0, -7200.0};
  const double ways_m[] = {0.0, 100.0, 3e4, -5e5, 2e6};
  double t_s = 0.0, east_m = 0.0;
  for (int i = 0; i < 2000; ++i) {
    t_s += steps_s[i % 7];
    east_m += ways_m[(i / 3) % 5] * (i % 2 ? 1.0 : -1.0);
    look(t_s, {east_m, 0.5 * east_m, 0.0});
  }
  EXPECT_GT(changes_, 100);
}

TEST_F(SatellitesInViewTest, AskForAFewOnly) {
  const Eigen::Vector3d p_E = frame_.to_E(Eigen::Vector3d::Zero());
  const Horizon horizon(p_E);
  std::size_t seen = 0;
  for (int i = 0; i < 600; ++i) {
    const GpsTime t = kViewStart + 0.1 * i;
    seen += going_on_.at(t, t, p_E, horizon).size();
  }
  const double epochs = 600.0, all = static_cast<double>(sky_->satellites().size());
  // Light time takes two or three questions a satellite; of those below the mask next to none is asked for.
  EXPECT_LT(sky_->asked, 3.5 * static_cast<double>(seen) + 0.3 * epochs * all);
  EXPECT_GT(sky_->asked, static_cast<double>(seen));
}

}  // namespace
}  // namespace canyon::gnss
