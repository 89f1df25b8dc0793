// Clouds that have nothing in common, with what missions know beforehand: a prior pose and its covariance.
#include <gtest/gtest.h>

#include "canyon/tests/lidar/registration/made_clouds.h"

namespace canyon::lidar {
namespace {

using testing::closed_room;
using testing::expect_promise;
using testing::kOwnMethods;
using testing::law;
using testing::level_ground;
using testing::offset;
using testing::own_method;
using testing::place;

testing::Points shifted(testing::Points points, const Eigen::Vector3f& way) {
  for (auto& p : points) p += way;
  return points;
}

/// Round a room, 20 m from its walls and 10 m below its floor.
testing::Points hall_around(std::uint64_t number) {
  return testing::Walls(number)
      .add({-28, -26, -12}, {56, 0, 0}, {0, 52, 0}, 9000)
      .add({-28, -26, -12}, {56, 0, 0}, {0, 0, 20}, 4000)
      .add({-28, 26, -12}, {56, 0, 0}, {0, 0, 20}, 4000)
      .add({-28, -26, -12}, {0, 52, 0}, {0, 0, 20}, 4000)
      .add({28, -26, -12}, {0, 52, 0}, {0, 0, 20}, 4000)
      .take();
}

/// One target as it is and two united, as a submap is.
RegistrationResult placed_in_two(const Registration& method, const testing::Points& source,
                                 const testing::Points& target, const PosePrior& prior) {
  const auto s = method.prepare(source);
  const auto cloud = method.prepare(target);
  const std::vector<Registration::Placed> submap{{cloud, Pose{}}, {cloud, offset(0.5, 0.2, 0, 1)}};
  return method.align_with_prior(*s, submap, prior);
}

// The search goes no farther than the prior's 99.9 % bound, 14 m at most here, and its first matches reach 4 m; what it
// could find is 20 m and more away, or 10 m below, where no start leads.
TEST(NoOverlap, IsTooLittleOverlapWhateverThePriorAllows) {
  const testing::Points room = closed_room(1);
  const std::vector<std::pair<std::string, testing::Points>> targets{
      {"500 m away", shifted(closed_room(2), {500, 0, 0})},
      {"24 m away", shifted(closed_room(2), {40, 0, 0})},
      {"a hall around it", hall_around(3)}};
  const std::vector<PosePrior> priors{{offset(0.2, -0.1, 0.02, 1), law(0.3, 1)},
                                      {offset(0.2, -0.1, 0.02, 1), law(1, 3)},
                                      {offset(0.2, -0.1, 0.02, 1), law(3, 10)}};
  for (const char* name : kOwnMethods) {
    const auto method = own_method(name);
    for (const auto& [where, target] : targets) {
      for (std::size_t k = 0; k < priors.size(); ++k) {
        for (const bool two : {false, true}) {
          const auto r =
              two ? placed_in_two(*method, room, target, priors[k]) : place(*method, room, target, priors[k]);
          const std::string what =
              std::string(name) + ", " + where + ", prior " + std::to_string(k) + (two ? ", two targets" : "");
          EXPECT_EQ(r.status, RegistrationStatus::kTooLittleOverlap) << what;
          EXPECT_EQ(r.X_TS.p, priors[k].X_TS.p) << what;
          EXPECT_TRUE(r.covariance.array().isNaN().all()) << what;
          EXPECT_FALSE(r.surfaces) << what;
        }
      }
    }
    // The same prior with the room where it is: it is the clouds that the status is about.
    EXPECT_EQ(place(*method, room, closed_room(2), priors[0]).status, RegistrationStatus::kConverged) << name;
  }
}

// Fields side by side, which have a strip of 2 m of 40 in common. Where the prior has it 3 m of 40 are matched, a
// match's reach more; 0.2 of the points are asked for (least_overlap).
TEST(NoOverlap, AStripInCommonIsNoSilentSuccess) {
  const testing::Points field = level_ground(1), beside = shifted(level_ground(2), {38, 0, 0});
  for (const char* name : kOwnMethods) {
    const auto method = own_method(name);
    for (const double sigma_m : {0.3, 1.0}) {
      const PosePrior prior{offset(0.1, 0.1, 0.02, 0.5), law(sigma_m, 1)};
      for (const bool two : {false, true}) {
        const auto r = two ? placed_in_two(*method, field, beside, prior) : place(*method, field, beside, prior);
        const std::string what = std::string(name) + ", " + std::to_string(sigma_m) + " m";
        expect_promise(r, prior.X_TS, what);
        EXPECT_NE(r.status, RegistrationStatus::kConverged) << what << ", overlap " << r.overlap;
      }
    }
  }
}

}  // namespace
}  // namespace canyon::lidar
