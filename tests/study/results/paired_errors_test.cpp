#include "canyon/study/results/paired_errors.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

const GpsTime kStart{};

/// Ten epochs a second from after_s on whose error is `error(t_s)` to the east.
template <class Function>
class Errors : public RowStore<EpochError> {
 public:
  Errors(double duration_s, Function error, double after_s = 0.0) : RowStore<EpochError>(::testing::TempDir()) {
    for (int k = 1; k <= static_cast<int>(10 * duration_s); ++k) {
      const double error_m = error(0.1 * k);
      if (0.1 * k <= after_s + 0.05) continue;
      EXPECT_TRUE(append({tick(kStart, k, 10.0), error_m, 0.0, 0.0}).ok());
    }
  }
};

TEST(PairedErrors, AConstantDifferenceHasNoSpread) {
  const Errors a(120.0, [](double t) { return 1.0 + std::sin(t); });
  const Errors b(120.0, [](double t) { return 1.5 + std::sin(t); });
  // Errors are lengths: keep both positive (1.0 + sin >= 0), then the difference is 0.5 at each epoch.
  const PairedErrors paired = *paired_errors(a, b, kStart);
  EXPECT_EQ(paired.epochs, 1200);
  EXPECT_NEAR(paired.mean_m, 0.5, 1e-12);
  EXPECT_NEAR(paired.high_m - paired.low_m, 0.0, 1e-12);
  EXPECT_EQ(paired.worse_share, 1.0);
}

// An error that is correlated over 5 s: of 400 intervals 95 % hold the true difference. Binomial sigma 1.1 %; batches
// of six correlation times are not quite independent, which costs about 2 %: 3 sigma below 93 % and above 95 %.
TEST(PairedErrors, TheIntervalHoldsTheTrueDifferenceAsOftenAsItSays) {
  int held = 0;
  constexpr int kRuns = 400;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const RandomStream stream(seed, "test.paired");
    double x = 0.0;
    std::uint32_t k = 0;
    const double decay = std::exp(-0.1 / 5.0);
    x = stream.normal(0, k++);
    const Errors b(600.0, [&](double) {
      x = decay * x + std::sqrt(1.0 - decay * decay) * stream.normal(0, k++);
      return 10.0 + x;
    });
    const Errors a(600.0, [](double) { return 9.0; });
    const PairedErrors paired = *paired_errors(a, b, kStart);
    held += paired.low_m <= 1.0 && 1.0 <= paired.high_m ? 1 : 0;
  }
  EXPECT_GT(held, kRuns * (0.93 - 3 * 0.011));
  EXPECT_LT(held, kRuns * (0.95 + 3 * 0.011));
}

TEST(PairedErrors, OnlyEqualTimesCountAndAShortRunHasNoInterval) {
  const Errors a(40.0, [](double) { return 1.0; });
  const Errors b(
      40.0, [](double) { return 2.0; }, 10.0);
  const PairedErrors paired = *paired_errors(a, b, kStart);
  EXPECT_EQ(paired.epochs, 300);
  EXPECT_TRUE(std::isnan(paired.low_m));
}

}  // namespace
}  // namespace canyon::study
