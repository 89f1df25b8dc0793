#include "canyon/inertial/catalogue.h"

#include <cmath>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/process/embedded.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/noise_terms.h"
#include "canyon/inertial/errors/flicker.h"
#include "canyon/inertial/imu_model.h"

namespace canyon::inertial {
namespace {

constexpr const char* kQuiet =
    "name = \"mine\"\n"
    "[gyro]\n"
    "arw_deg_per_sqrt_hr = 0\nturn_on_bias_deg_per_hr = 0\nin_run_bias_deg_per_hr = 0\nscale_ppm = 0\n"
    "misalignment_mrad = 0\n"
    "[accel]\n"
    "vrw_m_s_per_sqrt_hr = 0\nturn_on_bias_mg = 0\nin_run_bias_mg = 0\nscale_ppm = 0\nmisalignment_mrad = 0\n";

TEST(Catalogue, HoldsTheBuiltInUnits) {
  EXPECT_THAT(catalogue_names(),
              ::testing::IsSupersetOf({"adis16405", "adis16465", "adis16470", "adxl345", "adxl355", "adxl357", "bmi088",
                                       "hg1930_class", "hg4930_class", "high_grade_mems", "ideal", "mpu6050",
                                       "paper_low", "phidget_3_3_3", "stim300"}));
  for (const std::string& name : catalogue_names()) {
    const auto entry = load_catalogue_entry(name);
    ASSERT_TRUE(entry.ok()) << entry.error().str();
    EXPECT_EQ((*entry).name, name) << "the entry's name is its file's";
    EXPECT_FALSE((*entry).description.empty());
  }
}

/// Figures of the sheets in SI, worked out by hand: 0.005 deg/s/sqrt(Hz) and 400 ug/sqrt(Hz), one-sided, so over
/// sqrt(2); 250 deg/s, 16384 LSB/g.
TEST(Catalogue, FiguresOfTheLinksAreInSi) {
  const UnitFigures mpu = load_catalogue_entry("mpu6050")->figures();
  EXPECT_NEAR(mpu.gyro.white_per_sqrt_hz, 0.005 * kDegree / std::sqrt(2.0), 1e-10);  // six digits in the file
  EXPECT_NEAR(mpu.accel.white_per_sqrt_hz, 400e-6 * kStandardGravity / std::sqrt(2.0), 1e-8);
  EXPECT_NEAR(mpu.gyro.range, 250.0 * kDegree, 1e-12);
  EXPECT_NEAR(mpu.accel.resolution, kStandardGravity / 16384.0, 1e-11);
  EXPECT_NEAR(mpu.gyro.g_sensitivity, 0.1 * kDegree / kStandardGravity, 1e-15);
  EXPECT_NEAR(mpu.accel.bias_temperature, kMilliG, 1e-15);
  EXPECT_NEAR(mpu.gyro.scale_temperature, 320e-6, 1e-15);
  EXPECT_NEAR(mpu.gyro.nonlinearity, 0.002, 1e-15);
  for (const std::string& name : catalogue_names()) {
    const UnitFigures f = load_catalogue_entry(name)->figures();
    EXPECT_LE(f.gyro.in_run_bias, f.gyro.turn_on_bias) << name;
    EXPECT_LE(f.accel.in_run_bias, f.accel.turn_on_bias) << name;
    EXPECT_TRUE(f.accel.range == 0.0 || f.accel.resolution < f.accel.range) << name;
  }
}

/// The flicker noise of every entry has the floor that its sheet states, within 5 % from 30 to 3000 s.
TEST(Catalogue, FlickerNoiseHasTheFloorOfTheSheet) {
  for (const std::string& name : catalogue_names()) {
    const UnitFigures figures = load_catalogue_entry(name)->figures();
    for (const TriadFigures* f : {&figures.gyro, &figures.accel}) {
      if (f->bias_instability == 0.0) continue;
      for (const double tau_s : {30.0, 100.0, 300.0, 1000.0, 3000.0}) {
        double avar = 0.0;
        for (const FlickerPart& p : flicker_parts(f->bias_instability, f->flicker_low_hz, f->flicker_high_hz)) {
          avar += allan_variance(kGaussMarkov, p.sigma, p.tau_s, tau_s, 0.0);
        }
        EXPECT_NEAR(std::sqrt(avar) / f->bias_instability, 1.0, 0.05) << name << " at " << tau_s << " s";
      }
    }
  }
}

TEST(Catalogue, AnAccelerometerAloneTakesAnothersGyroscope) {
  const auto adxl = load_catalogue_entry("adxl355");
  ASSERT_TRUE(adxl.ok()) << adxl.error().str();
  EXPECT_FALSE((*adxl).has_gyroscope);
  ImuConfig config;
  config.sensor = "adxl355";
  const auto alone = make_error_chain(config, 1);
  ASSERT_FALSE(alone.ok());
  EXPECT_EQ(
      alone.error().str(),
      "imu.gyroscope: \"adxl355\" is an accelerometer alone, expected a sensor whose gyroscope goes with it, such as "
      "\"bmi088\"");
  config.gyroscope = "adxl345";
  EXPECT_EQ(make_error_chain(config, 1).error().str(),
            "imu.gyroscope: \"adxl345\" has none, expected a sensor that has a gyroscope");
  config.gyroscope = "bmi088";
  const auto both = make_error_chain(config, 1);
  ASSERT_TRUE(both.ok()) << both.error().str();
  EXPECT_EQ((*both)->noise().gyro.white_per_sqrt_hz, catalogue_noise("bmi088")->gyro.white_per_sqrt_hz);
  EXPECT_EQ((*both)->noise().accel.white_per_sqrt_hz, catalogue_noise("adxl355")->accel.white_per_sqrt_hz);
}

TEST(Catalogue, AnAccelerometerAloneHasNoGyroscopeTable) {
  const auto entry =
      parse_catalogue_entry("name = \"mine\"\nhas_gyroscope = false\n[gyro]\nscale_ppm = 1\n", "mine.toml");
  ASSERT_FALSE(entry.ok());
  EXPECT_EQ(entry.error().str(),
            "mine.toml:3: gyro: has_gyroscope = false, but there is a [gyro] table, expected one of the two");
}

TEST(Catalogue, FlickerCornersAreInOrder) {
  const std::string text = std::regex_replace(kQuiet, std::regex("\\[accel\\]"), "flicker_low_hz = 2.0\n[accel]");
  const auto entry = parse_catalogue_entry(text, "mine.toml");
  ASSERT_FALSE(entry.ok());
  EXPECT_THAT(entry.error().str(), ::testing::HasSubstr("gyro.flicker_low_hz: 2 Hz is not below the upper corner"));
}

TEST(Catalogue, ConvertsSheetUnitsOnce) {
  const auto noise = catalogue_noise("stim300");
  ASSERT_TRUE(noise.ok());
  // 0.15 deg/sqrt(h) = 4.3633e-5 rad/sqrt(s); 0.5 deg/h = 2.4241e-6 rad/s; 0.06 m/s/sqrt(h) = 1e-3; as NavToolkit
  // prints them.
  EXPECT_NEAR((*noise).gyro.white_per_sqrt_hz, 4.3633e-5, 5e-10);
  EXPECT_NEAR((*noise).gyro.in_run_bias_sigma, 2.4241e-6, 5e-11);
  EXPECT_NEAR((*noise).accel.white_per_sqrt_hz, 1e-3, 1e-15);
  EXPECT_DOUBLE_EQ((*noise).accel.turn_on_bias_sigma, 0.75 * kMilliG);
  EXPECT_DOUBLE_EQ((*noise).gyro.scale_sigma, 500e-6);
  EXPECT_DOUBLE_EQ((*noise).gyro.misalignment_sigma_rad, 1e-3);
}

TEST(Catalogue, HighGradeDriftsAboutThreeDegreesPerHour) {
  const ImuNoise noise = *catalogue_noise("high_grade_mems");
  const double drift_deg_hr = noise.gyro.turn_on_bias_sigma / kDegree * kHour;
  EXPECT_NEAR(drift_deg_hr, 3.0, 1e-12);  // the paper, section 2.2
}

TEST(Catalogue, LowFidelityIsTheSameUnitPerfectlyCalibrated) {
  const ImuNoise high = *catalogue_noise("high_grade_mems");
  const ImuNoise low = *catalogue_noise("paper_low");
  EXPECT_EQ(low.gyro.white_per_sqrt_hz, high.gyro.white_per_sqrt_hz);
  EXPECT_EQ(low.accel.white_per_sqrt_hz, high.accel.white_per_sqrt_hz);
  for (const TriadNoise& n : {low.gyro, low.accel}) {
    EXPECT_EQ(n.turn_on_bias_sigma, 0.0);
    EXPECT_EQ(n.in_run_bias_sigma, 0.0);
    EXPECT_EQ(n.scale_sigma, 0.0);
    EXPECT_EQ(n.misalignment_sigma_rad, 0.0);
    EXPECT_EQ(n.in_run_bias_tau_s, 1500.0);
  }
}

TEST(Catalogue, NamesTheNearestSensor) {
  const auto entry = load_catalogue_entry("stim30");
  ASSERT_FALSE(entry.ok());
  EXPECT_EQ(entry.error().str(), "imu.sensor: no sensor \"stim30\" in the catalogue, expected \"stim300\"?");
  EXPECT_EQ(entry.error().exit_code, 2);
}

// 2026-11-21: a file without its angular random walk ran as a gyroscope without noise, and nobody was told.
TEST(Catalogue, NoiseIsNeverZeroByOmission) {
  const std::string all = kQuiet;
  ASSERT_TRUE(parse_catalogue_entry(all, "mine.toml").ok()) << parse_catalogue_entry(all, "mine.toml").error().str();
  for (std::size_t begin = all.find('\n') + 1, end; begin < all.size(); begin = end + 1) {
    end = all.find('\n', begin);
    const std::string key = all.substr(begin, all.find(' ', begin) - begin);
    if (key[0] == '[') continue;
    const auto entry = parse_catalogue_entry(all.substr(0, begin) + all.substr(end + 1), "mine.toml");
    ASSERT_FALSE(entry.ok()) << key;
    EXPECT_THAT(entry.error().str(), ::testing::HasSubstr("." + key + ": is missing, expected a number from 0 to "));
  }
}

// 2026-11-22: they came one at a time, ten runs for ten keys.
TEST(Catalogue, AllThatIsMissingIsToldInOneMessage) {
  EXPECT_EQ(parse_catalogue_entry("name = \"mine\"\n", "mine.toml").error().str(),
            "mine.toml: gyro.arw_deg_per_sqrt_hr: is missing, and so are gyro.turn_on_bias_deg_per_hr, "
            "gyro.in_run_bias_deg_per_hr, gyro.scale_ppm, gyro.misalignment_mrad, accel.vrw_m_s_per_sqrt_hr, "
            "accel.turn_on_bias_mg, accel.in_run_bias_mg, accel.scale_ppm, accel.misalignment_mrad, expected a number "
            "from 0 to 1000");
  // Keys and sources together; sources alone.
  const std::string figures = "[gyro]\narw_deg_per_sqrt_hr = 0.3\nscale_ppm = 2\n";
  const std::string others = "turn_on_bias_deg_per_hr = 0\nin_run_bias_deg_per_hr = 0\nmisalignment_mrad = 0\n";
  const std::string accel =
      "[accel]\nvrw_m_s_per_sqrt_hr = 0\nturn_on_bias_mg = 0\nin_run_bias_mg = 0\nscale_ppm = 0\nmisalignment_mrad = "
      "0\n";
  EXPECT_EQ(parse_catalogue_entry("name = \"mine\"\n" + figures + accel, "mine.toml").error().str(),
            "mine.toml:2: gyro.turn_on_bias_deg_per_hr: is missing, and so are gyro.in_run_bias_deg_per_hr, "
            "gyro.misalignment_mrad, gyro.arw_source, gyro.scale_source, expected a number from 0 to 1e+06");
  EXPECT_EQ(parse_catalogue_entry("name = \"mine\"\n" + figures + others + accel, "mine.toml").error().str(),
            "mine.toml:2: gyro.arw_source: is missing, and so are gyro.scale_source, expected the source of a figure "
            "that is not zero");
  // A misspelt key is still told first.
  EXPECT_EQ(parse_catalogue_entry("name = \"mine\"\n[gyro]\nscale_pm = 2\n", "mine.toml").error().line, 3);
}

TEST(Catalogue, RefusesAFigureWithoutSource) {
  const auto entry = parse_catalogue_entry(
      std::regex_replace(kQuiet, std::regex("arw_deg_per_sqrt_hr = 0"), "arw_deg_per_sqrt_hr = 0.3"), "mine.toml");
  ASSERT_FALSE(entry.ok());
  EXPECT_THAT(entry.error().str(), ::testing::HasSubstr("gyro.arw_source"));
  EXPECT_THAT(entry.error().str(), ::testing::StartsWith("mine.toml:"));
}

// What is assumed must not look like a sheet's figure, in no file. (A figure without any source is refused on reading.)
TEST(Catalogue, AssumptionsSayThatTheyAre) {
  const std::regex source("(\\w*source) = \"(.*)\"");
  int assumed = 0, read = 0;
  for (const std::string& name : catalogue_names()) {
    const std::string text(*embedded_file("inertial/catalogue/" + name + ".toml"));
    for (std::sregex_iterator at(text.begin(), text.end(), source), end; at != end; ++at) {
      const std::string words = (*at)[2];
      EXPECT_GE(words.size(), 10U) << name << ": " << words;
      const bool says = words.rfind("assumed", 0) == 0;
      (says ? assumed : read) += 1;
      if (says) continue;
      for (const char* doubt : {"assum", "remember", "not checked", "at hand", "class value"})
        EXPECT_EQ(words.find(doubt), std::string::npos) << name << ": " << words;
    }
  }
  EXPECT_GT(assumed, 100);
  EXPECT_GT(read, 100);
}

// ADIS16470: the sheet states the density and the random walk it makes; N is the density over sqrt(2).
TEST(Catalogue, RandomWalkIsTheDensityOverRootTwo) {
  const double density = 0.008 * kDegree;
  EXPECT_NEAR(load_catalogue_entry("adis16470")->noise().gyro.white_per_sqrt_hz / (density / std::sqrt(2.0)), 1.0,
              0.005);  // 0.34 has two digits
}

TEST(Catalogue, RefusesUnknownKeysAndValuesOutOfRange) {
  const auto typo = parse_catalogue_entry("name = \"mine\"\n[gyro]\narw_deg_per_sqr_hr = 0.3\n", "mine.toml");
  ASSERT_FALSE(typo.ok());
  EXPECT_THAT(typo.error().str(), ::testing::AllOf(::testing::StartsWith("mine.toml:3: gyro.arw_deg_per_sqr_hr"),
                                                   ::testing::HasSubstr("arw_deg_per_sqrt_hr")));
  const auto negative = parse_catalogue_entry("name = \"mine\"\n[accel]\nscale_ppm = -1.0\n", "mine.toml");
  ASSERT_FALSE(negative.ok());
  EXPECT_THAT(negative.error().str(), ::testing::StartsWith("mine.toml:3: accel.scale_ppm"));
}

}  // namespace
}  // namespace canyon::inertial
