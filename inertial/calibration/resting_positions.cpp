#include "canyon/inertial/calibration/resting_positions.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"

namespace canyon::inertial {
namespace {

constexpr double kRestWindow_s = 0.5;
constexpr double kRestingFactor = 3.0;

/// Mean of the three channels from `first` over [begin, end).
Eigen::Vector3d mean(const ImuLog& log, std::size_t first, std::size_t begin, std::size_t end) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t k = begin; k < end; ++k) sum[static_cast<Eigen::Index>(axis)] += log.channels[first + axis][k];
  return sum / static_cast<double>(end - begin);
}

double spread(const ImuLog& log, std::size_t first, std::size_t begin, std::size_t end) {
  const Eigen::Vector3d m = mean(log, first, begin, end);
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t k = begin; k < end; ++k)
      sum += std::pow(log.channels[first + axis][k] - m[static_cast<Eigen::Index>(axis)], 2);
  return std::sqrt(sum / static_cast<double>(end - begin));
}

/// Which windows are quiet in three channels.
std::vector<bool> quiet_windows(const ImuLog& log, std::size_t first, std::size_t length) {
  std::vector<double> spreads;
  for (std::size_t begin = 0; begin + length <= log.size(); begin += length) {
    throw_if_cancelled();
    spreads.push_back(spread(log, first, begin, begin + length));
  }
  std::vector<double> sorted = spreads;
  std::sort(sorted.begin(), sorted.end());
  const double limit = kRestingFactor * sorted[sorted.size() / 10];
  std::vector<bool> quiet;
  for (const double s : spreads) quiet.push_back(s <= limit);
  return quiet;
}

}  // namespace

std::vector<RestingPosition> resting_positions(const ImuLog& log, double shortest_s) {
  for (const auto& channel : log.channels) CANYON_CHECK(channel.size() == log.size(), "a channel is missing");
  const double interval_s = (log.t_s.back() - log.t_s.front()) / static_cast<double>(log.size() - 1);
  const auto length = std::max<std::size_t>(4, static_cast<std::size_t>(std::lround(kRestWindow_s / interval_s)));
  std::vector<RestingPosition> out;
  if (log.size() < length) return out;
  const std::vector<bool> gyro = quiet_windows(log, 0, length), accel = quiet_windows(log, 3, length);
  std::size_t run = 0;
  for (std::size_t w = 0; w <= gyro.size(); ++w) {
    if (w < gyro.size() && gyro[w] && accel[w]) {
      ++run;
      continue;
    }
    const std::size_t begin = (w - run) * length + length / 2, end = w * length - std::min(w * length, length / 2);
    if (run > 1 && static_cast<double>(end - begin) * interval_s >= shortest_s)
      out.push_back({begin, end, mean(log, 0, begin, end), mean(log, 3, begin, end)});
    run = 0;
  }
  return out;
}

}  // namespace canyon::inertial
