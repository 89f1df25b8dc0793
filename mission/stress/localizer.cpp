#include "canyon/mission/localizer.h"

#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/mission/stress/subjects.h"

namespace canyon::mission {
namespace {

using stress::kEpsilon;

const GpsTime kFirstSample = GpsTime::from_week_sow(1610, 305000.0);

/// A unit at rest at W's origin, its filter, and its samples at a rate of their own.
struct Stage {
  LocalFrame frame{Geodetic{32.35 * kDegree, -90.88 * kDegree, 60.0}};
  Boundaries boundaries{kFirstSample};
  PartClock clock;
  Localizer localizer;
  double rate_hz;

  explicit Stage(double rate, double accel_white = 1e-5, const fusion::FilterConfig& config = {})
      : localizer(fusion::ErrorStateFilter(config, noise(accel_white), frame, Eigen::Vector3d::Zero(),
                                           Eigen::Vector3d::Zero()),
                  kFirstSample, boundaries, clock),
        rate_hz(rate) {
    localizer.initialize(Pose{}, Eigen::Vector3d::Zero());
  }
  static ImuNoise noise(double accel_white) {
    ImuNoise n;
    n.gyro.white_per_sqrt_hz = 1e-6;
    n.accel.white_per_sqrt_hz = accel_white;
    return n;
  }
  ImuSample sample(std::int64_t k) const {
    ImuSample s;
    s.t = tick(kFirstSample, k, rate_hz);
    s.dt_s = s.t - tick(kFirstSample, k - 1, rate_hz);
    s.dtheta_U = s.dt_s * (frame.R_EW().transpose() * earth_rate_E());
    s.dv_U = -s.dt_s * (frame.R_EW().transpose() * gravity_E(frame.origin_E()));
    return s;
  }
  GnssFix fix(GpsTime t) const {
    GnssFix f;
    f.t = t;
    f.status = FixStatus::kSingle;
    f.p_A_E = frame.origin_E();
    f.covariance_E = Eigen::Matrix3d::Identity();
    return f;
  }
};

/// Fixes at times of their own, each in the middle of a sample that is divided for it: all are taken at just their
/// time, the parts sum to the whole, and rest stays rest to rounding (a thousand steps, an epsilon of Earth's radius
/// each).
StressFigure divided_samples(double imu_hz, double fix_hz) {
  Stage stage(imu_hz);
  int wrong = 0, taken = 0;
  std::int64_t next = 1;
  constexpr std::int64_t kSamples = 1000;
  for (std::int64_t k = 1; k <= kSamples; ++k) {
    const GpsTime end = tick(kFirstSample, k, imu_hz);
    for (; tick(kFirstSample, next, fix_hz) <= end; ++next) {
      const GpsTime t = tick(kFirstSample, next, fix_hz);
      const auto work = [&stage, &wrong, &taken, t]() -> Status {
        wrong += stage.localizer.at() == t ? 0 : 1;
        const auto report = stage.localizer.update(stage.fix(t));
        wrong += report.ok() && report->accepted && report->t == t ? 0 : 1;
        ++taken;
        return Ok{};
      };
      wrong += stage.localizer.once_at(t, work).ok() ? 0 : 1;
    }
    wrong += stage.localizer.take(stage.sample(k), end).ok() ? 0 : 1;
    wrong += stage.localizer.at() == end ? 0 : 1;
  }
  // One at the very end of the last sample was taken with it.
  wrong += taken == next - 1 ? 0 : 1;
  stress::Worst worst;
  worst.look(wrong, 0.5);
  const double growth = std::exp(kSamples / imu_hz / 570.0);  // of the unstable height
  worst.look(stage.localizer.estimate().X_WB.p.norm(), kSamples * kEpsilon * 6.4e6 * growth);
  return worst.figure();
}

/// A unit whose clock is `skew` fast and jitters, 2000 s of samples and fixes in true time between them: each is taken.
/// Its intervals are wrong by the skew: rest is held against gravity that acts for longer, a = g skew, and by the
/// jitter. Where the datasheet's noise N is as large, fixes of 1 m a second hold the position: they follow with 1 /
/// sqrt(N) s, within which a makes a / N = 1 m. Five of it are let through.
StressFigure clock_apart(double skew_ppm, double jitter_us) {
  inertial::CatalogueEntry entry;
  entry.unit.clock_skew_ppm.value = skew_ppm;
  entry.unit.clock_jitter_us.value = jitter_us;
  const auto chain = *inertial::make_error_chain("full", {.entry = entry, .seed = 4, .rate_hz = 10.0});
  Stage stage(10.0, kStandardGravity * 1e-6 * (skew_ppm + jitter_us));
  int wrong = 0;
  for (std::int64_t k = 1; k <= 20'000; ++k) {
    ImuSample s = stage.sample(k);
    const GpsTime end = s.t, fix_t{end.ns - 37'000'000};
    chain->corrupt(k - 1, s);
    if (k % 10 == 0)
      wrong += stage.localizer
                       .once_at(fix_t,
                                [&stage, &wrong, fix_t]() -> Status {
                                  const auto report = stage.localizer.update(stage.fix(fix_t));
                                  wrong += report.ok() && report->accepted && report->t == fix_t ? 0 : 1;
                                  return Ok{};
                                })
                       .ok()
                   ? 0
                   : 1;
    wrong += stage.localizer.take(s, end).ok() ? 0 : 1;
  }
  wrong += stage.localizer.estimate().X_WB.p.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= 5.0 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Work for a time that has passed is done within the next sample; for one to come it waits, in the order it came.
StressFigure early_and_late_work() {
  Stage stage(100.0);
  std::vector<int> done;
  int wrong = 0;
  const auto ask = [&](double t_s, int number) {
    wrong += stage.localizer
                     .once_at(kFirstSample + t_s,
                              [&done, number]() -> Status {
                                done.push_back(number);
                                return Ok{};
                              })
                     .ok()
                 ? 0
                 : 1;
  };
  const auto take = [&](std::int64_t k) {
    wrong += stage.localizer.take(stage.sample(k), tick(kFirstSample, k, 100.0)).ok() ? 0 : 1;
  };
  ask(0.0, 0);  // at once
  wrong += done == std::vector<int>{0} ? 0 : 1;
  take(1);
  ask(0.01, 1);   // at once
  ask(0.005, 2);  // past
  ask(0.012, 3);
  ask(0.012, 4);  // together
  wrong += done == std::vector<int>{0, 1} ? 0 : 1;
  take(2);
  wrong += done == std::vector<int>{0, 1, 2, 3, 4} && stage.localizer.at() == kFirstSample + 0.02 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> localizer_cases() {
  const StressMechanism divided{
      StressGroup::kStiff, "a sample divided at any point",
      "a part of a nanosecond has no rate of its own; rates that are no multiples meet at the end of a sample",
      "each fix is taken at its own time to the nanosecond, and rest stays rest to rounding", "of the bound"};
  const StressMechanism clocks{
      StressGroup::kLong, "two clocks that part ways",
      "after 0.1 s of difference the filter takes the fix for one of another time (found by this case, 2026-11-22: the "
      "run ended with an internal error)",
      "each fix is taken, at 100 ppm to 5 % of skew and with stamps that jitter", "samples and fixes"};
  const StressMechanism order{StressGroup::kData, "work for a time that has passed, or is to come",
                              "a division at a share below 0 or above 1",
                              "done in the order it came, no earlier than its time", "looks"};
  StressRows rows;
  for (const auto& [imu_hz, fix_hz] : {std::pair{100.0, 7.0}, {5000.0, 333.0}, {10.0, 97.0}, {3.0, 0.01}})
    rows.of(divided).add("localizer/imu_" + stress::text(imu_hz) + "_hz_fixes_" + stress::text(fix_hz) + "_hz",
                         [i = imu_hz, f = fix_hz] { return divided_samples(i, f); });
  for (const auto& [skew_ppm, jitter_us] : {std::pair{100.0, 0.0}, {5e4, 0.0}, {100.0, 1e5}})
    rows.of(clocks).add("localizer/clock_" + stress::text(skew_ppm) + "_ppm_jitter_" + stress::text(jitter_us) + "_us",
                        [s = skew_ppm, j = jitter_us] { return clock_apart(s, j); });
  rows.of(order).add("localizer/early_and_late_work", early_and_late_work);
  return rows.take();
}

}  // namespace canyon::mission
