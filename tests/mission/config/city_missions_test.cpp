// The missions of missions/delivery/ through real cities.
#include <cstdio>
#include <filesystem>
#include <limits>

#include "canyon/core/units.h"
#include "canyon/tests/mission/summary_of.h"
#include "canyon/tests/support/outside_program.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::mission::testing {
namespace {

/// The mission beside a folder data/ with the city's files, as its heading asks for.
class City {
 public:
  City(const std::string& mission, const std::string& data_file) : path_(scratch_.file(mission)) {
    std::filesystem::copy(std::filesystem::path(CANYON_SOURCE_DIR) / "missions/delivery" / mission, path_);
    std::filesystem::create_symlink(std::filesystem::absolute(data_file).parent_path(), scratch_.file("data"));
  }
  MissionConfig config(const std::string& fidelity) const {
    const auto file = MissionFile::load(path_);
    EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().str());
    const auto config = file->resolve(fidelity);
    EXPECT_TRUE(config.ok()) << (config.ok() ? "" : config.error().str());
    return *config;
  }

 private:
  canyon::testing::ScratchDirectory scratch_;
  std::string path_;
};

/// Start and waypoints lie on streets: near a middle line, on the ground, no building or viaduct's pier within 2 m.
void expect_on_streets(const MissionConfig& config, const PreparedMission& mission) {
  std::vector<Eigen::Vector2d> places{config.vehicle.start_m};
  for (const Waypoint& waypoint : config.autonomy.waypoints) places.push_back(waypoint.p_m);
  const scene::SceneAt at(*mission.scene);
  for (const Eigen::Vector2d& p : places) {
    EXPECT_LT(mission.scene->streets().distance_to(p), 2.0) << p.transpose();
    const auto ground = mission.scene->ground(p.x(), p.y());
    ASSERT_TRUE(ground.has_value()) << p.transpose();
    EXPECT_LT(std::acos(ground->normal_W.z()), 12.0 * kDegree) << p.transpose();
    const Eigen::Vector3d eye(p.x(), p.y(), ground->height_m + 1.0);
    for (int k = 0; k < 36; ++k) {
      const double way = k * 10.0 * kDegree;
      EXPECT_FALSE(at.blocked_towards(eye, {std::cos(way), std::sin(way), 0.2}, 2.0)) << p.transpose() << " " << k;
    }
  }
}

double distance_m(const scene::Scene& scene, const Eigen::Vector2d& p, double lat_deg, double lon_deg) {
  const Eigen::Vector3d there =
      scene.frame().from_geodetic({lat_deg * kDegree, lon_deg * kDegree, scene.frame().origin().h_m});
  return (there.head<2>() - p).norm();
}

TEST(CityMissions, ShibuyasWaypointsLieOnItsStreets) {
  CANYON_REAL_DATA(path, "scenes/shibuya/shibuya_buildings_lod1_epsg6668.geojson");
  const City city("shibuya.toml", path);
  const MissionConfig config = city.config("high");
  const auto mission = prepare(config, scenes());
  ASSERT_TRUE(mission.ok()) << mission.error().str();
  expect_on_streets(config, *mission);
  // The scramble crossing's own coordinates, which maps give as 35.6595 N 139.7005 E; it is some 40 m wide.
  EXPECT_EQ(config.autonomy.waypoints[0].name, "crossing");
  EXPECT_LT(distance_m(*mission->scene, config.autonomy.waypoints[0].p_m, 35.6595, 139.7005), 25.0);
  EXPECT_GT(mission->prior.route.length_m(), 200.0);
}

TEST(CityMissions, LyonsWaypointsLieOnItsStreets) {
  CANYON_REAL_DATA(path, "scenes/lyon1/lyon1_buildings_wgs84.geojson");
  const City city("lyon.toml", path);
  const MissionConfig config = city.config("high");
  const auto mission = prepare(config, scenes());
  ASSERT_TRUE(mission.ok()) << mission.error().str();
  expect_on_streets(config, *mission);
  EXPECT_GT(mission->prior.route.length_m(), 120.0);
}

/// Drives a city low and high; whatever the outcome, it has a reason, and the city shows in the satellites.
void drive_both(const City& city) {
  for (const char* fidelity : {"low", "high"}) {
    const study::RunSummary run = summary_of(drive(city.config(fidelity)));
    std::printf(
        "  %-4s %s%s%s; %d waypoints, %.0f m in %.0f s; fix error rms %.1f m, GDOP median %.1f, NLOS share %.2f; "
        "registration %.2f m rms after %.2f m; %.1f times real time\n",
        fidelity, name(*run.outcome), run.failure ? ": " : "", run.failure ? run.failure->detail.c_str() : "",
        run.waypoints_reached, run.distance_m, run.duration_s, run.fix_error_rms_m, run.gdop_median, run.nlos_share,
        run.registration_rms_m, run.registration_prior_rms_m, run.real_time_factor());
    EXPECT_TRUE(run.outcome == Outcome::kSuccess || (run.failure && !run.failure->detail.empty())) << fidelity;
    EXPECT_GT(run.distance_m, 20.0) << fidelity;
    EXPECT_GT(run.fixes_due, 10) << fidelity;
    if (std::string(fidelity) == "high") {
      EXPECT_GT(run.nlos_share, 0.1);
    }
  }
}

TEST(CityMissionsNightly, ShibuyaLowAndHigh) {
  CANYON_REAL_DATA(path, "scenes/shibuya/shibuya_buildings_lod1_epsg6668.geojson");
  drive_both(City("shibuya.toml", path));
}

TEST(CityMissionsNightly, LyonLowAndHigh) {
  CANYON_REAL_DATA(path, "scenes/lyon1/lyon1_buildings_wgs84.geojson");
  drive_both(City("lyon.toml", path));
}

}  // namespace
}  // namespace canyon::mission::testing
