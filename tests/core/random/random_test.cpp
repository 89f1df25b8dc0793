#include "canyon/core/random/random.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/core/random/random_batch.h"
#include "canyon/core/random/random_math.h"

namespace canyon {
namespace {

/// The seed for which splitmix64 gives this value: each of its steps is invertible.
std::uint64_t splitmix64_inverse(std::uint64_t z) {
  z ^= (z >> 31) ^ (z >> 62);
  z *= 0x319642B2D24D8EC3;
  z ^= (z >> 27) ^ (z >> 54);
  z *= 0x96DE1B173F119089;
  z ^= (z >> 30) ^ (z >> 60);
  return z - 0x9E3779B97F4A7C15;
}

constexpr std::uint64_t kEmptyHash = 0xCBF29CE484222325;  // FNV-1a of ""

// splitmix64(0) and FNV-1a("foobar") as their authors publish them.
TEST(RandomStream, KeyIsSplitmixOfTheSeedXorHashOfTheName) {
  EXPECT_EQ(RandomStream(0, "").key(), 0xE220A8397B1DCDAFull ^ kEmptyHash);
  EXPECT_EQ(RandomStream(0, "foobar").key(), 0xE220A8397B1DCDAFull ^ 0x85944171F73967E8ull);
  EXPECT_EQ(RandomStream(splitmix64_inverse(kEmptyHash), "").key(), 0u);
}

/// A row of Random123's kat_vectors for philox4x32, 10 rounds.
struct KnownAnswer {
  std::array<std::uint32_t, 4> counter;
  std::uint64_t key;
  std::array<std::uint32_t, 4> words;
};

const KnownAnswer kKnownAnswers[] = {{{0, 0, 0, 0}, 0, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
                                     {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
                                      0xffffffffffffffff,
                                      {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
                                     {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
                                      0x299f31d0a4093822,
                                      {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}}};

TEST(RandomStream, BatchGivesThePublishedPhiloxVectors) {
  for (const KnownAnswer& k : kKnownAnswers) {
    std::array<double, kRandomTile> out{};
    const std::uint64_t block = (std::uint64_t{k.counter[1]} << 32) | k.counter[0];
    uniform_tile(k.key, k.counter[2], block, k.counter[3], out.data());
    EXPECT_EQ(out[0], random_math::uniform53(k.words[0], k.words[1]));
    EXPECT_EQ(out[1], random_math::uniform53(k.words[2], k.words[3]));
  }
}

// What the instruction set of the machine allows against the plain code, carries of the counter included.
TEST(RandomStream, EveryInstructionSetGivesTheSameWords) {
  for (const std::uint64_t first : {0ull, 7ull, (1ull << 32) - 9, ~0ull - 5}) {
    for (const KnownAnswer& k : kKnownAnswers) {
      PhiloxTile plain, best;
      philox_tile_portable(k.key, k.counter[2], first, k.counter[3], plain);
      philox_tile_of_this_machine()(k.key, k.counter[2], first, k.counter[3], best);
      for (std::size_t word = 0; word < 4; ++word) {
        for (std::size_t b = 0; b < kRandomTile / 2; ++b) {
          ASSERT_EQ(best.words[word][b], plain.words[word][b]) << first << " + " << b;
        }
      }
    }
  }
}

TEST(RandomStream, ScalarGivesThePublishedPhiloxVector) {
  const RandomStream stream(splitmix64_inverse(kEmptyHash), "");
  ASSERT_EQ(stream.key(), 0u);
  EXPECT_EQ(stream.uniform(0, 0), random_math::uniform53(0x6627e8d5, 0xe169c58d));
  EXPECT_EQ(stream.uniform(0, 1), random_math::uniform53(0xbc57ac4c, 0x9b00dbd8));
  const RandomStream pi(splitmix64_inverse(kKnownAnswers[2].key ^ kEmptyHash), "");
  // The index counts draws, two to a block, so the highest bit of the published counter is out of its reach; the batch
  // has it.
  std::array<double, kRandomTile> out{};
  const std::uint64_t block = 0x05a308d3243f6a88;
  uniform_tile(pi.key(), 0x13198a2e, block, 0x03707344, out.data());
  EXPECT_EQ(pi.uniform(0x13198a2e, 2 * block, 0x03707344), out[0]);
}

// Every number of every run depends on these; a change here changes all results. Checked once against an independent
// writing of the same definition in another language.
TEST(RandomStream, GoldenFirstDraws) {
  const RandomStream stream(42, "imu.gyro.thermal");
  EXPECT_EQ(stream.key(), 0x075BCD29536AB34Full);
  EXPECT_EQ(stream.uniform(0, 0), 0x1.168bc81427ceep-1);
  EXPECT_EQ(stream.uniform(2, 81), 0x1.a65ee5b3e1546p-1);
  EXPECT_EQ(stream.normal(0, 0), 0x1.1edc6e569661ap-4);
  EXPECT_EQ(stream.normal(0, 1), -0x1.19e659c2b1c7ep+0);
  EXPECT_EQ(stream.normal(2, 81), -0x1.27e8c6b37da5fp+0);
  EXPECT_EQ(stream.normal(2, 81, 3), -0x1.135bf1c33038bp-3);
}

TEST(RandomStream, BatchesEqualSingleDrawsToTheBit) {
  const RandomStream stream(7, "test.batch");
  const std::uint64_t starts[] = {0, 1, 2, 3, 31, 32, 33, (1ull << 33) - 41, (1ull << 33) - 40, (1ull << 63) - 9};
  for (const std::uint64_t start : starts) {
    for (std::size_t length = 0; length <= 101; ++length) {
      std::vector<double> normals(length), uniforms(length);
      stream.fill_normal(normals, 5, start, 2);
      stream.fill_uniform(uniforms, 5, start, 2);
      for (std::size_t i = 0; i < length; ++i) {
        ASSERT_EQ(normals[i], stream.normal(5, start + i, 2)) << start << " + " << i << " of " << length;
        ASSERT_EQ(uniforms[i], stream.uniform(5, start + i, 2)) << start << " + " << i << " of " << length;
      }
    }
  }
}

TEST(RandomStream, BatchesEqualSingleDrawsOverALongRun) {
  const RandomStream stream(8, "test.batch");
  std::vector<double> normals(200'001);
  stream.fill_normal(normals, 1, 77);
  for (std::size_t i = 0; i < normals.size(); ++i) ASSERT_EQ(normals[i], stream.normal(1, 77 + i)) << i;
}

TEST(RandomStream, BatchesWriteNothingOutside) {
  const RandomStream stream(9, "test.batch");
  for (std::size_t length = 0; length < 70; ++length) {
    for (const std::uint64_t start : {4u, 5u}) {
      std::vector<double> values(length + 2, -7.0);
      stream.fill_normal(std::span(values).subspan(1, length), 0, start);
      EXPECT_EQ(values.front(), -7.0);
      EXPECT_EQ(values.back(), -7.0);
    }
  }
}

TEST(RandomStream, DrawsDependOnNothingElse) {
  const RandomStream a(7, "gnss.code_noise");
  const RandomStream b(7, "gnss.code_noise");
  (void)b.normal(3, 99);
  EXPECT_EQ(a.normal(1, 5), b.normal(1, 5));
  EXPECT_EQ(a.uniform(2.0, 4.0, 1, 5), 2.0 + 2.0 * b.uniform(1, 5));
  const Eigen::Vector3d v = a.normal3(12, 1);
  EXPECT_EQ(v, Eigen::Vector3d(a.normal(0, 12, 1), a.normal(1, 12, 1), a.normal(2, 12, 1)));
}

TEST(RandomStream, DirectionsAreUnitVectors) {
  const RandomStream stream(7, "test.direction");
  for (std::uint64_t i = 0; i < 10'000; ++i)
    EXPECT_NEAR(stream.direction(0, i).norm(), 1.0, 4 * std::numeric_limits<double>::epsilon());
}

}  // namespace
}  // namespace canyon
