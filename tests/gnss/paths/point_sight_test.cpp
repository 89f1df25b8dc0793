#include "canyon/gnss/paths/sight/point_sight.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::direction;
using testing::WallScene;

std::unique_ptr<scene::Scene> two_houses() {
  return WallScene().box({4, -30, 0}, {20, 0, 20}).box({-20, 5, 0}, {-5, 40, 15}).build();
}

// At a node of the lattice sight is that of one ray; between nodes their shares add up to it.
TEST(PointSight, IsSharpAtTheNodes) {
  const auto scene = two_houses();
  const scene::SceneAt at(*scene);
  PointSight sight(*scene);
  GnssCounters counters;
  int seen = 0;
  for (std::uint32_t id = 0; id < 200; ++id) {
    const Eigen::Vector3d q(2.0 * (id % 20) - 20.5, 3.0 * (id / 20) - 15.0, 2.5), p(0.0, 2.0, 2.0);
    const bool free = !at.blocked_towards(p, (q - p).normalized(), (q - p).norm());
    EXPECT_EQ(sight.from(p).share(id, q, counters), free ? 1.0 : 0.0) << id;
    seen += free ? 1 : 0;
  }
  EXPECT_GT(seen, 20);
  EXPECT_LT(seen, 180);
}

// What is remembered is what is seen: one that has looked at all of a drive says the same as one that looks first.
TEST(PointSight, MemoryChangesNoNumber) {
  const auto scene = two_houses();
  PointSight old(*scene);
  const RandomStream draws(4, "test.sight");
  GnssCounters counters;
  for (std::uint64_t k = 0; k < 400; ++k) {
    const Eigen::Vector3d p(draws.uniform(-4, 3, 0, k), draws.uniform(-30, 30, 1, k), draws.uniform(1, 3, 2, k));
    const auto id = static_cast<std::uint32_t>(draws.uniform(0, 60, 3, k));
    const Eigen::Vector3d q(-25.0 + id, 0.7 * id - 20.0, 0.1 * id + 0.2);
    const Eigen::Vector3d s = direction(draws.uniform(0, 360, 4, k), draws.uniform(5, 89, 5, k));
    PointSight fresh(*scene);
    EXPECT_EQ(old.from(p).share(id, q, counters), fresh.from(p).share(id, q, counters)) << k;
    EXPECT_EQ(old.towards(s).share(id, q, counters), fresh.towards(s).share(id, q, counters)) << k;
  }
}

// Nothing is looked at twice.
TEST(PointSight, ARayIsFiredOnce) {
  const auto scene = two_houses();
  PointSight sight(*scene);
  GnssCounters counters;
  const Eigen::Vector3d p(0.3, 2.2, 1.9), q(10.0, 20.0, 3.0), s = direction(70.0, 20.0);
  const auto look = [&] {
    sight.from(p).share(7, q, counters);
    sight.towards(s).share(7, q, counters);
  };
  look();
  EXPECT_EQ(counters.occlusion_rays, 8 + 4);
  look();
  EXPECT_EQ(counters.occlusion_rays, 8 + 4);
  sight.from(p + Eigen::Vector3d(2.0, 0.0, 0.0)).share(7, q, counters);
  EXPECT_EQ(counters.occlusion_rays, 8 + 4 + 4) << "half of the nodes are new";
}

// A share changes by at most 1 a cell along each coordinate: 0.005 a centimetre in each of three, and as much per
// 0.0001 rad in two, wherever shadows lie; and it does change.
TEST(PointSight, ChangesEvenlyWithPlaceAndDirection) {
  const auto scene = two_houses();
  PointSight sight(*scene);
  GnssCounters counters;
  const Eigen::Vector3d q(10.0, 20.0, 3.0);
  double before = sight.from({-2.0, -25.0, 1.7}).share(1, q, counters), moved = 0.0;
  for (int i = 1; i <= 5000; ++i) {
    const double now = sight.from({-2.0, -25.0 + 0.01 * i, 1.7}).share(1, q, counters);
    EXPECT_LE(std::abs(now - before), 0.005 + 1e-12) << i;
    moved += std::abs(now - before);
    before = now;
  }
  EXPECT_GE(moved, 0.999);
  before = sight.towards(direction(0.0, 5.0)).share(1, {0.0, 0.0, 2.0}, counters);
  moved = 0.0;
  for (int i = 1; i <= 20000; ++i) {
    const double turn = 1e-4 * i;  // rad; from behind one house over the zenith behind the other
    const Eigen::Vector3d s(std::cos(turn), -0.3 * std::cos(turn), std::sin(turn) + 0.05);
    const double now = sight.towards(s.normalized()).share(1, {0.0, 0.0, 2.0}, counters);
    EXPECT_LE(std::abs(now - before), i == 1 ? 1.0 : 2.0 * 1.2e-4 / PointSight::kCell_rad) << i;
    moved += std::abs(now - before);
    before = now;
  }
  EXPECT_GE(moved, 0.999);
}

TEST(PointSight, APoolLendsEachThatAsksOne) {
  const auto scene = two_houses();
  SightPool pool;
  GnssCounters counters;
  const auto ask = [&](const SightPool::Loan& loan) {
    return (*loan).from({0.0, 2.0, 2.0}).share(3, {10.0, 20.0, 3.0}, counters);
  };
  {
    const SightPool::Loan one = pool.borrow(*scene), two = pool.borrow(*scene);
    EXPECT_NE(&*one, &*two);
    EXPECT_EQ(ask(one), ask(two));
  }
  const auto before = counters.occlusion_rays;
  ask(pool.borrow(*scene));
  EXPECT_EQ(counters.occlusion_rays, before) << "what was learnt is kept";
}

}  // namespace
}  // namespace canyon::gnss
