#include "canyon/inertial/imu_model.h"

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/inertial/catalogue.h"
#include "canyon/inertial/mounting.h"
#include "canyon/inertial/true_increments.h"

namespace canyon::inertial {
namespace {

class StrapdownImu final : public ImuModel {
 public:
  StrapdownImu(const LocalFrame& frame, const Eigen::Vector3d& lever_arm_m,
               const std::optional<Eigen::Quaterniond>& R_BU, std::unique_ptr<ErrorChain> errors)
      : frame_(frame), lever_arm_m_(lever_arm_m), R_BU_(R_BU), errors_(std::move(errors)) {}

  ImuSample sample(std::int64_t k, std::span<const KinematicState> nodes) override {
    return measured(k, true_increments(nodes, frame_, lever_arm_m_));
  }
  ImuSample sample(std::int64_t k, const TrueMotion& motion, GpsTime from, GpsTime to) override {
    return measured(k, true_increments(motion, from, to, frame_, lever_arm_m_));
  }
  Eigen::Quaterniond R_BU() const override { return R_BU_.value_or(Eigen::Quaterniond::Identity()); }
  const ImuNoise& noise() const override { return errors_->noise(); }

 private:
  /// `sample`: along the axes of B.
  ImuSample measured(std::int64_t k, ImuSample sample) {
    CANYON_CHECK(k >= 0, "sample number = ", k);
    if (R_BU_) sample = seen_askew(sample, *R_BU_);
    errors_->corrupt(k, sample);
    return sample;
  }

  LocalFrame frame_;
  Eigen::Vector3d lever_arm_m_;
  std::optional<Eigen::Quaterniond> R_BU_;
  std::unique_ptr<ErrorChain> errors_;
};

}  // namespace

void visit(FieldVisitor& f, ImuConfig& c) {
  f.file("sensor", c.sensor, ".toml", "entry of the sensor catalogue, or a TOML file of your own sensor");
  f.file("gyroscope", c.gyroscope, ".toml", "entry whose gyroscope goes with a sensor that is an accelerometer alone");
  f.choice("errors", c.errors, model_names(error_chains()), "error chain");
  f.texts("leave_out", c.leave_out, "links of the error chain that are switched off, by name (docs/inertial.md)");
  f.number("rate_hz", c.rate_hz, {10, 5000}, "samples per second");
  f.vector3("lever_arm_m", c.lever_arm_m, {-100, 100}, "IMU in the body frame");
  f.number("mounting_error_deg", c.mounting_error_deg, {0, 30},
           "how askew it sits, and nobody knows: angles between its axes and the body's, each, 1-sigma; constant over "
           "a run");
  f.numbers("temperature_times_s", c.temperature_times_s, 0, {0, 1e9},
            "corners of the unit's temperature over the run; empty: the temperature its figures hold for");
  f.numbers("temperatures_c", c.temperatures_c, 0, {-100, 200}, "temperatures at these times, constant outside");
  f.old_key("vibration_g", "imu.vibration_m_s2, in m/s^2 (1 g = 9.80665 m/s^2)");
  f.vector3("vibration_m_s2", c.vibration_m_s2, {0, 1000}, "RMS of vibration too fast for the samples, per axis");
}

namespace {

Result<CatalogueEntry> entry_of(const ImuConfig& config) {
  CANYON_TRY(CatalogueEntry entry, load_catalogue_entry(config.sensor));
  if (config.gyroscope.empty()) {
    if (entry.has_gyroscope) return entry;
    return Error{.file = "",
                 .key = "imu.gyroscope",
                 .what = "\"" + entry.name + "\" is an accelerometer alone",
                 .expected = "a sensor whose gyroscope goes with it, such as \"bmi088\""};
  }
  CANYON_TRY(const CatalogueEntry other, load_catalogue_entry(config.gyroscope));
  if (entry.has_gyroscope || !other.has_gyroscope) {
    const bool already = entry.has_gyroscope;
    return Error{.file = "",
                 .key = "imu.gyroscope",
                 .what = "\"" + (already ? entry.name : other.name) + (already ? "\" has its own" : "\" has none"),
                 .expected = already ? "no gyroscope beside it" : "a sensor that has a gyroscope"};
  }
  entry.gyro = other.gyro;
  entry.has_gyroscope = true;
  return entry;
}

Result<Environment> environment_of(const ImuConfig& config) {
  const auto& times = config.temperature_times_s;
  const auto& temperatures = config.temperatures_c;
  if (times.size() != temperatures.size()) {
    return Error{.file = "",
                 .key = "imu.temperatures_c",
                 .what = join_values(temperatures.size(), " temperatures for ", times.size(), " times"),
                 .expected = "as many as imu.temperature_times_s"};
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) continue;
    return Error{.file = "",
                 .key = "imu.temperature_times_s",
                 .what = join_values(times[i], " s comes after ", times[i - 1], " s"),
                 .expected = "times that increase"};
  }
  return Environment{
      .temperature_times_s = times, .temperatures_c = temperatures, .vibration_rms_m_s2 = config.vibration_m_s2};
}

}  // namespace

Result<std::unique_ptr<ErrorChain>> make_error_chain(const ImuConfig& config, std::uint64_t seed,
                                                     std::optional<std::uint64_t> noise_seed) {
  ChainSetup setup{.entry = {},
                   .seed = seed,
                   .rate_hz = config.rate_hz,
                   .leave_out = config.leave_out,
                   .environment = {},
                   .noise_seed = noise_seed};
  CANYON_TRY(setup.entry, entry_of(config));
  CANYON_TRY(setup.environment, environment_of(config));
  return make_error_chain(config.errors, setup);
}

Result<ImuNoise> datasheet_noise(const ImuConfig& config) {
  CANYON_TRY(const CatalogueEntry entry, entry_of(config));
  return entry.noise();
}

Result<std::unique_ptr<ImuModel>> make_imu(const ImuConfig& config, std::uint64_t seed, const LocalFrame& frame,
                                           std::optional<std::uint64_t> noise_seed) {
  CANYON_TRY(std::unique_ptr<ErrorChain> errors, make_error_chain(config, seed, noise_seed));
  return std::unique_ptr<ImuModel>(
      std::make_unique<StrapdownImu>(frame, config.lever_arm_m, mounting(config, seed), std::move(errors)));
}

}  // namespace canyon::inertial
