#include <algorithm>
#include <cmath>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/models.h"
#include "canyon/inertial/motion/rigid_motion.h"

namespace canyon::inertial {
namespace {

/// One sinusoid of all six coordinates: x, y, z (m) and roll, pitch, yaw (rad).
struct Wave {
  double rate_rad_s;
  double amplitude[6];
  double phase_rad[6];
};

class Vibrating final : public Motion {
 public:
  Vibrating(std::shared_ptr<const Motion> motion, std::vector<Wave> waves)
      : motion_(std::move(motion)), waves_(std::move(waves)) {}
  double duration_s() const override { return motion_->duration_s(); }
  KinematicState at(double t_s) const override {
    std::array<Series, 6> x;
    for (const Wave& wave : waves_) {
      for (std::size_t i = 0; i < 6; ++i) {
        if (wave.amplitude[i] == 0.0) continue;
        const double r = wave.rate_rad_s, angle = r * t_s + wave.phase_rad[i];
        const double s = wave.amplitude[i] * std::sin(angle), c = wave.amplitude[i] * std::cos(angle);
        x[i] = x[i] + Series{s, r * c, -0.5 * r * r * s, -r * r * r * c / 6.0};
      }
    }
    return compose(motion_->at(t_s), kinematics({x[0], x[1], x[2]}, quaternion_from(x[5], x[4], x[3])));
  }

 private:
  std::shared_ptr<const Motion> motion_;
  std::vector<Wave> waves_;
};

Wave wave_of(const Sinusoid& sinusoid) {
  Wave wave{2.0 * kPi * sinusoid.frequency_hz, {}, {}};
  for (int i = 0; i < 3; ++i) {
    wave.amplitude[i] = -sinusoid.acceleration_m_s2[i] / (wave.rate_rad_s * wave.rate_rad_s);
    wave.amplitude[i + 3] = sinusoid.angle_deg[i] * kDegree;
    wave.phase_rad[i] = wave.phase_rad[i + 3] = sinusoid.phase_deg * kDegree;
  }
  return wave;
}

/// The density at a frequency within the table, linear in both logarithms.
double density(const VibrationConfig& c, double hz) {
  const auto next = std::upper_bound(c.psd_hz.begin() + 1, c.psd_hz.end() - 1, hz);
  const auto i = static_cast<std::size_t>(next - c.psd_hz.begin());
  const double x = std::log(hz / c.psd_hz[i - 1]) / std::log(c.psd_hz[i] / c.psd_hz[i - 1]);
  return c.psd_g2_per_hz[i - 1] * std::pow(c.psd_g2_per_hz[i] / c.psd_g2_per_hz[i - 1], x);
}

/// Random vibration as sinusoids of random phases, one in each of equal steps of the logarithm of frequency, at a
/// random place in it, of the power the density has there (Shinozuka & Jan 1972): exact derivatives, and the right
/// variance.
void add_random(std::vector<Wave>& waves, const VibrationConfig& c, std::uint64_t seed) {
  const RandomStream place(seed, "imu.vibration.frequency"), phase(seed, "imu.vibration.phase");
  const double ratio = c.psd_hz.back() / c.psd_hz.front();
  for (std::int64_t line = 0; line < c.psd_lines; ++line) {
    const auto k = static_cast<std::uint64_t>(line);
    const double low = c.psd_hz.front() * std::pow(ratio, static_cast<double>(line) / static_cast<double>(c.psd_lines));
    const double high =
        c.psd_hz.front() * std::pow(ratio, static_cast<double>(line + 1) / static_cast<double>(c.psd_lines));
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const double hz = place.uniform(low, high, axis, k);
      Wave wave{2.0 * kPi * hz, {}, {}};
      wave.amplitude[axis] =
          std::sqrt(2.0 * density(c, hz) * (high - low)) * kStandardGravity / (wave.rate_rad_s * wave.rate_rad_s);
      wave.phase_rad[axis] = phase.uniform(0.0, 2.0 * kPi, axis, k);
      waves.push_back(wave);
    }
  }
}

}  // namespace

Result<std::shared_ptr<const Motion>> with_vibration(std::shared_ptr<const Motion> motion,
                                                     const VibrationConfig& config, std::uint64_t seed) {
  if (config.psd_hz.size() != config.psd_g2_per_hz.size() || config.psd_hz.size() == 1)
    return Error{.key = "vibration.psd_g2_per_hz",
                 .what = std::to_string(config.psd_g2_per_hz.size()) + " densities at " +
                         std::to_string(config.psd_hz.size()) + " frequencies",
                 .expected = "as many of one as of the other, and at least two"};
  if (!std::is_sorted(config.psd_hz.begin(), config.psd_hz.end(), std::less_equal<>()))
    return Error{.key = "vibration.psd_hz", .what = "frequencies do not increase", .expected = "ascending frequencies"};
  std::vector<Wave> waves;
  for (const Sinusoid& sinusoid : config.sinusoid) waves.push_back(wave_of(sinusoid));
  if (!config.psd_hz.empty()) add_random(waves, config, seed);
  if (waves.empty()) return motion;
  return std::shared_ptr<const Motion>(std::make_shared<Vibrating>(std::move(motion), std::move(waves)));
}

}  // namespace canyon::inertial
