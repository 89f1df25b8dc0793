#include "canyon/fusion/smoothing/run_filter.h"

#include <cmath>
#include <string>

#include "canyon/core/config/text.h"
#include "canyon/core/process/progress.h"

namespace canyon::fusion {
namespace {

/// A fix comes with the sample that ends nearest, and the filter takes one that is 0.1 s away.
constexpr double kLongest_s = 0.2;

}  // namespace

Result<std::span<const ImuSample>> samples_of(const SmootherInput& run) {
  std::size_t first = 0;
  while (first < run.imu.size() && run.imu[first].t - run.start < 0.5 * run.imu[first].dt_s) ++first;
  const auto samples = run.imu.subspan(first);
  if (samples.empty())
    return Error{.what = "no IMU sample after " + run.start.iso(), .expected = "a log that goes on from the start"};
  if (samples.front().dt_s > kLongest_s)
    return Error{.what = "IMU samples of " + number_text(samples.front().dt_s) + " s",
                 .expected = "at most " + number_text(kLongest_s) + " s"};
  GpsTime last = run.start;
  for (const ImuSample& imu : samples) {
    const double elapsed_s = imu.t - last;
    if (!(std::abs(elapsed_s - imu.dt_s) <= 0.5 * imu.dt_s))
      return Error{.what = "IMU sample at " + imu.t.iso() + " covers " + number_text(imu.dt_s) + " s, but " +
                           number_text(elapsed_s) + " s have passed",
                   .expected = "samples that follow one another"};
    last = imu.t;
  }
  return samples;
}

ErrorStateFilter started_filter(const SmootherInput& run) {
  ErrorStateFilter filter(run.config, run.noise, run.frame, run.lever_U_B, run.lever_A_B);
  filter.initialize(run.start, run.X_WB, run.v_WB_W);
  return filter;
}

void run_filter(const SmootherInput& run, std::span<const ImuSample> samples, ErrorStateFilter& filter,
                const std::function<void(const ImuSample&)>& after) {
  Queue fixes(run.fixes);
  Queue odometer(run.odometer);
  Queue barometer(run.barometer);
  Queue magnetometer(run.magnetometer);
  Queue heading(run.heading);
  Queue poses(run.poses);
  fixes.begin(samples.front());
  odometer.begin(samples.front());
  barometer.begin(samples.front());
  magnetometer.begin(samples.front());
  heading.begin(samples.front());
  poses.begin(samples.front());
  auto loosened = run.loosened.begin();
  while (loosened != run.loosened.end() && loosened->t <= run.start) ++loosened;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    throw_if_cancelled();
    filter.predict(samples[k]);
    for (; loosened != run.loosened.end() && loosened->t <= samples[k].t; ++loosened)
      filter.loosen(loosened->theta_rad, loosened->p_m, loosened->v_m_s);
    for (const OdometerSample& sample : odometer.with(samples, k)) filter.update(AidingMessage(sample));
    for (const HeadingSample& sample : heading.with(samples, k)) filter.update(AidingMessage(sample));
    for (const BarometerSample& sample : barometer.with(samples, k)) filter.update(AidingMessage(sample));
    for (const MagnetometerSample& sample : magnetometer.with(samples, k)) filter.update(AidingMessage(sample));
    for (const PoseInMap& pose : poses.with(samples, k)) filter.update(AidingMessage(pose));
    for (const GnssFix& fix : fixes.with(samples, k)) filter.update(fix);
    after(samples[k]);
  }
}

}  // namespace canyon::fusion
