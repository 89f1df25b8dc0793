// Random processes of the receiver and the satellites over times far from their own.
#include <cmath>
#include <cstdio>
#include <limits>

#include <Eigen/Geometry>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/errors/ephemeris_error.h"
#include "canyon/gnss/errors/gauss_markov.h"
#include "canyon/gnss/receiver/loop_noise.h"
#include "canyon/gnss/receiver/receiver_clock.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;

struct Moments {
  double variance = 0.0, product = 0.0;
};

/// Over `n` entities: mean of x^2 and of x y.
template <class Pair>
Moments moments(std::uint32_t n, const Pair& pair) {
  Moments out;
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto [x, y] = pair(i);
    out.variance += x * x / n;
    out.product += x * y / n;
  }
  return out;
}

/// Variance 1 and correlation exp(-1) after one tau. Of N entities the mean of x^2 has the deviation sqrt(2 / N), that
/// of x y sqrt((1 + rho^2) / N): five of the larger, false alarm 6e-7 each; and the documented 0.02 of correlation.
StressFigure gauss_markov(double tau_s, std::int64_t at_ns) {
  constexpr std::uint32_t kEntities = 1500;
  const GaussMarkov process(7, "stress.gauss_markov", tau_s);
  const GpsTime t{at_ns}, later = t + tau_s;
  const Moments m =
      moments(kEntities, [&](std::uint32_t i) { return std::pair(process.at(i, t), process.at(i, later)); });
  StressFigure out{0.0, 5.0 * std::sqrt(2.0 / kEntities) + 0.02};
  take_worst(out, std::abs(m.variance - 1.0));
  take_worst(out, std::abs(m.product - std::exp(-1.0)));
  return out;
}

/// From just before a node to just after it: 2 ns of tau / 8 = 7.5 s, at a slope of at most the difference of two nodes
/// (below 12 in ten thousand draws) over 7.5 s.
StressFigure across_nodes() {
  const GaussMarkov process(7, "stress.gauss_markov", 60.0);
  StressFigure out{0.0, 2.0 * 2e-9 / 7.5 * 12.0};
  for (std::int64_t k = 1; k < 2000; ++k) {
    const GpsTime node{k * 7'500'000'000};
    take_worst(out, std::abs(process.at(3, GpsTime{node.ns - 1}) - process.at(3, GpsTime{node.ns + 1})));
  }
  return out;
}

/// Variance 1, and the correlation of neighbouring epochs. A loop of rho keeps K = ln 1e-8 / ln rho draws, 1024 at
/// most: then neighbours correlate by rho (1 - rho^(2 K - 2)) / (1 - rho^(2 K)), which for rho -> 1 lacks 1 / K of 1.
/// Five deviations of N entities.
StressFigure loop_noise(double loop_hz, double interval_s) {
  constexpr std::uint32_t kEntities = 400;
  const LoopNoise noise(11, "stress.loop", loop_hz, interval_s);
  const Moments m =
      moments(kEntities, [&](std::uint32_t i) { return std::pair(noise.at(i, 1'000'000), noise.at(i, 1'000'001)); });
  const double rho = std::exp(-4.0 * loop_hz * interval_s);
  StressFigure out{0.0, 5.0 * std::sqrt(2.0 / kEntities) + 1.0 / 1024.0};
  take_worst(out, std::abs(m.variance - 1.0));
  take_worst(out, std::abs(m.product - rho));
  return out;
}

/// Variance of a crystal's time after n epochs, over N seeds, against its closed form: the start's (1 us)^2 + (0.1 ppm
/// t)^2 and h0 / 2 t + 2 pi^2 h-2 t^3 / 3. Five deviations sqrt(2 / N).
StressFigure clock_variance(double interval_s, std::int64_t epochs) {
  constexpr std::uint64_t kSeeds = 600;
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const double s = make_tcxo({.seed = seed, .interval_s = interval_s})->offset_m(epochs) / kSpeedOfLight;
    sum += s * s / kSeeds;
  }
  const double t = interval_s * static_cast<double>(epochs);
  const double exact = 1e-12 + 1e-14 * t * t + 1e-19 * t + 2.0 * kPi * kPi * 2e-20 * t * t * t / 3.0;
  return {std::abs(sum / exact - 1.0), 5.0 * std::sqrt(2.0 / kSeeds)};
}

/// Asked in any order, an epoch says the same, to the bit. A figure counts differences.
StressFigure clock_memory() {
  const auto one = make_tcxo({.seed = 3, .interval_s = 0.1}), other = make_tcxo({.seed = 3, .interval_s = 0.1});
  StressFigure out;
  for (const std::int64_t k : {50000, 7, 49999, 0, 50000}) {
    const auto fresh = make_tcxo({.seed = 3, .interval_s = 0.1});
    if (one->offset_m(k) != fresh->offset_m(k) || one->rate_m_s(k) != fresh->rate_m_s(k)) out.figure += 1.0;
  }
  return out;
}

/// The rate is the offset's derivative: over one epoch the offset moves by rate * dt and the white frequency noise,
/// 5.5 deviations of it in a million draws' worst; and the offset's own digits, eps of it.
StressFigure clock_rate_after(std::int64_t epochs) {
  constexpr double dt = 1.0;
  const auto clock = make_tcxo({.seed = 5, .interval_s = dt});
  const double before = clock->offset_m(epochs), rate = clock->rate_m_s(epochs), after = clock->offset_m(epochs + 1);
  const double sigma_m = kSpeedOfLight * std::sqrt(1e-19 * dt + 2.0 * kPi * kPi * 2e-20 * dt * dt * dt / 3.0);
  return {std::abs(after - before - rate * dt), 5.5 * sigma_m + 4.0 * kEpsilon * std::abs(before)};
}

/// Errors of orbit and clock on the way to a receiver, beneath the satellite and to all sides of it: over 4000 seeds
/// the mean square is that of the source's figures, radial and clock with their correlation, along and across by the
/// line of sight: five deviations; neighbouring hours go together, distant years do not, and none is beyond what is
/// stated.
StressFigure orbits_and_clocks(const char* name, double scale) {
  stress::Worst worst;
  const auto& row = model_row(ephemeris_error_models(), name);
  ModelParameters own;
  if (row.parameters != nullptr) row.parameters(own);
  const double radial_m = 1.07, along_m = 1.48, cross_m = 0.52, clock_m = 1.13, rho = 0.506;
  const double largest_m = row.make.need(own);
  SatelliteState satellite;
  satellite.p_E = Eigen::Vector3d(2.0e7, 1.2e7, 1.25e7);
  satellite.v_E = Eigen::Vector3d(-900.0, -1500.0, 2900.0);
  // Along is the way it goes among the stars, across the plane of that and the radius.
  const Eigen::Vector3d among_stars =
      satellite.v_E + 7.2921151467e-5 * Eigen::Vector3d(-satellite.p_E.y(), satellite.p_E.x(), 0.0);
  const Eigen::Vector3d radial = satellite.p_E.normalized(), cross = satellite.p_E.cross(among_stars).normalized(),
                        along = cross.cross(radial);
  constexpr int kSeeds = 4000;
  for (const Eigen::Vector3d& off :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, -0.7, 0.7), Eigen::Vector3d(0, 0, 1)}) {
    // Down to the horizon: off the radius by 14 degrees at most.
    const Eigen::Vector3d receiver_E = 6.37e6 * (radial + 3.0 * (off.y() * along + off.z() * cross)).normalized();
    const Eigen::Vector3d line = (satellite.p_E - receiver_E).normalized();
    const double expected =
        scale * scale *
        (std::pow(rho * clock_m - radial_m * line.dot(radial), 2) + (1.0 - rho * rho) * clock_m * clock_m +
         std::pow(along_m * line.dot(along), 2) + std::pow(cross_m * line.dot(cross), 2));
    double square = 0.0, near = 0.0, far = 0.0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      const auto model = row.make.make(own, {.seed = static_cast<std::uint64_t>(seed)});
      if (!model) return {stress::kInfinity, 1.0};
      const GpsTime t = GpsTime::from_week_sow(1700, 3600.0 * (seed % 100));
      const SatelliteId sv{GnssSystem::kGps, static_cast<std::uint8_t>(1 + seed % 31)};
      const double now = (*model)->range_m(sv, satellite, receiver_E, t),
                   later = (*model)->range_m(sv, satellite, receiver_E, t + 60.0),
                   years = (*model)->range_m(sv, satellite, receiver_E, t + 1e8);
      square += now * now / kSeeds, near += now * later / kSeeds, far += now * years / kSeeds;
      worst.look(beyond(std::abs(now), largest_m), 1e-9);
    }
    const double root = std::sqrt(1.0 * kSeeds);
    worst.look(square / expected - 1.0, 5.0 * std::sqrt(2.0) / root);
    // A minute of the fastest process, 3 h: 0.6 % of its part and two hundredths as its model states.
    worst.look(near / expected - 1.0, 5.0 * std::sqrt(2.0) / root + 0.03);
    worst.look(far / expected, 5.0 / root);
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> process_cases() {
  StressRows rows;
  rows.of({StressGroup::kLong, "a process with memory, far from its own time",
           "a recursion from its start: centuries of steps, or a count of nodes that overflows; nodes shorter than a "
           "nanosecond",
           "variance 1, correlation e^-1 after tau: 5 sqrt(2 / 1500) + 0.02 (false alarm 6e-7)", ""});
  struct At {
    double tau_s;
    std::int64_t ns;
    const char* name;
  };
  for (const At& at :
       {At{1e-6, 1'000'000'000'000'000'123, "1e-6_s_in_2011"}, At{60.0, 0, "60_s_at_the_epoch"},
        At{60.0, 8'900'000'000'123'456'789, "60_s_in_2262"}, At{3600.0, 1'234'567'890'123'456'789, "1_h_in_2019"},
        At{1e6, 2'147'483'648'000'000'000, "1e6_s_at_2^31_s"}, At{1e9, 9'007'199'254'740'992, "1e9_s_at_2^53_ns"}})
    rows.add(std::string("processes/gauss_markov_tau_") + at.name, [at] { return gauss_markov(at.tau_s, at.ns); });
  rows.of({StressGroup::kStiff, "a process between its nodes", "the wrong pair of nodes at a node: a jump",
           "two nanoseconds across a node change it by 12 * 4 ns / 7.5 s at most", ""});
  rows.add("processes/gauss_markov_across_nodes", across_nodes)
      .loose("the bound holds the steepest pair of neighbours, 12 deviations apart, which no draw comes near");

  rows.of(
      {StressGroup::kStiff, "a code loop against the epoch rate",
       "a loop slow against the epochs needs draws without end, one fast against them none; a recursion needs the past",
       "variance 1 and correlation exp(-4 B dt): 5 sqrt(2 / 400) + 1 / 1024", ""});
  struct Loop {
    double hz, interval_s;
    const char* name;
  };
  for (const Loop& loop :
       {Loop{0.001, 1e-3, "1_mhz_at_1000_hz"}, Loop{0.13, 0.01, "0.13_hz_at_100_hz"},
        Loop{0.13, 0.5, "0.13_hz_at_2_hz"}, Loop{20.0, 1.0, "20_hz_at_1_hz"}, Loop{20.0, 100.0, "20_hz_at_0.01_hz"}})
    rows.add(std::string("processes/code_loop_") + loop.name, [loop] { return loop_noise(loop.hz, loop.interval_s); });

  rows.of({StressGroup::kLong, "a receiver clock over long times and long epochs",
           "process noise of two states without their correlation, or of the wrong power of the epoch's length",
           "h0 t / 2 + 2 pi^2 h-2 t^3 / 3 and the start, 600 seeds: 5 sqrt(2 / 600)", ""});
  rows.add("processes/clock_after_100_s_at_10_hz", [] { return clock_variance(0.1, 1000); })
      .add("processes/clock_after_two_days_at_0.01_hz", [] { return clock_variance(100.0, 1728); })
      .add("processes/clock_after_one_epoch_of_1e6_s", [] { return clock_variance(1e6, 1); })
      .add("processes/clock_after_a_month_at_0.001_hz", [] { return clock_variance(1000.0, 2592); });
  rows.of({StressGroup::kLong, "a receiver clock's rate after many epochs", "an offset whose digits swallow its rate",
           "the offset moves by rate * dt: 5.5 sigma of its noise and its own digits", "m"});
  rows.add("processes/clock_rate_after_10_epochs", [] { return clock_rate_after(10); })
      .add("processes/clock_rate_after_a_day", [] { return clock_rate_after(86400); });
  rows.of({StressGroup::kData, "a receiver clock asked out of order", "a state that was advanced is not put back",
           "each epoch says the same, to the bit", "differences"});
  rows.add("processes/clock_out_of_order", clock_memory);
  rows.of({StressGroup::kData, "errors of orbits and clocks by the way to the receiver",
           "a part of the orbit along another axis, a correlation of the other sign",
           "the source's figures over the line of sight: five deviations of 4000 seeds", "of the bound"});
  rows.add("processes/orbits_and_clocks_of_2010", [] { return orbits_and_clocks("orbit_clock_2010", 1.0); })
      .add("processes/orbits_and_clocks_of_2021", [] { return orbits_and_clocks("orbit_clock_2021", 0.89 / 1.11); });
  return rows.take();
}

}  // namespace canyon::gnss
