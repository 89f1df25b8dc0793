// A unit's samples on their way out: stamps that run and jitter, and groups that are lost.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/inertial/errors/error_link.h"
#include "canyon/inertial/stress/errors/one_link.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using made::Increments;
using made::kStep_s;
using made::link_of;
using made::still;
using made::through;
using stress::Looks;

/// Stamps: a skew that grows, jitter of the stated size about it, held within a quarter of an interval, and intervals
/// that are the stamps' own differences.
StressFigure stamps() {
  Looks looks;
  LinkSetup setup{.figures = {}, .environment = {}, .seed = 0, .dt_s = kStep_s};
  constexpr int kUnits = 400;
  double skewed = 0.0, jittered = 0.0, jitters = 0.0, held = 0.0, holds = 0.0;
  const auto in = still(300);
  for (setup.seed = 1; setup.seed <= kUnits; ++setup.seed) {
    std::vector<ImuSample> samples;
    setup.figures.clock_skew = 1e-4, setup.figures.clock_jitter_s = 0.0;
    through(*link_of("clock", setup), 1000, in, &samples);
    const double skew = (samples[0].t - GpsTime{}) / (1001.0 * kStep_s) - 1.0;
    skewed += std::pow(skew / 1e-4, 2) / kUnits;
    // A stamp is rounded to a nanosecond of 20 s.
    for (std::size_t i = 0; i < samples.size(); i += 37) {
      looks.near((samples[i].t - GpsTime{}) / ((1001.0 + static_cast<double>(i)) * kStep_s) - 1.0, skew, 1e-10);
      looks.near(samples[i].dt_s / kStep_s - 1.0, skew, 1e-10);
    }
    for (const double sigma_s : {1e-3, 0.05}) {
      setup.figures.clock_skew = 0.0, setup.figures.clock_jitter_s = sigma_s;
      through(*link_of("clock", setup), 250, in, &samples);
      double before_s = 0.0;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double off_s = (samples[i].t - GpsTime{}) - (251.0 + static_cast<double>(i)) * kStep_s;
        if (i > 0) looks.near(samples[i].dt_s - kStep_s, off_s - before_s, 1.1e-9);
        before_s = off_s;
        looks.right(std::abs(off_s) <= 0.25 * kStep_s + 1e-9);
        if (sigma_s == 1e-3) jittered += off_s * off_s, jitters += 1.0;
        if (sigma_s == 0.05) held += std::abs(off_s) > 0.25 * kStep_s - 1e-9 ? 1.0 : 0.0, holds += 1.0;
      }
    }
  }
  looks.near(skewed, 1.0, 5.0 * std::sqrt(2.0 / kUnits));
  // Held at 5 sigma: 6e-7 of them.
  looks.near(jittered / jitters / 1e-6, 1.0, 5.0 * std::sqrt(2.0 / jitters));
  // Beyond a tenth of sigma either way.
  const double beyond_it = std::erfc(0.1 / std::sqrt(2.0));
  looks.near(held / holds, beyond_it, 5.0 * std::sqrt(beyond_it * (1.0 - beyond_it) / holds));
  return looks.figure();
}

/// What is lost is lost in whole groups, none after another, never the first, and gives the last sample that came.
StressFigure groups_lost() {
  Looks looks;
  LinkSetup setup{.figures = {}, .environment = {}, .seed = 5, .dt_s = kStep_s};
  constexpr std::int64_t kLength = 4;
  setup.figures.loss_share = 0.2, setup.figures.loss_length = static_cast<double>(kLength);
  const auto link = link_of("losses", setup);
  looks.right(link->memory() == kLength + 1);
  std::vector<Increments> in;
  for (int k = 0; k < 1200; ++k) in.push_back({Vector3d(k, 2.0 * k, -k), Vector3d(-3.0 * k, k + 0.5, 7.0 * k)});
  std::vector<ImuSample> samples;
  const auto out = through(*link, 512, in, &samples);
  std::size_t last = 0;
  int run = 0;
  for (std::size_t k = 0; k < in.size(); ++k) {
    const auto number = 512 + static_cast<std::int64_t>(k);
    if (samples[k].lost) {
      looks.right(k > 0 && (run > 0 || k == 1 || number % kLength == 0));
      ++run;
    } else {
      looks.right(run == 0 || run == kLength || (run < kLength && k < kLength + 1));
      run = 0;
      last = k;
    }
    for (std::size_t t = 0; t < 2; ++t) looks.right(out[k][t] == in[last][t]);
  }
  looks.right(stress::not_refused([&] {
                setup.figures.loss_share = 0.3;
                link_of("losses", setup);
              }) == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> stamp_and_loss_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "stamps and losses of a unit",
           "jitter of another sample, groups that follow one another",
           "their laws to a nanosecond, and shares to five deviations", "of the bound"});
  rows.add("links/stamps", stamps).add("links/groups_lost", groups_lost);
  return rows.take();
}

}  // namespace canyon::inertial
