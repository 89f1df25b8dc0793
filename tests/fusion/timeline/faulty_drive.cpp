#include "canyon/tests/fusion/timeline/faulty_drive.h"

#include <cmath>
#include <memory>

#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion::testing {

DrivenTruth tactical(double heading_rad) {
  DrivenTruth truth(11, heading_rad);
  const ImuNoise n = tactical_noise();
  truth.bias << 1e-5, -2e-5, 1e-5, 5e-3, -6e-3, 4e-3;
  truth.gyro_per_sqrt_hz = n.gyro.white_per_sqrt_hz;
  truth.accel_per_sqrt_hz = n.accel.white_per_sqrt_hz;
  return truth;
}

ErrorStateFilter started(const DrivenTruth& truth, const std::string& keys) {
  ErrorStateFilter filter(configured(keys), tactical_noise(), DrivenTruth::frame(), Eigen::Vector3d::Zero(),
                          Eigen::Vector3d::Zero());
  filter.initialize(truth.state().t, truth.X_WB(), truth.v_W());
  return filter;
}

namespace {

/// Counts the ticks of a wheel 0.8 m to the left, where the filter takes it to be.
class Wheel {
 public:
  void roll(const DrivenTruth& truth, const ImuSample& sample) {
    const NavState& s = truth.state();
    const double turning = (sample.dtheta_U / sample.dt_s - s.R_EU.conjugate() * earth_rate_E()).z();
    way_m_ += sample.dt_s * ((s.R_EU.conjugate() * s.v_EU_E).x() - 0.8 * turning);
  }
  OdometerSample count(GpsTime t, double dt_s) {
    constexpr double kTick_m = 0.02;
    const double until = std::floor(way_m_ / kTick_m);
    OdometerSample out{.t = t, .dt_s = dt_s, .ticks = static_cast<std::int64_t>(until - ticks_)};
    out.speed_m_s = kTick_m * (until - ticks_) / dt_s;
    ticks_ = until;
    return out;
  }

 private:
  double way_m_ = 0.0, ticks_ = 0.0;
};

}  // namespace

Worst drive(const std::string& keys, const Fault& fault, double seconds, Carries carries) {
  DrivenTruth truth = tactical(0.5);
  const RandomStream stream(12, "test.fixes"), speeds(12, "test.fix_velocities");
  FilterTimeline timeline(started(truth, keys), {});
  const bool wheels = carries == Carries::kWheelsToo;
  Wheel wheel;
  Worst out;
  for (int k = 1; k <= static_cast<int>(100 * seconds); ++k) {
    const ImuSample sample = truth.step();
    for (const ImuSample& s : fault.imu(k, sample)) timeline.add(s);
    wheel.roll(truth, sample);
    if (wheels && k % 10 == 0) timeline.add(AidingMessage(wheel.count(sample.t, 0.1)));
    if (k % kSamplesPerFix == 0) {
      const auto n = static_cast<std::uint64_t>(k);
      const Eigen::Vector3d noise(stream.normal(0, n), stream.normal(1, n), stream.normal(2, n));
      GnssFix fix = truth.fix(kSigma_m * noise, kSigma_m);
      if (wheels) {
        fix.v_A_E = truth.state().v_EU_E + 0.05 * speeds.normal3(n);
        fix.velocity_covariance_E = 0.05 * 0.05 * Eigen::Matrix3d::Identity();
      }
      for (const GnssFix& f : fault.fix(k, fix)) timeline.add(AidingMessage(f));
    }
    out.final_m = (timeline.filter().nav_state().p_EU_E - truth.state().p_EU_E).norm();
    if (k > 3000) out.off_m = std::max(out.off_m, out.final_m);
  }
  out.incidents = timeline.incidents();
  return out;
}

Fault one_in_five_anywhere() {
  Fault fault;
  fault.fix = [stream = RandomStream(13, "test.outliers")](int k, GnssFix fix) {
    const auto n = static_cast<std::uint64_t>(k);
    if (stream.uniform(0, n) < 0.2)
      fix.p_A_E += 100.0 * Eigen::Vector3d(stream.normal(1, n), stream.normal(2, n), stream.normal(3, n));
    return std::vector<GnssFix>{fix};
  };
  return fault;
}

Fault frozen_for_ten_seconds() {
  Fault fault;
  fault.fix = [held = std::make_shared<std::optional<GnssFix>>()](int k, GnssFix fix) {
    if (k < 6000 || k >= 7000) {
      held->reset();
    } else {
      if (!*held) *held = fix;
      const GpsTime t = fix.t;
      fix = **held;
      fix.t = t;
    }
    return std::vector<GnssFix>{fix};
  };
  return fault;
}

Fault late_by_200_ms(double seconds) {
  // Fixes come at ticks of half a second, so the place is carried back instead.
  DrivenTruth ahead = tactical(0.5);
  std::vector<NavState> states{ahead.state()};
  for (int k = 1; k <= static_cast<int>(100 * seconds); ++k) {
    ahead.step();
    states.push_back(ahead.state());
  }
  Fault fault;
  fault.fix = [states = std::move(states)](int k, GnssFix fix) {
    const auto now = static_cast<std::size_t>(k);
    fix.p_A_E += states[now - 20].p_EU_E - states[now].p_EU_E;
    fix.v_A_E += states[now - 20].v_EU_E - states[now].v_EU_E;
    return std::vector<GnssFix>{fix};
  };
  return fault;
}

Fault all_twice() {
  Fault fault;
  fault.imu = [](int, const ImuSample& s) { return std::vector<ImuSample>{s, s}; };
  fault.fix = [](int, const GnssFix& f) { return std::vector<GnssFix>{f, f, f}; };
  return fault;
}

Fault bad_until(int samples) {
  Fault fault;
  fault.fix = [samples](int k, GnssFix fix) {
    if (k <= samples) fix.p_A_E += 200.0 * Eigen::Vector3d(std::sin(1e-4 * k), std::cos(1.3e-4 * k), 0.5);
    return std::vector<GnssFix>{fix};
  };
  return fault;
}

}  // namespace canyon::fusion::testing
