#include <cmath>

#include "core/random.h"
#include "inertial/error_chain.h"
#include "inertial/gauss_markov.h"

namespace canyon::inertial {
namespace {

/// The errors of one triad: increments = (I + S + M) true + (b_turn_on + b_in_run) dt + N sqrt(dt) n.
/// S is diagonal (scale factor), M has a zero diagonal (misalignment, six independent terms). White noise is defined
/// per root hertz, so its variance grows with the interval and does not depend on the sample rate.
class TriadErrors {
 public:
  TriadErrors(const TriadNoise& noise, std::uint64_t seed, const std::string& name, double dt_s)
      : white_(seed, name + ".white"),
        white_per_sqrt_hz_(noise.white_per_sqrt_hz),
        in_run_(RandomStream(seed, name + ".in_run"), noise.in_run_bias_sigma, noise.in_run_bias_tau_s, dt_s) {
    turn_on_ = noise.turn_on_bias_sigma * RandomStream(seed, name + ".turn_on").normal3(0);
    const Eigen::Vector3d scale = noise.scale_sigma * RandomStream(seed, name + ".scale").normal3(0);
    const RandomStream misalignment(seed, name + ".misalignment");
    gain_ = scale.asDiagonal();
    for (int row = 0; row < 3; ++row) {
      for (int j = 0; j < 2; ++j) {
        const int column = (row + 1 + j) % 3;
        gain_(row, column) = noise.misalignment_sigma_rad *
                             misalignment.normal(static_cast<std::uint32_t>(row), 0, static_cast<std::uint32_t>(j));
      }
    }
  }

  void corrupt(std::int64_t k, double dt_s, Eigen::Vector3d& increment) {
    Eigen::Vector3d error = gain_ * increment + (turn_on_ + in_run_.at(k)) * dt_s;
    if (white_per_sqrt_hz_ > 0.0) {
      error += white_per_sqrt_hz_ * std::sqrt(dt_s) * white_.normal3(static_cast<std::uint64_t>(k));
    }
    increment += error;
  }

 private:
  RandomStream white_;
  double white_per_sqrt_hz_;
  GaussMarkov in_run_;
  Eigen::Vector3d turn_on_;
  Eigen::Matrix3d gain_;
};

class DatasheetChain final : public ErrorChain {
 public:
  DatasheetChain(const ImuNoise& noise, std::uint64_t seed, double rate_hz)
      : noise_(noise),
        gyro_(noise.gyro, seed, "imu.gyro", 1.0 / rate_hz),
        accel_(noise.accel, seed, "imu.accel", 1.0 / rate_hz) {}

  void corrupt(std::int64_t k, ImuSample& sample) override {
    gyro_.corrupt(k, sample.dt_s, sample.dtheta_U);
    accel_.corrupt(k, sample.dt_s, sample.dv_U);
  }
  const ImuNoise& noise() const override { return noise_; }

 private:
  ImuNoise noise_;
  TriadErrors gyro_, accel_;
};

/// The paper's low fidelity: "perfect calibration, with no bias or scale effects and a correlation time of 1500
/// seconds".
TriadNoise white_part(const TriadNoise& noise) {
  TriadNoise white;
  white.white_per_sqrt_hz = noise.white_per_sqrt_hz;
  white.in_run_bias_tau_s = 1500.0;
  return white;
}

}  // namespace

Result<std::unique_ptr<ErrorChain>> make_datasheet_chain(const CatalogueEntry& entry, std::uint64_t seed,
                                                         double rate_hz) {
  return std::unique_ptr<ErrorChain>(std::make_unique<DatasheetChain>(entry.noise(), seed, rate_hz));
}

Result<std::unique_ptr<ErrorChain>> make_white_only_chain(const CatalogueEntry& entry, std::uint64_t seed,
                                                          double rate_hz) {
  const ImuNoise full = entry.noise();
  const ImuNoise white{.gyro = white_part(full.gyro), .accel = white_part(full.accel)};
  return std::unique_ptr<ErrorChain>(std::make_unique<DatasheetChain>(white, seed, rate_hz));
}

}  // namespace canyon::inertial
