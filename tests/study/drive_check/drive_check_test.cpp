#include "canyon/study/drive_check/drive_check.h"

#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "canyon/core/units.h"
#include "canyon/gnss/rinex/navigation/navigation_writer.h"
#include "canyon/gnss/sensor/simulation/drive_files.h"
#include "canyon/scene/scene_at.h"
#include "canyon/study/drive_check/simulated_log.h"
#include "canyon/tests/gnss/paths/wall_scene.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::study {
namespace {

const GpsTime kStart = GpsTime::from_week_sow(1610, 306000.0);

/// A drive of 20 s at 5 m/s northwards, walls of 30 m to the west and 12 m to the east; GPS and GLONASS of the built-in
/// constellation.
class DriveCheckTest : public ::testing::Test {
 protected:
  DriveCheckTest() {
    scene_ = gnss::testing::WallScene()
                 .wall({-15, -200, 0}, {0, 400, 0}, {0, 0, 30})
                 .wall({15, -200, 0}, {0, 400, 0}, {0, 0, 12})
                 .build();
    for (int k = 0; k <= 20; ++k)
      reference_.push_back({kStart + k, scene_->frame().to_E({0.0, 5.0 * k - 50.0, 2.0}), 0});
    receiver_.satellites.systems = solver_.systems = "GR";
    receiver_.mode.name = "single";
    receiver_.ephemeris_error.name = "none";
    receiver_.receiver_clock.name = "none";
    receiver_.propagation.paths.name = "specular1";
    receiver_.reception.multipath_rule.name = "correlator";
    receiver_.tracking.thermal_noise_scale = 0.0;
    source_ = *make_satellite_source(receiver_.satellites, kStart, kStart + 20.0);
    std::vector<std::string> warnings;
    const std::string text = *rinex_navigation(source_, "GR", kStart, kStart + 20.0, warnings);
    receiver_.satellites.nav_file = canyon::testing::temporary_file("drive.nav");
    std::ofstream(receiver_.satellites.nav_file) << text;
    data_.observations.name = "drive.obs";
    for (int k = 0; k <= 20; ++k) {
      gnss::ObservationEpoch epoch;
      epoch.t = kStart + k;
      data_.observations.epochs.push_back(epoch);
    }
  }

  DriveCheckInputs inputs() const {
    return {.data = data_,
            .reference = reference_,
            .reference_name = "truth.csv",
            .scene_name = "city.geojson",
            .scene = *scene_,
            .receiver = receiver_,
            .solver = solver_};
  }
  /// The simulated receiver's own log in the place of the recorded one.
  void record_the_simulated() {
    std::vector<std::string> warnings;
    const PlacePath truth(reference_);
    std::vector<GpsTime> epochs;
    for (const auto& epoch : data_.observations.epochs) epochs.push_back(epoch.t);
    auto log = *simulated_log(inputs(), truth, epochs, warnings);
    data_.observations = std::move(log.observations);
    data_.observations.name = "drive.obs";
    data_.navigation = log.source.navigation;
    data_.constellation = gnss::make_broadcast(data_.navigation, {.systems = "GR"});
  }
  std::vector<DriveEpoch> signals() const {
    const PlacePath truth(reference_);
    return drive_signals(data_.observations, *data_.constellation, data_.navigation, solver_,
                         {.truth = truth, .scene = *scene_});
  }

  std::unique_ptr<scene::Scene> scene_;
  std::vector<StampedPlace> reference_;
  gnss::GnssConfig receiver_;
  gnss::SinglePointConfig solver_;
  gnss::SatelliteSource source_;
  gnss::RecordedData data_;
};

// The same receiver on both sides: every figure is the same, to the bit.
TEST_F(DriveCheckTest, ALogOfTheSimulationItselfAgreesWithIt) {
  record_the_simulated();
  const DriveCheck check = *check_drive(inputs());
  const Json json = drive_check_json(check);
  EXPECT_EQ(json["simulated"].dump(), json["measured"].dump());
  EXPECT_EQ(json["epochs"], 21);
  EXPECT_GT(check.measured.figures.tracked_hidden, 0.0);
  EXPECT_GT(check.measured.figures.tracked_in_sight, 4.0);
  EXPECT_THAT(drive_check_text(check), ::testing::HasSubstr("21 epochs of the log, 21 instants of the reference\n"));
}

// What a receiver's clock, a system's delay, and a single satellite's error do to the errors.
TEST_F(DriveCheckTest, OffsetsGoWhereTheyBelong) {
  record_the_simulated();
  const auto before = signals();
  const auto hidden = std::find_if(before[5].signals.begin(), before[5].signals.end(), [](const DriveSignal& s) {
    return !s.in_sight && s.sv.system == GnssSystem::kGps && std::isfinite(s.error_m);
  });
  ASSERT_NE(hidden, before[5].signals.end());
  const SatelliteId late = hidden->sv;
  for (gnss::ObservationEpoch& epoch : data_.observations.epochs) {
    for (gnss::SatelliteObservations& one : epoch.satellites) {
      const auto& codes = data_.observations.codes(epoch, one.sv.system);
      for (std::size_t i = 0; i < codes.size(); ++i) {
        double& value = one.values[i].value;
        if (codes[i].kind == 'C')
          value += 5.0 + (one.sv.system == GnssSystem::kGlonass ? 7.0 : 0.0) + (one.sv == late ? 25.0 : 0.0);
        if (codes[i].kind == 'D' && one.sv == late) value -= 10.0;
      }
    }
  }
  const auto after = signals();
  ASSERT_EQ(after.size(), before.size());
  int seen = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    for (std::size_t i = 0; i < before[k].signals.size(); ++i) {
      const DriveSignal &a = before[k].signals[i], &b = after[k].signals[i];
      ASSERT_EQ(a.sv, b.sv);
      if (!std::isfinite(a.error_m)) continue;
      // 7 m later a satellite is placed 23 ns earlier, where it is within 0.1 mm; RINEX has millimetres, but the same.
      EXPECT_NEAR(b.error_m - a.error_m, a.sv == late ? 25.0 : 0.0, 1e-3) << a.sv.str();
      if (a.sv != late) continue;
      ++seen;
      ASSERT_EQ(a.sv.system, GnssSystem::kGps);
      EXPECT_NEAR(b.rate_error_m_s - a.rate_error_m_s, 10.0 * gnss::kL1WavelengthM, 1e-3);
    }
  }
  EXPECT_GT(seen, 0);
}

TEST_F(DriveCheckTest, MistakesAreOneLine) {
  reference_.front().t = kStart + 100.0;
  reference_.resize(1);
  reference_.push_back({kStart + 110.0, reference_[0].p_E, 0});
  auto none = check_drive(inputs());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().str(),
            "drive.obs: has no epoch at a time of truth.csv, expected a reference of the same time");
}

TEST_F(DriveCheckTest, ACityThatDoesNotCoverSaysHowManyEpochs) {
  // Bounds in north: the wall's -200 to 200; from the eighth second on the drive is 300 m farther.
  scene_ = gnss::testing::WallScene().box({-15, -200, 0}, {15, 200, 1}).build();
  for (int k = 8; k <= 20; ++k) reference_[static_cast<std::size_t>(k)].p_E = scene_->frame().to_E({0.0, 300.0, 2.0});
  auto part = check_drive(inputs());
  ASSERT_FALSE(part);
  EXPECT_EQ(part.error().str(),
            "city.geojson: covers 8 of 21 epochs of the drive, expected a city around all of it, or --from-sow and "
            "--to-sow of the stretch that it covers");
}

}  // namespace
}  // namespace canyon::study
