#include "canyon/fusion/states/triad_biases.h"

namespace canyon::fusion {

void TriadBiases::feed(const Increments&, std::vector<Feed>& feeds) const {
  for (int i = 0; i < 6; ++i) feeds.push_back({.axis = i, .state = i, .rate = 1.0});
}

void TriadBiases::calibrate(std::span<const double> values, Calibration& imu) const {
  imu.gyro_bias += Eigen::Vector3d(values[0], values[1], values[2]);
  imu.accel_bias += Eigen::Vector3d(values[3], values[4], values[5]);
}

}  // namespace canyon::fusion
