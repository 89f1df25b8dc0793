#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/mems/sensing_element.h"

namespace canyon::inertial {
namespace {

/// Three elements of one kind.
class Triad {
 public:
  Triad(const ElementModel& model, double electronics_n, const std::string& integrator, double dt_s,
        const RandomStream& stream)
      : axes_{SensingElement(model, electronics_n, integrator, dt_s, stream, 0),
              SensingElement(model, electronics_n, integrator, dt_s, stream, 1),
              SensingElement(model, electronics_n, integrator, dt_s, stream, 2)} {}

  void settle(const Eigen::Vector3d& input) {
    for (int i = 0; i < 3; ++i) axes_[static_cast<std::size_t>(i)].settle(input[i]);
  }
  double memory_per_step() const { return axes_[0].memory_per_step(); }
  Eigen::Vector3d advance(std::int64_t k, const Eigen::Vector3d& input) {
    Eigen::Vector3d out;
    for (int i = 0; i < 3; ++i) out[i] = axes_[static_cast<std::size_t>(i)].advance(k, input[i]);
    return out;
  }

 private:
  std::array<SensingElement, 3> axes_;
};

/// The proof masses take the place of the sheet's white noise and, with the pick-off's curve, of its nonlinearity;
/// biases, gains, the output's limits and the rest are the links of "full". An element's state depends on the motion
/// before, as long as it remembers: where the samples asked for do not follow the last ones, it is carried up to them
/// from `own_memory` samples before, at rest in the present motion, which nobody told it otherwise.
class PhysicsChain final : public ErrorChain {
 public:
  PhysicsChain(std::optional<Triad> gyro, Triad accel, std::unique_ptr<ErrorChain> links, const ImuNoise& noise)
      : gyro_(std::move(gyro)), accel_(std::move(accel)), links_(std::move(links)), noise_(noise) {
    const double least = std::max(gyro_ ? gyro_->memory_per_step() : 0.0, accel_.memory_per_step());
    own_memory_ = least > 0.0 ? static_cast<std::int64_t>(std::ceil(std::log(kForgotten) / std::log(least))) : 0;
  }

  void corrupt(std::int64_t k, ImuSample& sample) override {
    const Eigen::Vector3d rate = sample.dtheta_U / sample.dt_s, force = sample.dv_U / sample.dt_s;
    if (k != next_ || next_ == 0) {
      if (gyro_) gyro_->settle(rate);
      accel_.settle(force);
      next_ = std::max<std::int64_t>(0, k - own_memory_);
    }
    for (; next_ <= k; ++next_) {
      if (gyro_) sample.dtheta_U = gyro_->advance(next_, rate);
      sample.dv_U = accel_.advance(next_, force);
    }
    links_->corrupt(k, sample);
  }
  std::int64_t memory() const override { return own_memory_ + links_->memory(); }
  const ImuNoise& noise() const override { return noise_; }

 private:
  /// What is left of a state that counts as forgotten: less than double precision holds.
  static constexpr double kForgotten = 1e-16;

  std::optional<Triad> gyro_;
  Triad accel_;
  std::unique_ptr<ErrorChain> links_;
  ImuNoise noise_;
  std::int64_t next_ = 0, own_memory_ = 0;
};

/// What [mems] leaves to the sheet: range and bandwidth, where it gives none.
ElementFigures completed(ElementFigures f, double sheet_range, double sheet_bandwidth_hz, double rate_hz) {
  if (f.range == 0.0) f.range = sheet_range;
  if (f.bandwidth_hz == 0.0) f.bandwidth_hz = sheet_bandwidth_hz > 0.0 ? sheet_bandwidth_hz : 0.4 * rate_hz;
  return f;
}

/// White noise of the electronics: what the sheet's figure leaves beside mass and pick-off.
Result<double> electronics_n(const ElementModel& model, double sheet_n, const char* key) {
  if (sheet_n == 0.0) return 0.0;
  const double physical = std::hypot(model.thermal_n, model.pick_off_n);
  if (physical <= sheet_n) return std::sqrt(sheet_n * sheet_n - physical * physical);
  return Error{
      .key = std::string("mems.") + key + ".mass_kg",
      .what = join_values("noise of mass and pick-off, ", physical, " per root hertz, is above the sheet's ", sheet_n),
      .expected = "a heavier mass, a larger quality factor or a better pick-off"};
}

Status check_stable(const Triad& triad, const std::string& integrator, double rate_hz) {
  const double factor = triad.memory_per_step();
  if (factor < 1.0) return Ok{};
  return Error{.key = "imu.sensor, imu.rate_hz",
               .what = join_values("its mems.integrator \"", integrator, "\" multiplies the motion of the masses by ",
                                   factor, " with every sample at ", rate_hz, " Hz: it diverges"),
               .expected = "mems.integrator = \"exact\", or an imu.rate_hz that is high enough"};
}

}  // namespace

Result<std::unique_ptr<ErrorChain>> make_physics_chain(const ChainSetup& setup) {
  const CatalogueEntry& e = setup.entry;
  if (!e.mems.given)
    return Error{.key = "imu.errors",
                 .what = "sensor \"" + e.name + "\" has no proof masses",
                 .expected = "a sensor with a [mems] table, such as \"high_grade_mems\""};
  const double dt_s = 1.0 / setup.rate_hz;
  const UnitFigures sheet = e.figures();
  std::optional<Triad> gyro;
  if (e.has_gyroscope) {
    CANYON_TRY(const ElementModel model, gyroscope_model(completed(e.mems.gyro, e.gyro.range_deg_per_s.value,
                                                                   e.gyro.bandwidth_hz.value, setup.rate_hz),
                                                         e.mems.temperature_k));
    CANYON_TRY(const double rest, electronics_n(model, sheet.gyro.white_per_sqrt_hz, "gyro"));
    gyro.emplace(model, rest, e.mems.integrator, dt_s, RandomStream(setup.seed, "imu.gyro.mems"));
    CANYON_TRY_STATUS(check_stable(*gyro, e.mems.integrator, setup.rate_hz));
  }
  CANYON_TRY(const ElementModel model, accelerometer_model(completed(e.mems.accel, e.accel.range_g.value,
                                                                     e.accel.bandwidth_hz.value, setup.rate_hz),
                                                           e.mems.temperature_k));
  CANYON_TRY(const double rest, electronics_n(model, sheet.accel.white_per_sqrt_hz, "accel"));
  Triad accel(model, rest, e.mems.integrator, dt_s, RandomStream(setup.seed, "imu.accel.mems"));
  CANYON_TRY_STATUS(check_stable(accel, e.mems.integrator, setup.rate_hz));

  ChainSetup others = setup;
  for (const char* link : {"white_noise", "nonlinearity"}) others.leave_out.emplace_back(link);
  CANYON_TRY(auto links, make_full_chain(others));
  ImuNoise noise = links->noise();
  const ImuNoise of_sheet = e.noise();
  noise.gyro.white_per_sqrt_hz = of_sheet.gyro.white_per_sqrt_hz;
  noise.accel.white_per_sqrt_hz = of_sheet.accel.white_per_sqrt_hz;
  return std::unique_ptr<ErrorChain>(
      std::make_unique<PhysicsChain>(std::move(gyro), std::move(accel), std::move(links), noise));
}

}  // namespace canyon::inertial
