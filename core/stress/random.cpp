#include "canyon/core/random/random.h"

#include <array>
#include <vector>

#include "canyon/core/random/random_math.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"

namespace canyon {
namespace {

/// A batch of draws against the draws one by one, at the ends of the entities and draw numbers too.
StressFigure batch_from(std::uint64_t first) {
  const RandomStream stream(3, "stress");
  int wrong = 0;
  for (const std::uint32_t end : {0u, 0xFFFFFFFFu})
    for (const std::uint64_t skip : {0, 1}) {
      std::array<double, 150> normals{}, uniforms{};
      stream.fill_normal(normals, end, first + skip, end);
      stream.fill_uniform(uniforms, end, first + skip, end);
      for (std::size_t i = 0; i < normals.size(); ++i) {
        wrong += normals[i] == stream.normal(end, first + skip + i, end) ? 0 : 1;
        wrong += uniforms[i] == stream.uniform(end, first + skip + i, end) ? 0 : 1;
      }
    }
  return {1.0 * wrong, 0.0};
}

/// Relative error of the logarithm from the smallest uniform number to 1, at powers of two and where its exponent
/// steps.
StressFigure logarithm() {
  double worst = 0.0;
  for (int e = 0; e >= -53; --e)
    for (const double m : {1.0, 0.70710678118654746, 0.70710678118654757, 0.75, 1.0 - 0x1p-53})
      for (const double x : {std::ldexp(m, e), std::nextafter(std::ldexp(m, e), 1.0)}) {
        if (x >= 1.0 || x < 0x1p-53) continue;
        const long double exact = std::log(static_cast<long double>(x));
        worst = worse(worst, static_cast<double>(std::abs((random_math::log_positive(x) - exact) / exact)));
      }
  return {random_math::log_positive(1.0) == 0.0 ? worst : stress::kInfinity, 1e-15};
}

/// Error of sine and cosine of a turn's parts, at the borders of eighths and beside them.
StressFigure turns() {
  constexpr long double kTurn = 6.283185307179586476925286766559L;
  double worst = 0.0;
  for (int i = 0; i <= 4096; ++i)
    for (const double u : {i / 4096.0, std::nextafter(i / 4096.0, 0.0), std::nextafter(i / 4096.0, 1.0)}) {
      const auto [sine, cosine] = random_math::sin_cos_turns(u);
      const long double angle = kTurn * static_cast<long double>(u);
      worst = worse(worst, static_cast<double>(std::abs(sine - std::sin(angle))));
      worst = worse(worst, static_cast<double>(std::abs(cosine - std::cos(angle))));
    }
  return {worst, 3e-16};
}

/// What words of all zeros and all ones become.
StressFigure end_words() {
  int wrong = 0;
  constexpr std::uint64_t kOnes = 0xFFFFFFFF;
  wrong += random_math::uniform53(0, 0) == 0.0 ? 0 : 1;
  wrong += random_math::uniform53(kOnes, kOnes) == 1.0 - 0x1p-53 ? 0 : 1;
  wrong += random_math::uniform53_above_zero(0, 0) == 0x1p-53 ? 0 : 1;
  wrong += random_math::uniform53_above_zero(kOnes, kOnes) == 1.0 ? 0 : 1;
  wrong += random_math::box_muller_radius(1.0) == 0.0 ? 0 : 1;
  wrong += std::abs(random_math::box_muller_radius(0x1p-53) - std::sqrt(2.0 * 53.0 * std::log(2.0))) < 1e-14 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> random_cases() {
  const StressMechanism count{
      StressGroup::kData, "the random counter's ends",
      "the batch adds to the low word without a carry, or goes on past the last index where one by one it starts anew "
      "(found by this case, 2026-11-22)",
      "a batch is to the bit what its draws are one by one, at any index, entity and draw number: exact", "draws"};
  const StressMechanism ends{
      StressGroup::kData, "the ends of the uniform interval",
      "log(0), 1 itself as a uniform number, or a sine that has lost its sign at a border of quarters",
      "the errors that random_math.h states: 1e-15 of the logarithm, 3e-16 of sine and cosine, by 64 bits of mantissa",
      ""};
  StressRows rows;
  rows.of(count).add("random/batch_from_index_0", [] { return batch_from(0); });
  rows.of(count).add("random/batch_over_32_bits_of_blocks", [] { return batch_from((std::uint64_t{1} << 33) - 70); });
  rows.of(count).add("random/batch_over_53_bits", [] { return batch_from((std::uint64_t{1} << 53) - 71); });
  rows.of(count).add("random/batch_over_the_last_index", [] { return batch_from(0 - std::uint64_t{75}); });
  rows.of(ends).add("random/logarithm_to_its_ends", logarithm);
  rows.of(ends).add("random/sine_and_cosine_of_turns", turns);
  rows.of(ends).add("random/words_of_zeros_and_ones", end_words);
  return rows.take();
}

}  // namespace canyon
