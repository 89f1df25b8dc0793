// Windows of walls against their closed forms.
#include "canyon/lidar/beam/texture/windows.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::lidar {
namespace {

/// A wall along y, from y = 2, whose building stands at z = 1.
scene::Facade wall(double width_m, double height_m) {
  scene::Facade out{.along_W = {0.0, 1.0},
                    .begin_m = 2.0,
                    .end_m = 2.0 + width_m,
                    .bottom_m = 0.5,
                    .top_m = 1.0 + height_m,
                    .base_m = 1.0};
  out.divide();
  return out;
}

/// Share of glass: bays x floors x 1.5 x 1.5 over width x height, by points thrown at the wall.
TEST(Windows, ShareOfGlassIsThatOfItsPanes) {
  constexpr int kPoints = 200000;
  const RandomStream draw(1, "test.windows");
  for (const auto& [width_m, height_m] : {std::pair(12.0, 9.0), std::pair(17.3, 22.4), std::pair(4.1, 7.0)}) {
    const scene::Facade w = wall(width_m, height_m);
    int glass = 0;
    for (int k = 0; k < kPoints; ++k)
      glass += on_pane(w, {33.0, 2.0 + width_m * draw.uniform(0, static_cast<std::uint64_t>(k)),
                           1.0 + height_m * draw.uniform(1, static_cast<std::uint64_t>(k))})
                   ? 1
                   : 0;
    const double share = w.bays * w.end_floor * 1.5 * 1.5 / (width_m * height_m);
    EXPECT_GT(share, 0.1);
    EXPECT_LE(share, 0.25);
    // 4.5 sigma: false alarm 7e-6.
    EXPECT_NEAR(static_cast<double>(glass) / kPoints, share, 4.5 * std::sqrt(share * (1.0 - share) / kPoints));
  }
}

TEST(Windows, PanesBeginAndEndWhereTheyAreSaidTo) {
  const scene::Facade w = wall(12.0, 9.0);
  constexpr double kBeside_m = 1e-6;
  for (int floor = 0; floor < 3; ++floor)
    for (int bay = 0; bay < 4; ++bay) {
      const double left = 2.0 + 3.0 * bay + 0.75, right = left + 1.5, low = 1.0 + 3.0 * floor + 0.9, high = low + 1.5;
      const auto at = [&](double y, double z) { return on_pane(w, {-7.0, y, z}); };
      for (const double y : {left + kBeside_m, right - kBeside_m})
        for (const double z : {low + kBeside_m, high - kBeside_m}) EXPECT_TRUE(at(y, z)) << floor << ' ' << bay;
      const double middle_y = 0.5 * (left + right), middle_z = 0.5 * (low + high);
      EXPECT_FALSE(at(left - kBeside_m, middle_z));
      EXPECT_FALSE(at(right + kBeside_m, middle_z));
      EXPECT_FALSE(at(middle_y, low - kBeside_m));
      EXPECT_FALSE(at(middle_y, high + kBeside_m));
    }
  EXPECT_FALSE(on_pane(w, {0.0, 2.0 + 13.5, 2.65})) << "beyond the wall's end";
  EXPECT_FALSE(on_pane(w, {0.0, 3.5, 1.0 + 9.0 + 1.65})) << "above its top";
  EXPECT_FALSE(on_pane(w, {0.0, 3.5, 1.0 - 3.0 + 1.65})) << "below its ground";
}

}  // namespace
}  // namespace canyon::lidar
