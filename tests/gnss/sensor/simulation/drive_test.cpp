#include "canyon/gnss/sensor/simulation/drive.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/gnss/rinex/observation/observation_file.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/simulation/drive_files.h"
#include "canyon/gnss/sensor/simulation/sky.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using ::testing::HasSubstr;

const GpsTime kDriveStart = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);

/// Level ground at 10 m, 200 m wide.
class DriveTest : public ::testing::Test {
 protected:
  DriveTest() {
    scene::SceneParts parts;
    parts.frame = LocalFrame({0.5646, -1.586, 60.0});
    parts.materials = scene::builtin_materials();
    scene::MeshBuilder mesh(parts);
    mesh.begin_object("terrain", scene::ObjectKind::kTerrain);
    mesh.quad({-100, -100, 10}, {100, -100, 10}, {100, 100, 10}, {-100, 100, 10}, mesh.material("asphalt"));
    scene_ = std::make_unique<scene::Scene>(std::move(parts));
  }
  /// From x = -`reach_m` to `reach_m` in ten seconds, at a height.
  Drive drive(double height_m, double reach_m = 50.0) const {
    std::vector<StampedPlace> places;
    for (int k = 0; k <= 10; ++k)
      places.push_back({kDriveStart + k, scene_->frame().to_E({reach_m * (k / 5.0 - 1.0), 0.0, height_m})});
    return {PlacePath(std::move(places)), "way.csv", kDriveStart, 10.0, 2.0};
  }
  std::unique_ptr<GnssSensor> sensor(const GnssConfig& config = {}) const {
    auto made = make_gnss_sensor(config, 1, kDriveStart, kDriveStart + 10.0, *scene_);
    EXPECT_TRUE(made.ok());
    return std::move(*made);
  }
  std::unique_ptr<scene::Scene> scene_;
};

TEST_F(DriveTest, MeasuresFromTheStartToTheEnd) {
  std::vector<GnssOutput> outputs;
  const auto receiver = sensor();
  const auto totals =
      simulate_drive(drive(12.0), *receiver, *scene_, [&](const GnssOutput& o) { outputs.push_back(o); });
  ASSERT_TRUE(totals.ok());
  ASSERT_EQ(outputs.size(), 21u);
  EXPECT_EQ(outputs.front().fix.t, kDriveStart);
  EXPECT_EQ(outputs.back().fix.t, kDriveStart + 10.0);
  EXPECT_EQ(totals->epochs, 21);
  EXPECT_EQ(totals->fixes, 21);
  EXPECT_EQ(totals->below_ground, 0);
  double square_m2 = 0.0;
  for (const GnssOutput& o : outputs) square_m2 += (o.fix.p_A_E - o.truth.p_A_E).squaredNorm() / 21.0;
  EXPECT_NEAR(totals->rms_m(), std::sqrt(square_m2), 1e-12);  // the same sum in another order
  EXPECT_GE(totals->satellites_mean(), 4.0);
  EXPECT_EQ(totals->nlos_share(), 0.0);
}

TEST_F(DriveTest, BelowTheGroundIsCounted) {
  const auto receiver = sensor();
  const auto totals = simulate_drive(drive(7.5), *receiver, *scene_, [](const GnssOutput&) {});
  ASSERT_TRUE(totals.ok());
  EXPECT_EQ(totals->below_ground, 21);
  EXPECT_NEAR(totals->deepest_m, 2.5, 1e-6);  // coordinates of 6.4e6 m, to E and back
  EXPECT_EQ(totals->fixes, 0);
  EXPECT_TRUE(std::isnan(totals->rms_m()));
  EXPECT_EQ(depth_below_ground_m(*scene_, {150.0, 0.0, -40.0}), 0.0) << "beside the scene";
}

TEST_F(DriveTest, AHeightThatNoModelCoversIsAnError) {
  const auto receiver = sensor();
  const auto totals = simulate_drive(drive(25e3), *receiver, *scene_, [](const GnssOutput&) {});
  ASSERT_FALSE(totals.ok());
  EXPECT_EQ(totals.error().file, "way.csv");
  EXPECT_EQ(totals.error().key, kDriveStart.iso());
}

TEST_F(DriveTest, FilesHoldEveryEpoch) {
  const Drive way = drive(12.0);
  const auto receiver = sensor();
  DriveFiles files(0.0);
  ASSERT_TRUE(simulate_drive(way, *receiver, *scene_, [&](const GnssOutput& o) { files.add(o); }).ok());
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  EXPECT_EQ(lines(files.fixes_csv()), 22);
  EXPECT_THAT(files.nmea(), HasSubstr("$GPGGA,125945.50,"));
  const auto source = make_satellite_source({}, kDriveStart, kDriveStart + 10.0);
  ASSERT_TRUE(source.ok());
  const auto rinex = files.rinex_observations(way, *source, "x.rnx");
  ASSERT_TRUE(rinex.ok());
  const auto read = parse_observation_file(*rinex, "x.rnx");
  ASSERT_TRUE(read.ok()) << read.error().str();
  EXPECT_EQ(read->epochs.size(), 21u);
  std::vector<std::string> warnings;
  EXPECT_TRUE(rinex_navigation(*source, "G", kDriveStart, kDriveStart + 10.0, warnings).ok());
}

TEST_F(DriveTest, TheSkyIsFollowedInSteps) {
  const GnssConfig config;
  const auto receiver = sensor(config);
  const scene::SceneAt now(*scene_);
  const auto sky = follow_sky(*receiver, config, kDriveStart, 9.0, 3.0, {0.0, 0.0, 12.0}, now);
  ASSERT_EQ(sky.size(), 4u);
  EXPECT_EQ(sky[3].t_s, 9.0);
  EXPECT_EQ(sky[3].output.fix.t, kDriveStart + 9.0);
  const GnssObservation& first = sky[0].output.epoch.observations.front();
  EXPECT_EQ(cn0_of(sky[0].output, first.sv), first.cn0_dbhz);
  EXPECT_TRUE(std::isnan(cn0_of(sky[0].output, {GnssSystem::kGlonass, 1})));
  EXPECT_THAT(sky_dop_csv(sky), HasSubstr("\n9.000,"));
}

}  // namespace
}  // namespace canyon::gnss
