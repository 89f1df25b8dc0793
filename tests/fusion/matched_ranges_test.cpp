// Ranges whose errors last, of satellites that come and go: the filter is as far off as it says.
#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "canyon/fusion/consistency.h"
#include "canyon/fusion/measurements/satellite_slots.h"
#include "canyon/fusion/states/range_errors.h"
#include "canyon/fusion/states/receiver_clock.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/driven_truth.h"
#include "canyon/tests/fusion/nees_bands.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using testing::DrivenTruth;

constexpr int kRangeRuns = 100, kRangeEpochs = 20, kInSight = 8, kSatellites = 20;
constexpr double kRangeEpoch_s = 5.0, kReceiver_s = 0.5;
constexpr double kTau_s = 20.0, kWay_m = 40.0, kRange_m = 1.0, kRate_m_s = 0.1;

const char* const kKeys = R"(
states = ["turn_on_biases", "receiver_clock", "range_errors"]
measurements = ["ranges"]
acceptance = "accept_all"
initial_attitude_sigma_deg_roll_pitch = 0.2
initial_attitude_sigma_deg_heading = 0.5
initial_position_sigma_m = 1.0
initial_velocity_sigma_m_s = 0.2
clock_rate_sigma_m_s = 30.0
clock_walk_m_per_sqrt_s = 0.2
clock_rate_walk_m_s_per_sqrt_s = 0.1
system_time_sigma_m = 20.0
range_error_slots = 8
range_error_sigma_m = 2.0
range_error_decade_db = 20.0
range_error_most_m = 15.0
range_error_mean = 0.5
range_error_tau_s = 20.0
range_error_way_m = 40.0
range_rate_sigma_m_s = 0.1
)";

ImuNoise unit() {
  ImuNoise n;
  n.gyro = {.white_per_sqrt_hz = 5e-5, .turn_on_bias_sigma = 5e-5};
  n.accel = {.white_per_sqrt_hz = 1e-3, .turn_on_bias_sigma = 5e-3};
  return n;
}

/// A receiver whose pseudoranges err as kKeys says; every 10 s the satellite that has been in sight for the longest
/// goes for ever, and a new one comes.
class World {
 public:
  explicit World(std::uint64_t seed)
      : stream_(seed, "test.ranges"),
        truth_(seed, 0.3 + 0.05 * static_cast<double>(seed)),
        parameters_(configured(kKeys).own.get<RangeErrorsParameters>()),
        slots_(kInSight) {
    truth_.gyro_per_sqrt_hz = unit().gyro.white_per_sqrt_hz;
    truth_.accel_per_sqrt_hz = unit().accel.white_per_sqrt_hz;
    for (int i = 0; i < 3; ++i) {
      gyro_bias_[i] = unit().gyro.turn_on_bias_sigma * draw();
      accel_bias_[i] = unit().accel.turn_on_bias_sigma * draw();
    }
    rate_m_s_ = 30.0 * draw();
    clock_m_ = 1e5 * draw();
    for (double& system : systems_m_) system = 20.0 * draw();
    for (double& x : lasting_) x = draw();
  }

  ErrorStateFilter filter() {
    ErrorStateFilter out(configured(kKeys), unit(), DrivenTruth::frame(), Vector3d::Zero(), lever());
    Pose X = truth_.X_WB();
    X.R = so3_exp(Vector3d(0.2 * kDegree * draw(), 0.2 * kDegree * draw(), 0.5 * kDegree * draw())) * X.R;
    X.p += Vector3d(draw(), draw(), draw());
    out.initialize(truth_.state().t, X, truth_.v_W() + 0.2 * Vector3d(draw(), draw(), draw()));
    return out;
  }

  void step(ErrorStateFilter& filter) {
    ImuSample s = truth_.step();
    s.dtheta_U += gyro_bias_ * s.dt_s;
    s.dv_U += accel_bias_ * s.dt_s;
    const double rate_before = rate_m_s_, root = std::sqrt(s.dt_s);
    rate_m_s_ += 0.1 * root * draw();
    clock_m_ += 0.5 * (rate_before + rate_m_s_) * s.dt_s + 0.2 * root * draw();
    filter.predict(s);
    if (++k_ % static_cast<int>(100 * kReceiver_s) == 0) receive(filter);
  }

  /// Errors, truth minus estimate, and their states. The clock itself has no absolute truth: what the first epoch found
  /// has been taken out of it.
  struct Errors {
    Eigen::VectorXd value;
    std::vector<int> states;
  };
  std::map<std::string, Errors> errors(const ErrorStateFilter& filter) const {
    const NavState& n = filter.nav_state();
    const NavState& t = truth_.state();
    std::map<std::string, Errors> out;
    const auto add = [&](const char* name, int at, const Eigen::VectorXd& error) {
      Errors& e = out[name];
      e.value = error;
      for (int i = 0; i < error.size(); ++i) e.states.push_back(at + i);
    };
    add("theta", 0, so3_log(n.R_EU.conjugate() * t.R_EU));
    add("p", 3, t.p_EU_E - n.p_EU_E);
    add("v", 6, t.v_EU_E - n.v_EU_E);
    const int bias = filter.offset("turn_on_biases"), clock = filter.offset("receiver_clock"),
              lasting = filter.offset("range_errors");
    Eigen::VectorXd of_bias(6), of_lasting(kInSight), of_clock(3);
    for (int i = 0; i < 6; ++i) of_bias[i] = (i < 3 ? gyro_bias_[i] : accel_bias_[i - 3]) - filter.value(bias + i);
    of_clock << rate_m_s_ - filter.value(clock + 1), systems_m_[0] - filter.value(clock + 2),
        systems_m_[1] - filter.value(clock + 3);
    for (int i = first(); i < first() + kInSight; ++i)
      of_lasting[slots_.of(id(i))] = at(i) - filter.value(lasting + slots_.of(id(i)));
    add("turn_on_biases", bias, of_bias);
    add("receiver_clock", clock + 1, of_clock);
    add("range_errors", lasting, of_lasting);
    return out;
  }

 private:
  static Vector3d lever() { return {-0.4, 0.3, 1.5}; }
  double draw() { return stream_.normal(0, n_++); }
  int first() const { return (k_ - 1) / 1000; }
  double at(int i) const { return lasting_[static_cast<std::size_t>(i)]; }
  static SatelliteId id(int i) {
    const GnssSystem systems[] = {GnssSystem::kGps, GnssSystem::kGps, GnssSystem::kGlonass, GnssSystem::kGalileo};
    return {systems[i % 4], static_cast<std::uint8_t>(i + 1)};
  }
  double system_m(int i) const { return i % 4 < 2 ? 0.0 : systems_m_[static_cast<std::size_t>(i % 4 - 2)]; }

  GnssObservation seen(int i) {
    const double azimuth = 2.4 * i, elevation = 0.3 + 0.11 * (i * 5 % 10), t_s = truth_.elapsed_s();
    const Vector3d to_W(std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
                        std::sin(elevation));
    GnssObservation o;
    o.sv = id(i);
    o.cn0_dbhz = 38.0 + 8.0 * std::sin(0.07 * t_s + i);
    o.v_E = DrivenTruth::frame().R_EW() * Vector3d(1500.0 * std::cos(i), 1500.0 * std::sin(i), -300.0);
    o.p_E = DrivenTruth::frame().to_E(2.2e7 * to_W) + t_s * o.v_E;
    o.sigma_m = kRange_m;
    const NavState& t = truth_.state();
    const Vector3d w = DrivenTruth::winding(t_s - 0.01).w_EU_U, p_A_E = t.p_EU_E + t.R_EU * lever(),
                   v_A_E = t.v_EU_E + t.R_EU * w.cross(lever());
    const Vector3d u = (o.p_E - p_A_E).normalized();
    o.pseudorange_m = (o.p_E - p_A_E).norm() + clock_m_ + system_m(i) + parameters_.mean_m(o.cn0_dbhz) +
                      parameters_.sigma_m(o.cn0_dbhz) * at(i) + kRange_m * draw();
    o.rate_m_s = u.dot(o.v_E - v_A_E) + rate_m_s_ + parameters_.growth(o.cn0_dbhz) * kRate_m_s * draw();
    return o;
  }

  void receive(ErrorStateFilter& filter) {
    const double way_m = kReceiver_s * truth_.state().v_EU_E.norm();
    const double kept = std::exp(-kReceiver_s / kTau_s - way_m / kWay_m);
    for (double& x : lasting_) x = kept * x + std::sqrt(1.0 - kept * kept) * draw();
    GnssEpoch epoch{.t = truth_.state().t, .observations = {}};
    for (int i = first(); i < first() + kInSight; ++i) epoch.observations.push_back(seen(i));
    filter.update(AidingMessage(epoch));
    slots_.assign(epoch);
  }

  RandomStream stream_;
  std::uint64_t n_ = 0;
  DrivenTruth truth_;
  RangeErrorsParameters parameters_;
  SatelliteSlots slots_;
  Vector3d gyro_bias_, accel_bias_;
  double clock_m_, rate_m_s_;
  std::array<double, 2> systems_m_{};
  std::array<double, kSatellites> lasting_{};
  int k_ = 0;
};

double squared(const World::Errors& e, const Eigen::MatrixXd& P) {
  const auto n = e.value.size();
  Eigen::MatrixXd own(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      own(i, j) = P(e.states[static_cast<std::size_t>(i)], e.states[static_cast<std::size_t>(j)]);
  return normalized_squared(e.value, own);
}

TEST(MatchedRanges, EveryBlockIsAsFarOffAsItSays) {
  testing::BlockNees nees(kRangeEpochs);
  for (int run = 0; run < kRangeRuns; ++run) {
    World world(static_cast<std::uint64_t>(run) + 1);
    ErrorStateFilter filter = world.filter();
    for (int epoch = 0; epoch < kRangeEpochs; ++epoch) {
      for (int k = 0; k < static_cast<int>(100 * kRangeEpoch_s); ++k) world.step(filter);
      const Eigen::MatrixXd P = filter.covariance();
      World::Errors all;
      auto errors = world.errors(filter);
      for (const auto& [name, error] : errors) {
        all.states.insert(all.states.end(), error.states.begin(), error.states.end());
        const auto n = all.value.size();
        all.value.conservativeResize(n + error.value.size());
        all.value.tail(error.value.size()) = error.value;
      }
      errors["all"] = all;
      for (const auto& [name, error] : errors) {
        nees.add(name, epoch, squared(error, P), static_cast<int>(error.value.size()));
      }
    }
  }
  nees.expect_in_bands(kRangeRuns);
}

TEST(SatelliteSlots, WhoComesTakesThePlaceOfWhoHasGoneForTheLongest) {
  const auto epoch = [](double t_s, std::initializer_list<int> prns) {
    GnssEpoch e{.t = GpsTime::from_week_sow(1590, t_s), .observations = {}};
    for (const int prn : prns) {
      GnssObservation o;
      o.sv = {GnssSystem::kGps, static_cast<std::uint8_t>(prn)};
      e.observations.push_back(o);
    }
    return e;
  };
  const auto gps = [](int prn) { return SatelliteId{GnssSystem::kGps, static_cast<std::uint8_t>(prn)}; };
  SatelliteSlots slots(3);
  slots.assign(epoch(0.0, {1, 2}));
  EXPECT_EQ(slots.begun(), (std::vector<int>{0, 1}));
  slots.assign(epoch(1.0, {2, 3}));
  EXPECT_EQ(slots.begun(), (std::vector<int>{2}));
  slots.assign(epoch(2.0, {1, 3}));  // it kept its place
  EXPECT_TRUE(slots.begun().empty());
  EXPECT_EQ(slots.of(gps(1)), 0);
  slots.assign(epoch(3.0, {4, 1, 3, 5}));  // 2 has gone; one too many
  EXPECT_EQ(slots.begun(), (std::vector<int>{1}));
  EXPECT_EQ(slots.of(gps(4)), 1);
  EXPECT_EQ(slots.of(gps(2)), -1);
  EXPECT_EQ(slots.of(gps(5)), -1);
  slots.clear();
  EXPECT_EQ(slots.of(gps(4)), -1);
}

}  // namespace
}  // namespace canyon::fusion
