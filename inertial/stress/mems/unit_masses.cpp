// The masses of a whole unit: what they make of noise, which cannot be, and what they forget.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// A whole unit of masses at rest: sums over m samples have the variance of the sheet's white noise through a low-pass
/// of the second order, N^2 times the integral of (sin(pi f m h) / (pi f))^2 over 1 + (f / corner)^4, whatever of it
/// the masses, the pick-off or the electronics make; at the corner of [mems], else the sheet's, else 0.4 of the rate.
/// Five standard deviations; six samples of a low-pass at a tenth of the rate hang together.
StressFigure noise_of_masses(double own_hz, double sheet_hz) {
  Looks looks;
  constexpr double kRate_hz = 250.0;
  constexpr int kCount = 3600;
  CatalogueEntry entry = *load_catalogue_entry("high_grade_mems");
  entry.mems.accel.bandwidth_hz = entry.mems.gyro.bandwidth_hz = own_hz;
  entry.gyro.bandwidth_hz.value = entry.accel.bandwidth_hz.value = sheet_hz;
  // Flat far beyond the samples, and for that a heavier mass that swings further.
  entry.mems.gyro.split_hz = 2000.0, entry.mems.gyro.quality_factor = 5.0;
  entry.mems.gyro.mass_kg = 1e-6, entry.mems.gyro.drive_amplitude_m = 5e-5;
  entry.mems.gyro.pick_off_figures.amplifier_v_sqrt_hz = 2e-9;
  entry.mems.accel.filter_order = entry.mems.gyro.filter_order = 2;
  std::vector<std::string> others;
  for (const auto& row : error_links()) others.emplace_back(row.name);
  const auto chain = make_error_chain("physics", {.entry = entry, .seed = 5, .rate_hz = kRate_hz, .leave_out = others});
  if (!chain) return {kInfinity, 1.0};
  const ImuNoise sheet = entry.noise();
  looks.close((*chain)->noise().gyro.white_per_sqrt_hz, sheet.gyro.white_per_sqrt_hz, 2.0);
  looks.close((*chain)->noise().accel.white_per_sqrt_hz, sheet.accel.white_per_sqrt_hz, 2.0);
  std::array<std::vector<double>, 6> errors;
  for (int k = 0; k < kCount; ++k) {
    ImuSample s;
    s.dt_s = 1.0 / kRate_hz;
    (*chain)->corrupt(k, s);
    for (std::size_t c = 0; c < 6; ++c)
      errors[c].push_back(c < 3 ? s.dtheta_U[static_cast<Eigen::Index>(c)] : s.dv_U[static_cast<Eigen::Index>(c - 3)]);
  }
  const double corner_hz = own_hz > 0.0 ? own_hz : sheet_hz > 0.0 ? sheet_hz : 0.4 * kRate_hz;
  for (const int m : {1, 2, 5, 60}) {
    const double t = m / kRate_hz;
    // Two-sided: twice the sum over positive frequencies, to fifty corners; the rest is (1 / 50)^4.
    long double integral = 0.0L;
    constexpr int kParts = 20'000;
    const double step = 50.0 * corner_hz / kParts;
    for (int i = 0; i < kParts; ++i) {
      const double hz = (i + 0.5) * step, x = std::sin(kPi * hz * t) / (kPi * hz);
      integral += 2.0 * step * x * x / (1.0 + std::pow(hz / corner_hz, 4));
    }
    for (std::size_t triad = 0; triad < 2; ++triad) {
      const double n = triad == 0 ? sheet.gyro.white_per_sqrt_hz : sheet.accel.white_per_sqrt_hz;
      double square = 0.0, count = 0.0;
      for (std::size_t c = 3 * triad; c < 3 * triad + 3; ++c)
        for (int begin = 12; begin + m <= kCount; begin += m, count += 1.0) {
          double sum = 0.0;
          for (int i = begin; i < begin + m; ++i) sum += errors[c][static_cast<std::size_t>(i)];
          square += sum * sum;
        }
      const double together = std::max(1.0, 0.6 * kRate_hz / corner_hz / m);
      looks.near(square / count / (n * n * static_cast<double>(integral)), 1.0,
                 5.0 * std::sqrt(2.0 * together / count));
    }
  }
  return looks.figure();
}

/// Units of masses that cannot be: without figures, noisier than their sheet, or carried by a scheme that diverges.
StressFigure refused_masses() {
  int passed = 0;
  const CatalogueEntry entry = *load_catalogue_entry("high_grade_mems");
  const auto made = [](const CatalogueEntry& e, double rate_hz) {
    return make_error_chain("physics", {.entry = e, .seed = 1, .rate_hz = rate_hz}).ok() ? 1 : 0;
  };
  passed += 1 - made(entry, 100.0);
  CatalogueEntry other = entry;
  other.mems.given = false;
  passed += made(other, 100.0);
  for (const bool gyro : {true, false}) {
    other = entry;
    (gyro ? other.mems.gyro : other.mems.accel).mass_kg = 1e-14;
    passed += made(other, 100.0);
  }
  other = entry;
  other.mems.integrator = "rk4";
  passed += made(other, 100.0);
  other = entry;
  other.paper.given = false;
  passed += make_error_chain("paper", {.entry = other, .seed = 1, .rate_hz = 100.0}).ok() ? 1 : 0;
  passed += make_error_chain("none", {.entry = entry, .seed = 1, .rate_hz = 100.0, .leave_out = {"ramp"}}).ok() ? 1 : 0;
  passed += make_error_chain("full", {.entry = entry, .seed = 1, .rate_hz = 100.0, .leave_out = {"rump"}}).ok() ? 1 : 0;
  passed += make_error_chain("half", {.entry = entry, .seed = 1, .rate_hz = 100.0}).ok() ? 1 : 0;
  return {1.0 * passed, 0.0};
}

/// Samples of a mass asked for one after the other, and anew from the middle: what it has forgotten is below a double's
/// last digit, so that from where the unit's own memory reaches on the two agree to 64 roundings.
StressFigure masses_forget() {
  Looks looks;
  CatalogueEntry entry = *load_catalogue_entry("high_grade_mems");
  std::vector<std::string> others;
  for (const auto& row : error_links()) others.emplace_back(row.name);
  const ChainSetup setup{.entry = entry, .seed = 5, .rate_hz = 250.0, .leave_out = others};
  const auto whole = make_error_chain("physics", setup), part = make_error_chain("physics", setup);
  if (!whole || !part) return {kInfinity, 1.0};
  const std::int64_t memory = (*whole)->memory();
  looks.right(memory > 2 && memory < 2000);
  const auto sample = [](std::int64_t k) {
    ImuSample s;
    s.dt_s = 0.004;
    s.dtheta_U = 0.004 * Vector3d(std::sin(0.3 * static_cast<double>(k)), 0.5, -0.2);
    s.dv_U = 0.004 * Vector3d(1.0, std::cos(0.2 * static_cast<double>(k)), 9.8);
    return s;
  };
  std::vector<ImuSample> all;
  for (std::int64_t k = 0; k < 2 * memory + 30; ++k) {
    ImuSample s = sample(k);
    (*whole)->corrupt(k, s);
    all.push_back(s);
  }
  for (std::int64_t k = memory; k < 2 * memory + 30; ++k) {
    ImuSample s = sample(k);
    (*part)->corrupt(k, s);
    if (k < 2 * memory) continue;
    const ImuSample& same = all[static_cast<std::size_t>(k)];
    looks.near((s.dtheta_U - same.dtheta_U).norm(), 0.0, 64.0 * kEpsilon * 0.004 * 1.2 + 1e-15);
    looks.near((s.dv_U - same.dv_U).norm(), 0.0, 64.0 * kEpsilon * 0.004 * 10.0 + 1e-14);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> unit_mass_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "the noise of a whole unit of masses", "the sheet's noise twice, or another corner's",
           "the sheet's density through a low-pass, integrated over frequency: five deviations", "of the bound"});
  for (const auto& [own, sheet] : {std::pair(25.0, 80.0), std::pair(0.0, 40.0), std::pair(0.0, 0.0)})
    rows.add("elements/noise_at_" + stress::text(own) + "_and_" + stress::text(sheet) + "_hz",
             [o = own, s = sheet] { return noise_of_masses(o, s); });
  rows.of({StressGroup::kData, "units that cannot be", "a scheme that diverges, noise beyond the sheet's",
           "each refused, and the sound one made", "let through"});
  rows.add("elements/refused", refused_masses);
  rows.of({StressGroup::kStiff, "a mass that forgets", "a memory that is too short, or of another element's",
           "the same from where it ends: roundings", "of the bound"});
  rows.add("elements/forgotten", masses_forget);
  return rows.take();
}

}  // namespace canyon::inertial
