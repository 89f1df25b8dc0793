#include "canyon/inertial/error_chain.h"

#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;

std::unique_ptr<ErrorChain> chain_of(const CatalogueEntry& entry, double rate_hz) {
  return *make_error_chain("full", {.entry = entry, .seed = 4, .rate_hz = rate_hz});
}

ImuSample sample_at(std::int64_t k, double rate_hz, const Vector3d& rate, const Vector3d& force) {
  ImuSample s;
  s.t = tick({}, k + 1, rate_hz);
  s.dt_s = 1.0 / rate_hz;
  s.dtheta_U = rate * s.dt_s;
  s.dv_U = force * s.dt_s;
  return s;
}

/// Beyond 2000 deg/s and 50 g the output is the range, with its sign; within it is the input to the bit.
StressFigure saturation() {
  CatalogueEntry entry;
  entry.gyro.range_deg_per_s.value = 2000.0;
  entry.accel.range_g.value = 50.0;
  const auto chain = chain_of(entry, 100.0);
  const double rate = 2000.0 * kDegree, force = 50.0 * kStandardGravity;
  int wrong = 0;
  std::int64_t k = 0;
  for (const double over : {-1e300, -1e9, -1.0001, -0.9999, -1e-300, 0.0, 0.5, 0.9999, 1.0001, 7.0, 1e12}) {
    ImuSample s = sample_at(k, 100.0, Vector3d::Constant(over * rate), Vector3d::Constant(-over * force));
    const ImuSample in = s;
    chain->corrupt(k++, s);
    const double kept = std::clamp(over, -1.0, 1.0);
    const double unit = s.dt_s * (1.0 + 4.0 * kEpsilon), slack = 8.0 * kEpsilon;
    wrong += std::abs(over) < 1.0 && (s.dtheta_U != in.dtheta_U || s.dv_U != in.dv_U) ? 1 : 0;
    wrong += (s.dtheta_U.array() - kept * rate * s.dt_s).abs().maxCoeff<Eigen::PropagateNaN>() <= slack * rate * unit
                 ? 0
                 : 1;
    wrong +=
        (s.dv_U.array() + kept * force * s.dt_s).abs().maxCoeff<Eigen::PropagateNaN>() <= slack * force * unit ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// Off the input by half a step at most, and by four roundings of the input where that is more.
StressFigure quantization(double step_deg_per_s) {
  CatalogueEntry entry;
  entry.gyro.resolution_deg_per_s.value = step_deg_per_s;
  const auto chain = chain_of(entry, 1000.0);
  const double step = step_deg_per_s * kDegree / 1000.0;
  stress::Worst worst;
  std::int64_t k = 0;
  for (double rate = 1e-9; rate < 1e4; rate *= 3.3)
    for (const double sign : {-1.0, 1.0}) {
      ImuSample s = sample_at(k, 1000.0, Vector3d::Constant(sign * rate), Vector3d::Zero());
      const double in = s.dtheta_U.x();
      chain->corrupt(k++, s);
      worst.look(s.dtheta_U.x() - in, 0.5 * step + 4.0 * kEpsilon * std::abs(in));
    }
  return worst.figure();
}

/// A clock that is 100 ppm fast and jitters, at the end of a day: the interval that a sample names is that between two
/// stamps, each of which is rounded to a nanosecond; and the whole day's error is that of the intervals before.
StressFigure clock_of_a_day(double rate_hz) {
  CatalogueEntry entry;
  entry.unit.clock_skew_ppm.value = 100.0;
  entry.unit.clock_jitter_us.value = 50.0;
  const auto chain = chain_of(entry, rate_hz);
  const auto last = static_cast<std::int64_t>(86400.0 * rate_hz);
  double worst_ns = 0.0;
  GpsTime before{};
  for (std::int64_t k = last - 600; k < last; ++k) {
    ImuSample s = sample_at(k, rate_hz, Vector3d::Zero(), Vector3d::Zero());
    const double nominal_ns =
        1e9 / rate_hz - static_cast<double>((tick({}, k + 1, rate_hz).ns - tick({}, k, rate_hz).ns));
    chain->corrupt(k, s);
    if (before.ns != 0) worst_ns = worse(worst_ns, std::abs((s.t - before - s.dt_s) * 1e9 + nominal_ns));
    before = s.t;
  }
  return {worst_ns, 1.0 + 0.01};
}

/// Every link there is, in a batch over the border of two blocks and one by one backwards: the same bits, but for those
/// with memory.
StressFigure order_of_samples() {
  CatalogueEntry entry = *load_catalogue_entry("adis16470");
  entry.gyro.quantization_noise_deg.value = 1e-4;
  entry.gyro.rate_random_walk_deg_per_hr_per_sqrt_hr.value = 2.0;
  entry.unit.clock_jitter_us.value = 50.0;
  const auto batch = chain_of(entry, 200.0), single = chain_of(entry, 200.0);
  constexpr std::int64_t kFirst = 40 * 256 - 30, kCount = 60;
  std::vector<ImuSample> all;
  for (std::int64_t i = 0; i < kCount; ++i)
    all.push_back(sample_at(kFirst + i, 200.0, {0.01, -0.2, 3.0}, {0.1, 9.8, -50.0}));
  const auto in = all;
  batch->corrupt_batch(kFirst, all);
  int wrong = 0;
  for (std::int64_t i = kCount - 1; i >= 0; --i) {
    ImuSample s = in[static_cast<std::size_t>(i)];
    single->corrupt(kFirst + i, s);
    const ImuSample& b = all[static_cast<std::size_t>(i)];
    wrong += s.dtheta_U == b.dtheta_U && s.dv_U == b.dv_U && s.t == b.t && s.dt_s == b.dt_s ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// The share of groups that are lost, p (1 - p) of 20 000 draws, of which neighbours are against one another: six
/// standard deviations of independent ones.
StressFigure losses(double percent, double length) {
  CatalogueEntry entry;
  entry.unit.loss_percent.value = percent;
  entry.unit.loss_length.value = length;
  const auto chain = chain_of(entry, 100.0);
  const auto groups = 20'000.0;
  const auto count = static_cast<std::int64_t>(groups * length);
  double lost = 0.0;
  for (std::int64_t k = 0; k < count; ++k) {
    ImuSample s = sample_at(k, 100.0, Vector3d::Constant(1.0), Vector3d::Constant(static_cast<double>(k)));
    chain->corrupt(k, s);
    lost += s.lost ? 1.0 : 0.0;
    if (s.lost == (s.dv_U.x() == static_cast<double>(k) * s.dt_s)) return {stress::kInfinity, 0.0};
  }
  const double share = 0.01 * percent;
  return {std::abs(lost / static_cast<double>(count) - share), 6.0 * std::sqrt(share * (1.0 - share) / groups)};
}

/// A latency beyond the whole run: the motion of the first sample is all that ever comes.
StressFigure latency_beyond_the_run() {
  CatalogueEntry entry;
  entry.unit.latency_ms.value = 1000.0;
  const auto chain = chain_of(entry, 5000.0);
  int wrong = 0;
  for (std::int64_t k = 0; k < 700; ++k) {
    const double now = 1.0 + static_cast<double>(k);
    ImuSample s = sample_at(k, 5000.0, Vector3d::Constant(now), Vector3d::Constant(-now));
    chain->corrupt(k, s);
    wrong +=
        std::abs(s.dtheta_U.x() - s.dt_s) <= 4.0 * kEpsilon * s.dt_s && std::abs(s.dv_U.y() + s.dt_s) < 1e-15 ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// A latency of m whole samples and a part f of one: sample k holds f of the motion m + 1 samples before and 1 - f of
/// that m before, for both triads and all axes, whether they are asked for one by one, in batches over the border of a
/// block, or anew after others; before the first it is the first: roundings of a sum of two.
StressFigure latency_in_samples(double samples) {
  constexpr double kRate_hz = 200.0;
  CatalogueEntry entry;
  entry.unit.latency_ms.value = 1e3 * samples / kRate_hz;
  stress::Worst worst;
  const auto motion = [](std::int64_t k) {
    const auto x = static_cast<double>(k);
    return Vector3d(std::sin(0.3 * x), 2.0 + 0.01 * x, std::cos(1.7 * x));
  };
  const auto in = [&](std::int64_t k) { return sample_at(k, kRate_hz, motion(k), -3.0 * motion(k + 5)); };
  const auto whole = static_cast<std::int64_t>(samples + 1e-9);
  const double part = samples - static_cast<double>(whole);
  const auto look = [&](const ImuSample& out, std::int64_t k, std::int64_t first) {
    const auto from = [&](std::int64_t before) { return worse(k - before, first); };
    const Vector3d rate = part * motion(from(whole + 1)) + (1.0 - part) * motion(from(whole));
    const Vector3d force = -3.0 * (part * motion(from(whole + 1) + 5) + (1.0 - part) * motion(from(whole) + 5));
    // The part of a sample is one of the quotient, which rounds by so many epsilons of itself.
    const double rounding = (16.0 + 8.0 * samples) * kEpsilon * out.dt_s;
    worst.look((out.dtheta_U - out.dt_s * rate).norm(), rounding * 8.0);
    worst.look((out.dv_U - out.dt_s * force).norm(), rounding * 24.0);
  };
  const auto one_by_one = chain_of(entry, kRate_hz), batches = chain_of(entry, kRate_hz);
  worst.look(static_cast<double>(one_by_one->memory() - whole - 1), 0.5);
  for (const std::int64_t first : {std::int64_t{0}, std::int64_t{4000}, std::int64_t{170}}) {
    for (std::int64_t k = first; k < first + 700; ++k) {
      ImuSample s = in(k);
      one_by_one->corrupt(k, s);
      look(s, k, first);
    }
    for (std::int64_t k = first, count = 1; k < first + 700; k += count, count = 1 + (count * 7) % 61) {
      std::vector<ImuSample> some;
      for (std::int64_t i = 0; i < count; ++i) some.push_back(in(k + i));
      batches->corrupt_batch(k, some);
      for (std::int64_t i = 0; i < count; ++i) look(some[static_cast<std::size_t>(i)], k + i, first);
    }
  }
  return worst.figure();
}

StressFigure refused_samples() {
  const auto chain = chain_of(*load_catalogue_entry("high_grade_mems"), 100.0);
  int passed = 0;
  for (const double dt_s : {0.0, -0.01, 0.02, 0.0101, stress::kInfinity, std::nan("")})
    passed += stress::not_refused([&] {
      ImuSample s = sample_at(0, 100.0, Vector3d::Zero(), Vector3d::Zero());
      s.dt_s = dt_s;
      chain->corrupt(0, s);
    });
  passed += stress::not_refused([&] {
    ImuSample s = sample_at(0, 100.0, Vector3d::Zero(), Vector3d::Zero());
    chain->corrupt(-1, s);
  });
  return {1.0 * passed, 0.0};
}

}  // namespace

std::vector<StressCase> error_chain_cases() {
  const auto group = StressGroup::kData;
  const StressMechanism range{
      group, "an input beyond the range",
      "a limit that wraps around, is taken of the vector's length, or of the wrong unit",
      "2000 deg/s and 50 g stay, with their sign, whatever comes in; within, the input to the bit", "samples"};
  const StressMechanism steps{
      group, "a step of the output against the size of the input",
      "beyond 2^51 steps the adding of 1.5 x 2^52 rounds to other steps, below half a step all is zero",
      "half a step, or four roundings of the input where that is more", "of the bound"};
  const StressMechanism drift{StressGroup::kLong, "a clock's error over a day",
                              "stamps and intervals that are added up part ways",
                              "the interval is the difference of the stamps: half a nanosecond each", "ns"};
  const StressMechanism border{
      group, "the border of a block of samples", "noise that depends on how many samples were asked for together",
      "a batch over the border is to the bit what its samples are backwards, one by one", "samples"};
  const StressMechanism loss{
      group, "samples that do not arrive", "groups that follow one another last longer, and the share is another",
      "the share, to six standard deviations of 20 000 draws, and the last sample repeated, never a new one", ""};
  const StressMechanism delay{group, "a delay longer than the run", "the buffer is read before its beginning",
                              "the first sample's motion, all along", "samples"};
  const StressMechanism refusal{group, "a sample that is not of the chain's own rate",
                                "noise of another interval is added without a word",
                                "each is refused, also an interval that is no number", "let through"};
  StressRows rows;
  rows.of(range).add("error_chain/2000_deg_s_and_50_g", saturation);
  rows.of(border).add("error_chain/batch_over_a_block", order_of_samples);
  rows.of(delay).add("error_chain/latency_beyond_the_run", latency_beyond_the_run);
  rows.of({group, "a delay of samples and parts of one", "a sample more or less that is kept, or a part for its rest",
           "the motion so many samples before, shared between two: roundings", "of the bound"});
  for (const double samples : {0.3, 1.0, 2.0, 7.75, 300.5})
    rows.add("error_chain/latency_of_" + stress::text(samples) + "_samples",
             [=] { return latency_in_samples(samples); });
  rows.of(refusal).add("error_chain/intervals_refused", refused_samples);
  for (const double step : {1e-12, 1e-3, 10.0})
    rows.of(steps).add("error_chain/resolution_" + stress::text(step) + "_deg_s", [=] { return quantization(step); });
  for (const double rate_hz : {10.0, 333.0, 5000.0})
    rows.of(drift).add("error_chain/clock_after_a_day_at_" + stress::text(rate_hz) + "_hz",
                       [=] { return clock_of_a_day(rate_hz); });
  rows.of(loss).add("error_chain/losses_of_24.5_percent", [] { return losses(24.5, 1.0); });
  rows.of(loss).add("error_chain/losses_of_0.1_percent_7_long", [] { return losses(0.1, 7.0); });
  return rows.take();
}

}  // namespace canyon::inertial
