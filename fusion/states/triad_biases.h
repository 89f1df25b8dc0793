#pragma once

#include <array>

#include "canyon/fusion/states/state_block.h"

namespace canyon::fusion {

/// Six biases, of the gyroscopes (rad/s) and of the accelerometers (m/s^2), alike on the three axes of a triad.
class TriadBiases : public StateBlock {
 public:
  struct Triad {
    double variance = 0.0;
    StateProcess process;
  };
  TriadBiases(const Triad& gyro, const Triad& accel) : triads_{gyro, accel} {}

  int size() const override { return 6; }
  double variance(int state) const override { return triads_[static_cast<std::size_t>(state / 3)].variance; }
  StateProcess process(int state) const override { return triads_[static_cast<std::size_t>(state / 3)].process; }
  void feed(const Increments& in, std::vector<Feed>& feeds) const override;
  void calibrate(std::span<const double> values, Calibration& imu) const override;

 private:
  std::array<Triad, 2> triads_;
};

}  // namespace canyon::fusion
