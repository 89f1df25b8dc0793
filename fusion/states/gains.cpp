#include <array>

#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {
namespace {

struct GainParameters {
  double imu_gain_tau_s = 0.0;
};
void visit(FieldVisitor& f, GainParameters& p) {
  f.number("imu_gain_tau_s", p.imu_gain_tau_s, {0, 1e9}, "correlation time of the gains; 0: constant over a run");
}

/// Gain errors of the two triads, a row-major 3 x 3 each: scale factors on the diagonal, misalignments off it (rad).
///   gyroscopes: measured = (I + K_g) w + b_g + noise      accelerometers: measured = (I + K_a) f + b_a + noise
/// In a 90 degree turn 500 ppm and 1 mrad make larger errors of heading and tilt than the noise does, and a filter that
/// does not know of them is too confident (measured: heading NEES 104 instead of 1).
class Gains final : public StateBlock {
 public:
  Gains(const GainParameters& p, const ImuNoise& noise) : triads_{noise.gyro, noise.accel}, tau_s_(p.imu_gain_tau_s) {}

  int size() const override { return 18; }
  double variance(int state) const override {
    const TriadNoise& noise = triads_[static_cast<std::size_t>(state / 9)];
    const double sigma = state % 9 % 4 == 0 ? noise.scale_sigma : noise.misalignment_sigma_rad;
    return sigma * sigma;
  }
  StateProcess process(int state) const override {
    if (tau_s_ == 0.0) return {};
    return StateProcess::gauss_markov(variance(state), tau_s_);
  }
  void feed(const Increments& in, std::vector<Feed>& feeds) const override {
    for (int i = 0; i < 6; ++i) {
      const Eigen::Vector3d rate = (i < 3 ? in.dtheta_U : in.dv_U) / in.dt_s;
      for (int j = 0; j < 3; ++j) feeds.push_back({.axis = i, .state = 3 * i + j, .rate = rate[j]});
    }
  }
  void calibrate(std::span<const double> values, Calibration& imu) const override {
    using Gain = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
    imu.set_gains(Gain(values.data()), Gain(values.data() + 9));
  }

 private:
  std::array<TriadNoise, 2> triads_;
  double tau_s_;
};

bool has_gain_errors(const TriadNoise& noise) {
  return noise.scale_sigma > 0.0 || noise.misalignment_sigma_rad > 0.0;
}

}  // namespace

std::unique_ptr<StateBlock> make_gains(const ModelParameters& own, const StateSetup& setup) {
  if (!has_gain_errors(setup.noise.gyro) && !has_gain_errors(setup.noise.accel)) return nullptr;
  return std::make_unique<Gains>(own.get<GainParameters>(), setup.noise);
}

void gains_parameters(ModelParameters& section) {
  section.add<GainParameters>();
}

}  // namespace canyon::fusion
