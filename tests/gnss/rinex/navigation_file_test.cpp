#include "canyon/gnss/rinex/navigation/navigation_file.h"

#include <zlib.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/random/random.h"
#include "canyon/gnss/rinex/text_lines.h"
#include "canyon/tests/gnss/rinex/nav_text.h"
#include "canyon/tests/support/temporary_folder.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::header;
using testing::header_line;
using testing::navigation_text;
using testing::record;
using testing::sample_ephemeris;

const GpsTime kFileStart = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);

std::string error_of(const std::string& text) {
  const auto file = parse_navigation_file(text, "brdc.10n");
  return file.ok() ? "no error" : file.error().str();
}

std::string without_line(const std::string& text, int number) {
  std::string out;
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = text.find('\n', begin) + 1;
    if (line != number) out += text.substr(begin, end - begin);
    begin = end;
  }
  return out;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(FortranNumber, Forms) {
  EXPECT_EQ(fortran_number("0.4657D-08"), 0.4657e-8);
  EXPECT_EQ(fortran_number("-.136290676892d-03"), -.136290676892e-3);
  EXPECT_EQ(fortran_number("+1.5E+3"), 1500.0);
  EXPECT_EQ(fortran_number("12"), 12.0);
  for (const char* bad : {"", "1.5D", "1.5 D3", "1,5", "nan", "inf", "0x10", "1e999", "--1", "1.0D+03x"})
    EXPECT_FALSE(fortran_number(bad).has_value()) << bad;
}

// What is written with 13 significant digits is read back to half a unit of the last.
TEST(NavigationFile, BothVersionsGiveEveryFieldBack) {
  for (const bool version3 : {false, true}) {
    const auto file = parse_navigation_file(navigation_text(kFileStart, 3, 2, version3), "brdc.10n");
    ASSERT_TRUE(file.ok()) << file.error().str();
    EXPECT_EQ(file->files.front().version, version3 ? 3.04 : 2.11);
    EXPECT_EQ(file->leap_seconds, 15);
    const auto klobuchar = file->klobuchar_at(GnssSystem::kGps, kFileStart);
    ASSERT_TRUE(klobuchar.has_value());
    EXPECT_THAT(klobuchar->alpha, ElementsAre(0.4657e-8, 0.1490e-7, -0.5960e-7, -0.1192e-6));
    EXPECT_THAT(klobuchar->beta, ElementsAre(0.8192e5, 0.8192e5, -0.6554e5, -0.5243e6));
    EXPECT_TRUE(file->warnings.empty());
    ASSERT_EQ(file->kepler.size(), 6u);
    const KeplerEphemeris want = sample_ephemeris(2, kFileStart + 7200.0);
    const KeplerEphemeris& got = file->kepler[4];
    EXPECT_EQ(got.sv, want.sv);
    EXPECT_EQ(got.toe, want.toe);
    EXPECT_EQ(got.toc, want.toc);
    EXPECT_EQ(got.health, 0);
    EXPECT_EQ(got.iode, 63);
    EXPECT_EQ(got.valid_before_s, 7200.0);
    EXPECT_EQ(got.valid_after_s, 7200.0);
    const auto near = [](double a, double b) { EXPECT_NEAR(a, b, 0.5e-12 * std::abs(b)); };
    near(got.af0_s, want.af0_s), near(got.af1, want.af1), near(got.af2_per_s, want.af2_per_s),
        near(got.tgd_s, want.tgd_s);
    near(got.sqrt_a, want.sqrt_a), near(got.e, want.e), near(got.i0_rad, want.i0_rad),
        near(got.idot_rad_s, want.idot_rad_s);
    near(got.omega0_rad, want.omega0_rad), near(got.omega_dot_rad_s, want.omega_dot_rad_s);
    near(got.argument_of_perigee_rad, want.argument_of_perigee_rad), near(got.m0_rad, want.m0_rad);
    near(got.delta_n_rad_s, want.delta_n_rad_s), near(got.cuc_rad, want.cuc_rad), near(got.cus_rad, want.cus_rad);
    near(got.crc_m, want.crc_m), near(got.crs_m, want.crs_m), near(got.cic_rad, want.cic_rad),
        near(got.cis_rad, want.cis_rad);
  }
}

TEST(NavigationFile, WindowsLineEndsAndMissingLastNewline) {
  std::string text = navigation_text(kFileStart, 2, 1, false), dos;
  for (const char c : text) dos += c == '\n' ? "\r\n" : std::string(1, c);
  dos.resize(dos.size() - 2);
  const auto file = parse_navigation_file(dos, "brdc.10n");
  ASSERT_TRUE(file.ok()) << file.error().str();
  EXPECT_EQ(file->kepler.size(), 2u);
  EXPECT_TRUE(file->warnings.empty());
}

TEST(NavigationFile, OtherKindsOfAMixedFileAreCounted) {
  std::string text = replaced(navigation_text(kFileStart, 2, 1, true), "G: GPS", "M: MIX");
  for (const char* who : {"S23", "I02", "S24"})
    text += std::string(who) +
            " 2010 07 01 00 15 00-1.0D-04 0.0D+00 0.0D+00\n     1.0D+04 0.0D+00 0.0D+00 0.0D+00\n     1.0D+04\n     "
            "1.0D+04\n";
  text += record(sample_ephemeris(9, kFileStart), true);
  const auto file = parse_navigation_file(text, "brdc.10p");
  ASSERT_TRUE(file.ok()) << file.error().str();
  EXPECT_EQ(file->kepler.size(), 3u);
  EXPECT_EQ(file->skipped_records, (std::map<std::string, int>{{"EPH S", 2}, {"EPH I", 1}}));
  EXPECT_TRUE(file->warnings.empty());
}

TEST(NavigationFile, GzipIsUnpacked) {
  const std::string text = navigation_text(kFileStart, 4, 1, false),
                    path = canyon::testing::temporary_file("test.10n.gz");
  gzFile out = gzopen(path.c_str(), "wb");
  ASSERT_NE(out, nullptr);
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  const auto file = read_navigation_file(path);
  ASSERT_TRUE(file.ok()) << file.error().str();
  EXPECT_EQ(file->kepler.size(), 4u);
}

TEST(NavigationFile, ErrorsWordForWord) {
  EXPECT_EQ(error_of(""), "brdc.10n:1: the file is empty, expected a RINEX 2, 3 or 4 navigation file");
  EXPECT_EQ(error_of("hello\n"),
            "brdc.10n:1: not a RINEX file: the first line has no version and \"RINEX VERSION / TYPE\", expected a "
            "RINEX 2, 3 or 4 navigation "
            "file");
  EXPECT_EQ(error_of(header_line("     5.00           N: GNSS NAV DATA    M", "RINEX VERSION / TYPE")),
            "brdc.10n:1: RINEX version 5.00 is not supported, expected 2.x, 3.x or 4.x");
  EXPECT_EQ(error_of(header_line("     2.11           OBSERVATION DATA    M", "RINEX VERSION / TYPE")),
            "brdc.10n:1: RINEX file type \"O\", expected \"N\", navigation data, or \"G\", GLONASS navigation data of "
            "RINEX 2");
  const std::string no_end = without_line(header(false), 5);
  EXPECT_EQ(error_of(no_end), "brdc.10n:4: the file ends inside its header, expected a line \"END OF HEADER\"");
}

TEST(NavigationFile, HeaderErrorsWordForWord) {
  EXPECT_EQ(error_of(replaced(header(false), "    15", "    1x")),
            "brdc.10n:4: LEAP SECONDS: cannot be read, expected a whole number");
}

// The ephemerides are good without the ionosphere's coefficients: whoever needs those will say so.
TEST(NavigationFile, IonosphereThatCannotBeReadIsAWarning) {
  const auto warnings_of = [](const std::string& head) {
    const auto file = parse_navigation_file(head + record(sample_ephemeris(1, kFileStart), head[5] == '3'), "brdc.10n");
    EXPECT_TRUE(file.ok()) << file.error().str();
    EXPECT_TRUE(file->klobuchar.empty());
    return file->warnings;
  };
  EXPECT_THAT(warnings_of(replaced(header(false), "4.6570D-09", "4.6570X-09")),
              ElementsAre("brdc.10n:2: GPSA: cannot be read, expected four numbers up to 1e-4; skipped"));
  EXPECT_THAT(warnings_of(replaced(header(true), "8.1920D+04", "8.1920D+  ")),
              ElementsAre("brdc.10n:3: GPSB: cannot be read, expected four numbers up to 1e8; skipped"));
  EXPECT_THAT(warnings_of(replaced(header(true), "8.1920D+04", "          ")),
              ElementsAre("brdc.10n:3: GPSB: cannot be read, expected four numbers up to 1e8; skipped"));
  EXPECT_THAT(warnings_of(replaced(header(true), "8.1920D+04", "8.192D+300")),
              ElementsAre("brdc.10n:3: GPSB: cannot be read, expected four numbers up to 1e8; skipped"));
  // Galileo's fourth field is blank in many files.
  const std::string galileo = header_line("GAL    4.5750D+01  1.2891D-01  1.4053D-02", "IONOSPHERIC CORR");
  const std::string head = header(true);
  const auto file = parse_navigation_file(
      head.substr(0, 81) + galileo + head.substr(81) + record(sample_ephemeris(1, kFileStart), true), "brdc.10n");
  ASSERT_TRUE(file.ok()) << file.error().str();
  EXPECT_THAT(file->warnings, ElementsAre());
  EXPECT_EQ(file->klobuchar.size(), 1u);
}

TEST(NavigationFile, NoUsableRecordIsAnError) {
  EXPECT_EQ(error_of(header(false)),
            "brdc.10n:5: no usable ephemeris, expected broadcast ephemerides of GPS, GLONASS, Galileo, BeiDou or QZSS");
  const std::string damaged = replaced(header(false) + record(sample_ephemeris(1, kFileStart), false),
                                       " 2.500000000000D-03", " 2.5              ");
  EXPECT_EQ(error_of(replaced(damaged, " 2.5              ", " 1.500000000000D+00")),
            "brdc.10n:13: no usable ephemeris (1 damaged, the first: brdc.10n:8: G01: e = 1.5, expected at least 0 "
            "and less than 1; "
            "skipped), expected broadcast ephemerides of GPS, GLONASS, Galileo, BeiDou or QZSS");
}

TEST(NavigationFile, DamagedRecordsAreSkippedWithTheirLine) {
  const std::string good = record(sample_ephemeris(2, kFileStart), false), head = header(false);
  const auto warnings_of = [&](const std::string& bad) {
    const auto file = parse_navigation_file(head + bad + good, "brdc.10n");
    EXPECT_TRUE(file.ok());
    EXPECT_EQ(file->kepler.size(), 1u);
    return file->warnings;
  };
  const std::string one = record(sample_ephemeris(1, kFileStart), false);
  EXPECT_THAT(warnings_of(without_line(one, 4)),
              ElementsAre("brdc.10n:6: G01: the record has 7 lines, expected 8; skipped"));
  EXPECT_THAT(warnings_of(replaced(one, "5.153610000000D+03", "5.1536l0000000D+03")),
              ElementsAre("brdc.10n:8: G01: sqrt(A) = \"5.1536l0000000D+03\", expected a number; skipped"));
  EXPECT_THAT(warnings_of(replaced(one, "5.153610000000D+03", "                  ")),
              ElementsAre("brdc.10n:8: G01: sqrt(A) is missing; skipped"));
  EXPECT_THAT(warnings_of(replaced(one, "5.153610000000D+03", "5.153610000000D+06")),
              ElementsAre("brdc.10n:8: G01: sqrt(A) = 5153610, expected 1000 to 10000 m^0.5 (GPS: 5154); skipped"));
  EXPECT_THAT(
      warnings_of(replaced(one, " 1 10  7  1  0  0  0.0", " 1 10 17  1  0  0  0.0")),
      ElementsAre("brdc.10n:6: G01: its epoch cannot be read, expected year month day hour minute second; skipped"));
  EXPECT_THAT(warnings_of(replaced(one, " 1 10  7  1", "99 10  7  1")),
              ElementsAre("brdc.10n:6: satellite number \"99\", expected G01 to G63; skipped"));
  EXPECT_THAT(warnings_of("   garbage before the first record\n"),
              ElementsAre("brdc.10n:6: a line that belongs to no record, expected a satellite number first; skipped"));
}

TEST(NavigationFile, TruncatedLastRecordIsAWarning) {
  std::string text = navigation_text(kFileStart, 2, 1, false);
  text.resize(text.size() - 200);
  const auto file = parse_navigation_file(text, "brdc.10n");
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->kepler.size(), 1u);
  EXPECT_THAT(file->warnings, ElementsAre("brdc.10n:14: G02: the record has 6 lines, expected 8; skipped"));
}

TEST(NavigationFile, ManyWarningsAreSummedUp) {
  std::string text = navigation_text(kFileStart, 1, 1, false);
  for (int k = 0; k < 25; ++k) text += "99 garbage\n";
  const auto file = parse_navigation_file(text, "brdc.10n");
  ASSERT_TRUE(file.ok());
  ASSERT_EQ(file->warnings.size(), 21u);
  EXPECT_EQ(file->warnings.back(), "brdc.10n: 5 more damaged records were skipped");
}

// Random bytes, and a good file with random bytes written into it, must neither crash nor give an orbit that cannot be.
TEST(NavigationFile, SurvivesGarbage) {
  const RandomStream random(7, "test.garbage");
  const std::string good = navigation_text(kFileStart, 6, 2, false);
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    std::string text = trial % 3 == 0 ? header(trial % 2 == 0) : good;
    if (trial % 3 == 0)
      for (std::uint32_t i = 0; i < 2000; ++i) text += static_cast<char>(256.0 * random.uniform(i, trial));
    else
      for (std::uint32_t i = 0; i < 40; ++i)
        text[static_cast<std::size_t>(random.uniform(i, trial, 1) * static_cast<double>(text.size()))] =
            static_cast<char>(256.0 * random.uniform(i, trial, 2));
    if (trial % 5 == 0)
      text.resize(static_cast<std::size_t>(random.uniform(0, trial, 3) * static_cast<double>(text.size())));
    const auto file = parse_navigation_file(text, "garbage");
    if (!file.ok()) {
      EXPECT_GT(file.error().line, 0);
      continue;
    }
    for (const auto& r : file->kepler) EXPECT_TRUE(r.at(r.toe).p_E.allFinite());
  }
}

TEST(Coverage, NamesTheSpan) {
  const auto file = parse_navigation_file(navigation_text(kFileStart, 5, 2, false), "brdc.10n");
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(check_coverage(*file, "G", kFileStart, kFileStart + 3600.0, "gnss.nav_file").ok());
  const GpsTime other = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
  const auto wrong_day = check_coverage(*file, "G", other, other + 480.0, "gnss.nav_file");
  ASSERT_FALSE(wrong_day.ok());
  EXPECT_EQ(wrong_day.error().str(),
            "brdc.10n: gnss.nav_file: covers 2010-06-30T22:00:00 to 2010-07-01T04:00:00 GPS time, not the mission's "
            "2010-11-17T13:00:00 to "
            "2010-11-17T13:08:00, expected a navigation file of the mission's day, or a mission within it (time.start, "
            "time.limit_s)");
  const auto runs_over = check_coverage(*file, "G", kFileStart, kFileStart + 4 * 3600.0 + 1.0, "gnss.nav_file");
  EXPECT_FALSE(runs_over.ok());
}

TEST(Coverage, GapsAndUnhealthySatellites) {
  auto file = parse_navigation_file(navigation_text(kFileStart, 4, 1, false), "brdc.10n");
  ASSERT_TRUE(file.ok());
  // The fifth satellite comes six hours later, so that there is a gap in between.
  file->kepler.push_back(sample_ephemeris(5, kFileStart + 6 * 3600.0));
  const auto gap = check_coverage(*file, "G", kFileStart, kFileStart + 3 * 3600.0, "gnss.nav_file");
  ASSERT_FALSE(gap.ok());
  EXPECT_EQ(
      gap.error().str(),
      "brdc.10n: gnss.nav_file: only 0 satellites of G have a valid ephemeris at 2010-07-01T02:05:00 (the file covers "
      "2010-06-30T22:00:00 to 2010-07-01T08:00:00), expected at least 4");
  for (auto& r : file->kepler) r.health = 63;
  EXPECT_EQ(
      check_coverage(*file, "G", kFileStart, kFileStart, "gnss.nav_file").error().str(),
      "brdc.10n: gnss.nav_file: no satellite of G in it is healthy, expected a navigation file of the mission's day");
}

TEST(NavigationFile, RealFiles) {
  struct Case {
    const char* path;
    std::size_t at_least;
    double version;
    bool ionosphere;
    std::string warning;  ///< without folder
  };
  // The warnings are true: the orbits named are 20,000 km from the precise ones of the day.
  const Case cases[] = {{"gnss/orbit_2010_182/brdc1820.10n", 380, 2.0, true,
                         "brdc1820.10n:937: G01: the orbit of 2010-07-01T06:00:00 is 20859 km away from what the "
                         "records before and after "
                         "it say; skipped"},
                        {"gnss/usno_2005_020/brdc0200.05n", 300, 2.0, true, ""},
                        {"gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_MN.rnx.gz", 2000, 3.0, true, ""},
                        {"gnss/urban_berlin/BRDC00WRD_U_20161580000_01D_MN.rnx", 400, 3.0, false, ""},
                        {"gnss/rinex4/KMS300DNK_R_20221591000_01H_MN.rnx.gz", 175, 4.0, true, ""},
                        {"gnss/urban_berlin/brdc1580.16n", 300, 2.0, true,
                         "brdc1580.16n:793: G14: the orbit of 2016-06-06T04:30:08 is 21361 km away from what the "
                         "records before and after "
                         "it say; skipped"}};
  for (const Case& c : cases) {
    CANYON_REAL_DATA(path, c.path);
    const auto file = read_navigation_file(path);
    ASSERT_TRUE(file.ok()) << file.error().str();
    EXPECT_GE(file->kepler.size(), c.at_least) << c.path;
    EXPECT_EQ(std::floor(file->files.front().version), c.version);
    EXPECT_EQ(!file->klobuchar.empty(), c.ionosphere) << c.path;
    std::vector<std::string> warnings;
    for (const auto& w : file->warnings) warnings.push_back(w.substr(w.rfind('/') + 1));
    EXPECT_EQ(warnings, c.warning.empty() ? std::vector<std::string>{} : std::vector{c.warning}) << c.path;
  }
  CANYON_REAL_DATA(observations, "gnss/arl_2015_200/arlm200a.15o");
  const auto wrong = read_navigation_file(observations);
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().str(), HasSubstr("arlm200a.15o:1: RINEX file type \"O\", expected \"N\", navigation data"));
}

}  // namespace
}  // namespace canyon::gnss
