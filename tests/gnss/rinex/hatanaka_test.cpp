#include "canyon/gnss/rinex/observation/hatanaka.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/random/random.h"
#include "canyon/tests/gnss/rinex/hatanaka_compress.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using ::testing::ElementsAre;

std::string field(const std::string& text, const std::string& label) {
  std::string line = text;
  line.resize(60, ' ');
  return line + label + "\n";
}

std::string two_lines(bool modern) {
  return field(modern ? "3.0                 COMPACT RINEX FORMAT" : "1.0                 COMPACT RINEX FORMAT",
               "CRINEX VERS   / TYPE") +
         field("a test", "CRINEX PROG / DATE");
}

/// A RINEX file of random walks with gaps, flags, clock offsets, satellites that come and go, and an event.
std::string synthetic(bool modern, std::uint64_t seed) {
  const RandomStream random(seed, "test.hatanaka");
  std::string out =
      field(modern ? "     3.04           OBSERVATION DATA    M" : "     2.11           OBSERVATION DATA    M",
            "RINEX VERSION / TYPE");
  const std::size_t types = 7;
  if (modern) {
    out += field("G    7 C1C L1C D1C S1C C2W L2W S2W", "SYS / # / OBS TYPES");
    out += field("R    7 C1C L1C D1C S1C C2C L2C S2C", "SYS / # / OBS TYPES");
  } else {
    out += field("     7    C1    L1    D1    S1    P2    L2    S2", "# / TYPES OF OBSERV");
  }
  out += field("", "END OF HEADER");
  char text[128];
  for (std::uint64_t k = 0; k < 60; ++k) {
    const int minute = static_cast<int>(k) / 2, second = k % 2 == 0 ? 0 : 30;
    std::vector<std::string> names;
    for (std::uint32_t prn = 1; prn <= 26; ++prn)
      if (random.uniform(prn, k / 7) < 0.7) {
        std::snprintf(text, sizeof text, "%c%02u", prn % 3 == 0 ? 'R' : 'G', prn);
        names.emplace_back(text);
      }
    const std::string clock =
        k > 20 && k < 40 ? "0." + std::to_string(100000000 + 7 * k * k) + (modern ? "000" : "") : std::string();
    if (k == 30) {
      out += modern ? ">                              4  1\n" : "                            4  1\n";
      out += field("something happened", "COMMENT");
    }
    if (modern) {
      std::snprintf(text, sizeof text, "> 2020 06 25 00 %02d %10.7f  0%3zu", minute, second + 0.0, names.size());
      std::string line = text;
      if (!clock.empty()) line += "      " + std::string(15 - clock.size(), ' ') + clock;
      out += line + "\n";
    } else {
      std::snprintf(text, sizeof text, " 20  6 25  0 %2d %10.7f  0%3zu", minute, second + 0.0, names.size());
      std::string line = text;
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0 && i % 12 == 0) {
          if (i == 12 && !clock.empty()) line += std::string(12 - clock.size(), ' ') + clock;
          out += line + "\n";
          line = std::string(32, ' ');
        }
        line += names[i];
      }
      if (names.size() <= 12 && !clock.empty()) {
        line.resize(68, ' ');
        line += std::string(12 - clock.size(), ' ') + clock;
      }
      out += line + "\n";
    }
    for (const auto& name : names) {
      const auto prn = static_cast<std::uint32_t>(std::stoul(name.substr(1)));
      std::string line = modern ? name : "";
      for (std::uint32_t c = 0; c < types; ++c) {
        if (!modern && c == 5) {
          while (!line.empty() && line.back() == ' ') line.pop_back();
          out += line + "\n";
          line.clear();
        }
        const std::uint32_t entity = prn * 16 + c;
        if (random.uniform(entity, k, 1) < 0.1) {
          line += std::string(16, ' ');
          continue;
        }
        // Of either sign, small and large: also 0.004, -0.004 and numbers of nine digits.
        const double scale = c == 0 ? 2e7 : c == 1 ? 1.5e8 : c == 2 ? 0.01 : 4e3;
        std::snprintf(
            text, sizeof text, "%14.3f",
            scale * (random.normal(entity, 0) + 1e-3 * static_cast<double>(k) + 1e-4 * random.normal(entity, k)));
        if (std::string(text) == "        -0.000") std::snprintf(text, sizeof text, "%14.3f", 0.0);
        line += text;
        line += random.uniform(entity, k, 2) < 0.2 ? '1' : ' ';
        line += random.uniform(entity, k, 3) < 0.8 ? '7' : ' ';
      }
      while (!line.empty() && line.back() == ' ') line.pop_back();
      out += line + "\n";
    }
  }
  return out;
}

TEST(Hatanaka, RoundTripIsExactToTheCharacter) {
  for (const bool modern : {false, true}) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      const std::string plain = synthetic(modern, seed);
      const std::string packed = HatanakaCompressor(modern).compress(plain, two_lines(modern));
      ASSERT_TRUE(is_hatanaka(packed));
      EXPECT_LT(packed.size(), plain.size());
      const auto back = undo_hatanaka(packed, "t.crx");
      ASSERT_TRUE(back.ok()) << back.error().str();
      EXPECT_THAT(back->warnings, ElementsAre());
      const auto at = std::mismatch(plain.begin(), plain.end(), back->text.begin(), back->text.end());
      EXPECT_TRUE(back->text == plain) << "differs first: \""
                                       << std::string(at.first, std::min(plain.end(), at.first + 90)) << "\" and \""
                                       << std::string(at.second, std::min(back->text.end(), at.second + 90));
      EXPECT_EQ(back->source_line.size(), static_cast<std::size_t>(std::count(plain.begin(), plain.end(), '\n')));
    }
  }
  EXPECT_FALSE(is_hatanaka(synthetic(true, 1)));
}

/// What was decoded from a real file, compressed again, must give that file's own characters.
void expect_recompression(const std::string& path) {
  const auto packed = read_text_or_gzip_file(path);
  ASSERT_TRUE(packed.ok());
  const auto plain = undo_hatanaka(*packed, path);
  ASSERT_TRUE(plain.ok()) << plain.error().str();
  EXPECT_THAT(plain->warnings, ElementsAre());
  const std::size_t header = packed->find('\n', packed->find('\n') + 1) + 1;
  const std::string again = HatanakaCompressor(true).compress(plain->text, packed->substr(0, header));
  const auto at = std::mismatch(packed->begin(), packed->end(), again.begin(), again.end());
  EXPECT_TRUE(again == *packed) << "differs first in line " << std::count(packed->begin(), at.first, '\n') + 1 << ": \""
                                << std::string(at.first, std::min(packed->end(), at.first + 60)) << "\" and \""
                                << std::string(at.second, std::min(again.cend(), at.second + 60)) << "\"";
}

TEST(Hatanaka, RealDayOfAllSystemsRecompressesToItself) {
  CANYON_REAL_DATA(path, "gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz");
  expect_recompression(path);
}

TEST(Hatanaka, RealRinex4HourRecompressesToItself) {
  CANYON_REAL_DATA(path, "gnss/rinex4/KMS300DNK_R_20221591000_01H_30S_MO.crx");
  expect_recompression(path);
}

// Three bytes an epoch that stand for a line of sixteen thousand: an error, not all of the memory.
TEST(Hatanaka, AFileThatFillsMemoryIsAnError) {
  std::string text = two_lines(true) + field("     3.04           OBSERVATION DATA    G", "RINEX VERSION / TYPE") +
                     field("G  999 C1C", "SYS / # / OBS TYPES") + field("", "END OF HEADER") +
                     "> 2020 06 25 00 00 00.0000000  0  1      G01\n\n" + std::string(999 + 1997, ' ') + "1\n";
  for (int k = 0; k < 20000; ++k) text += "\n\n\n";
  const auto out = undo_hatanaka(text, "a.crx");
  ASSERT_FALSE(out.ok());
  EXPECT_EQ(out.error().what, "the file unpacks to more than 64 times its size");
  EXPECT_GT(out.error().line, 7);
}

}  // namespace
}  // namespace canyon::gnss
