#include "canyon/inertial/allan/motion_check.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/deviation.h"

namespace canyon::inertial {
namespace {

constexpr double kWindow_s = 1.0;
constexpr std::size_t kLeastSamples = 10;
constexpr double kQuietFactor = 5.0;

/// What rest allows: data sheets of MEMS units give drifts of bias over temperature and time of up to 0.5 deg/s and
/// 50 mg; 10 deg/s is twice the turn-on bias of a poor one that nobody has calibrated (MPU-6050: 4.5 measured, 20 the
/// limit of its sheet).
struct Allowance {
  double mean, scatter, most_scatter, bias;
};
constexpr Allowance kGyro{1.0 * kDegree, 0.5 * kDegree, 5.0 * kDegree, 10.0 * kDegree};
constexpr Allowance kAccel{0.5, 0.1, 1.5, 1e300};  // gravity is no bias
const Allowance& allowance(int channel) {
  return channel < 3 ? kGyro : kAccel;
}

/// Mean and scatter about it of each window of one channel.
struct Windows {
  std::vector<double> mean, scatter;
};

Windows windows_of(const std::vector<double>& x, const std::vector<Segment>& windows) {
  Windows out;
  for (const Segment& w : windows) {
    throw_if_cancelled();
    const auto n = static_cast<double>(w.end - w.begin);
    double sum = 0.0, square = 0.0;
    for (std::size_t k = w.begin; k < w.end; ++k) sum += x[k];
    for (std::size_t k = w.begin; k < w.end; ++k) square += (x[k] - sum / n) * (x[k] - sum / n);
    out.mean.push_back(sum / n);
    out.scatter.push_back(std::sqrt(square / n));
  }
  return out;
}

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Windows that do not reach across gaps.
std::vector<Segment> windows_in(const Sampling& sampling) {
  const auto length = std::max(kLeastSamples, static_cast<std::size_t>(std::lround(kWindow_s / sampling.interval_s)));
  std::vector<Segment> out;
  for (const Segment& s : sampling.segments)
    for (std::size_t begin = s.begin; begin + length <= s.end; begin += length) out.push_back({begin, begin + length});
  return out;
}

/// How a window shows motion most, relative to what rest allows; excess <= 1: not at all.
struct Sign {
  double excess = 0.0, amount = 0.0;
  int channel = 0;
  bool shakes = false;

  void take(double value, double allowed, int of_channel, bool by_scatter) {
    if (value / allowed <= excess) return;
    excess = value / allowed;
    amount = value;
    channel = of_channel;
    shakes = by_scatter;
  }
};

std::vector<Sign> signs_of(const ImuLog& log, const std::vector<Segment>& windows) {
  std::vector<Sign> signs(windows.size());
  for (int channel = 0; channel < 6; ++channel) {
    const std::vector<double>& x = log.channels[static_cast<std::size_t>(channel)];
    if (x.empty()) continue;
    const Allowance& at_rest = allowance(channel);
    const Windows of = windows_of(x, windows);
    const double median = quantile(of.mean, 0.5);
    const double quiet = kQuietFactor * quantile(of.scatter, 0.1);
    const double scatter = std::max(at_rest.scatter, std::min(quiet, at_rest.most_scatter));
    for (std::size_t i = 0; i < windows.size(); ++i) {
      // The mean of noise scatters too: four sigmas of it are one in 16000.
      const double of_noise = 4.0 * of.scatter[i] / std::sqrt(static_cast<double>(windows[i].end - windows[i].begin));
      signs[i].take(std::abs(of.mean[i] - median), at_rest.mean + of_noise, channel, false);
      signs[i].take(of.scatter[i], scatter, channel, true);
      signs[i].take(std::abs(median), at_rest.bias, channel, false);
    }
  }
  return signs;
}

}  // namespace

const MovingInterval& MotionFound::worst() const {
  CANYON_CHECK(moves(), "no motion was found");
  return *std::max_element(intervals.begin(), intervals.end(),
                           [](const MovingInterval& a, const MovingInterval& b) { return a.excess < b.excess; });
}

MotionFound find_motion(const ImuLog& log) {
  MotionFound out;
  const Sampling sampling = sampling_of(log.t_s);
  const std::vector<Segment> windows = windows_in(sampling);
  if (windows.empty()) return out;
  const std::vector<Sign> signs = signs_of(log, windows);
  double moving_s = 0.0;
  bool moved = false;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const Sign& sign = signs[i];
    const bool moves = sign.excess > 1.0;
    if (moves) {
      const double from_s = log.t_s[windows[i].begin], to_s = log.t_s[windows[i].end - 1];
      moving_s += static_cast<double>(windows[i].end - windows[i].begin) * sampling.interval_s;
      const MovingInterval here{from_s, to_s, sign.channel, sign.shakes, sign.amount, sign.excess};
      if (!moved) {
        out.intervals.push_back(here);
      } else {
        MovingInterval& whole = out.intervals.back();
        const double begun_s = whole.from_s;
        if (here.excess > whole.excess) whole = here;
        whole.from_s = begun_s;
        whole.to_s = to_s;
      }
    }
    moved = moves;
  }
  double all_s = 0.0;
  for (const Segment& w : windows) all_s += static_cast<double>(w.end - w.begin) * sampling.interval_s;
  out.share = moving_s / all_s;
  return out;
}

}  // namespace canyon::inertial
