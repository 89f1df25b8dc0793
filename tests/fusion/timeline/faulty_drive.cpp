#include "canyon/tests/fusion/timeline/faulty_drive.h"

#include <cmath>
#include <limits>
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

/// The drive itself: `sample`, `message` take what comes, `place_E` says where the filter is.
class Drive {
 public:
  Drive(const Fault& fault, Carries carries) : fault_(fault), wheels_(carries == Carries::kWheelsToo) {}

  const DrivenTruth& truth() const { return truth_; }

  template <class TakeSample, class TakeMessage>
  void step(const TakeSample& take_sample, const TakeMessage& take_message) {
    const int k = ++k_;
    const ImuSample sample = truth_.step();
    for (const ImuSample& s : fault_.imu(k, sample)) take_sample(s);
    wheel_.roll(truth_, sample);
    if (wheels_ && k % 10 == 0) take_message(AidingMessage(wheel_.count(sample.t, 0.1)));
    if (k % kSamplesPerFix != 0) return;
    const auto n = static_cast<std::uint64_t>(k);
    const Eigen::Vector3d noise(stream_.normal(0, n), stream_.normal(1, n), stream_.normal(2, n));
    GnssFix fix = truth_.fix(kSigma_m * noise, kSigma_m);
    if (wheels_) {
      fix.v_A_E = truth_.state().v_EU_E + 0.05 * speeds_.normal3(n);
      fix.velocity_covariance_E = 0.05 * 0.05 * Eigen::Matrix3d::Identity();
    }
    for (const GnssFix& f : fault_.fix(k, fix)) take_message(AidingMessage(f));
  }

  void look(const ErrorStateFilter& filter, Worst& out) const {
    out.final_m = (filter.nav_state().p_EU_E - truth_.state().p_EU_E).norm();
    if (k_ > 3000) out.off_m = std::max(out.off_m, out.final_m);
  }

 private:
  const Fault& fault_;
  bool wheels_;
  DrivenTruth truth_ = tactical(0.5);
  RandomStream stream_{12, "test.fixes"}, speeds_{12, "test.fix_velocities"};
  Wheel wheel_;
  int k_ = 0;
};

}  // namespace

Worst drive(const std::string& keys, const Fault& fault, double seconds, Carries carries) {
  Drive drive(fault, carries);
  FilterTimeline timeline(started(drive.truth(), keys), {});
  Worst out;
  for (int k = 1; k <= static_cast<int>(100 * seconds); ++k) {
    drive.step([&](const ImuSample& s) { timeline.add(s); }, [&](const AidingMessage& m) { timeline.add(m); });
    drive.look(timeline.filter(), out);
  }
  out.incidents = timeline.incidents();
  return out;
}

Bare drive_bare(const std::string& keys, const Fault& fault, Stamps stamps, Carries carries) {
  constexpr int kSamples = 18000;
  Drive drive(fault, carries);
  ErrorStateFilter filter = started(drive.truth(), keys);
  const auto now = [&](auto message) {
    if (stamps == Stamps::kCounted) message.t = filter.nav_state().t;
    return message;
  };
  const auto sample = [&](ImuSample s) {
    if (stamps == Stamps::kCounted) s.t = filter.nav_state().t + s.dt_s;
    filter.predict(s);
  };
  const auto message = [&](const AidingMessage& m) {
    if (const auto* fix = std::get_if<GnssFix>(&m)) filter.update(now(*fix));
    if (const auto* ticks = std::get_if<OdometerSample>(&m)) filter.update(AidingMessage(now(*ticks)));
  };
  Bare out;
  for (int k = 1; k <= kSamples; ++k) {
    try {
      drive.step(sample, message);
    } catch (const ProgramError& refused) {
      out.ended_s = drive.truth().elapsed_s();
      out.why = refused.what();
      break;
    }
    drive.look(filter, out.worst);
  }
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

Fault two_in_reverse() {
  Fault fault;
  fault.imu = [before = std::make_shared<ImuSample>()](int k, const ImuSample& s) {
    if (k % 100 == 1) {
      *before = s;
      return std::vector<ImuSample>{};
    }
    return k % 100 == 2 ? std::vector<ImuSample>{s, *before} : std::vector<ImuSample>{s};
  };
  return fault;
}

Fault not_a_number() {
  Fault fault;
  fault.imu = [](int k, ImuSample s) {
    if (k % 200 == 7) s.dtheta_U.z() = kNaN;
    if (k % 200 == 107) s.dv_U.x() = -std::numeric_limits<double>::infinity();
    return std::vector<ImuSample>{s};
  };
  fault.fix = [](int k, GnssFix f) {
    if (k % 200 == 0) f.p_A_E.x() = kNaN;
    if (k % 300 == 0) f.covariance_E.setZero();
    return std::vector<GnssFix>{f};
  };
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
