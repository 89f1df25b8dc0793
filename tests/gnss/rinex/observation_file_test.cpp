#include "canyon/gnss/rinex/observation/observation_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/tests/gnss/rinex/hatanaka_compress.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string field(std::string text, const char* label) {
  text.resize(60, ' ');
  return text + label + "\n";
}

std::string header3(const std::string& more = "", const char* version = "     3.04", const char* time_system = "GPS") {
  return field(std::string(version) + "           OBSERVATION DATA    M (MIXED)", "RINEX VERSION / TYPE") +
         field("HERE", "MARKER NAME") + field("  1112189.9031 -4842955.0319  3985352.2376", "APPROX POSITION XYZ") +
         field("        0.2160        0.0100       -0.0200", "ANTENNA: DELTA H/E/N") +
         field("G    4 C1C L1C D1C S1C", "SYS / # / OBS TYPES") + field("R    2 C1C L1C", "SYS / # / OBS TYPES") +
         field("I    1 C5A", "SYS / # / OBS TYPES") + more +
         field("  2020     6    25     0     0    0.0000000     " + std::string(time_system), "TIME OF FIRST OBS") +
         field("  2 R01  1 R02 -4", "GLONASS SLOT / FRQ #") + field("", "END OF HEADER");
}

const std::string kEpoch3 =
    "> 2020 06 25 00 00 30.0000000  0  3      -0.000123456789\n"
    "G05  20000000.1231  105100000.456 7     -1234.567          45.250\n"
    "R01  19000000.000                      \n"
    "I02  38000000.000\n";

TEST(ObservationFile, Rinex3) {
  const auto f = parse_observation_file(header3() + kEpoch3, "a.rnx");
  ASSERT_TRUE(f.ok()) << f.error().str();
  EXPECT_EQ(f->header.marker_name, "HERE");
  EXPECT_EQ(f->header.version, 3.04);
  EXPECT_EQ(*f->header.approx_position_E, Eigen::Vector3d(1112189.9031, -4842955.0319, 3985352.2376));
  EXPECT_THAT(f->header.glonass_channels, ElementsAre(std::pair(1, 1), std::pair(2, -4)));
  ASSERT_EQ(f->epochs.size(), 1u);
  const auto& e = f->epochs[0];
  EXPECT_EQ(e.t, GpsTime::from_calendar(2020, 6, 25, 0, 0, 30.0));
  EXPECT_EQ(e.clock_offset_s, -0.000123456789);
  ASSERT_EQ(e.satellites.size(), 2u);
  EXPECT_EQ(e.satellites[0].sv.str(), "G05");
  ASSERT_EQ(e.satellites[0].values.size(), 4u);
  EXPECT_EQ(e.satellites[0].values[0].value, 20000000.123);
  EXPECT_EQ(e.satellites[0].values[0].loss_of_lock, 1);
  EXPECT_EQ(e.satellites[0].values[1].value, 105100000.456);
  EXPECT_EQ(e.satellites[0].values[1].strength, 7);
  EXPECT_EQ(e.satellites[0].values[2].value, -1234.567);
  EXPECT_EQ(e.satellites[0].values[3].value, 45.25);
  EXPECT_EQ(e.satellites[1].values.size(), 1u);  // L1C is missing
  EXPECT_EQ(f->codes(e, GnssSystem::kGlonass)[1].str(), "L1C");
  EXPECT_EQ(f->other_system_satellites, 1);
  EXPECT_THAT(f->warnings, ElementsAre());
}

TEST(ObservationFile, Rinex2WithContinuedSatelliteListAndClock) {
  std::string text = field("     2.11           OBSERVATION DATA    M (MIXED)", "RINEX VERSION / TYPE") +
                     field("     6    C1    L1    P1    P2    L2    S2", "# / TYPES OF OBSERV") +
                     field("", "END OF HEADER");
  text +=
      " 05  1 20  0  0 30.0000000  0 13G01G02G03G04G05G06G07G08G09G10G11 12 0.000001000\n"
      "                                R24\n";
  for (int i = 0; i < 13; ++i)
    text += "  20000000.1004  105000000.20049  20000000.300    20000005.400    81000000.500  \n        33.000\n";
  const auto f = parse_observation_file(text, "a.05o");
  ASSERT_TRUE(f.ok()) << f.error().str();
  ASSERT_EQ(f->epochs.size(), 1u);
  const auto& e = f->epochs[0];
  ASSERT_EQ(e.satellites.size(), 13u);
  EXPECT_THAT(f->warnings, ElementsAre());
  EXPECT_EQ(e.clock_offset_s, 1e-6);
  EXPECT_EQ(e.satellites[11].sv.str(), "G12");  // a blank system is GPS
  EXPECT_EQ(e.satellites[12].sv.str(), "R24");
  EXPECT_EQ(e.satellites[12].values[5].value, 33.0);
  EXPECT_EQ(e.satellites[0].values[1].loss_of_lock, 4);
  EXPECT_EQ(e.satellites[0].values[1].strength, 9);
  std::string names;
  for (const auto& c : f->codes(e, GnssSystem::kGps)) names += c.str() + " ";
  EXPECT_EQ(names, "C1C L1C C1W C2W L2W S2W ");
  names.clear();
  for (const auto& c : f->codes(e, GnssSystem::kGlonass)) names += c.str() + " ";
  EXPECT_EQ(names, "C1C L1C C1P C2P L2C S2C ");
}

// GLONASS time is UTC, BeiDou time 14 s behind GPS; through the leap second at the end of 2016 (17 to 18 s).
TEST(ObservationFile, TimeSystems) {
  const auto first = [](const char* system, const char* epoch) {
    const auto f = parse_observation_file(
        header3("", "     3.04", system) + "> " + epoch + "  0  1\nG05  20000000.123\n", "a.rnx");
    EXPECT_TRUE(f.ok());
    return f->epochs.at(0).t;
  };
  const char* noon = "2020 06 25 12 00 00.0000000";
  EXPECT_EQ(first("GPS", noon), GpsTime::from_calendar(2020, 6, 25, 12, 0, 0));
  EXPECT_EQ(first("GAL", noon), GpsTime::from_calendar(2020, 6, 25, 12, 0, 0));
  EXPECT_EQ(first("BDT", noon), GpsTime::from_calendar(2020, 6, 25, 12, 0, 14));
  EXPECT_EQ(first("GLO", noon), GpsTime::from_calendar(2020, 6, 25, 12, 0, 18));
  EXPECT_EQ(first("GLO", "2016 12 31 23 59 59.0000000"), GpsTime::from_calendar(2017, 1, 1, 0, 0, 16));
  EXPECT_EQ(first("GLO", "2016 12 31 23 59 60.0000000"), GpsTime::from_calendar(2017, 1, 1, 0, 0, 17));
  EXPECT_EQ(first("GLO", "2017 01 01 00 00 00.0000000"), GpsTime::from_calendar(2017, 1, 1, 0, 0, 18));
}

TEST(ObservationFile, EventsCommentsAndNewCodesInside) {
  const std::string text = header3() + field("spliced here", "COMMENT") + kEpoch3 +
                           ">                              4  2\n" + field("a note", "COMMENT") +
                           field("G    2 S1C C1C", "SYS / # / OBS TYPES") +
                           "> 2020 06 25 00 00 45.0000000  5  0\n"
                           "> 2020 06 25 00 01  0.0000000  1  1\n" +
                           field("inside an epoch", "COMMENT") +
                           "G07        41.000    21000000.000\n"
                           "> 2020 06 25 00 01 30.0000000  6  1\n"
                           "G07         0.000           5.000\n"
                           ">                              3  1\n" +
                           field("THERE", "MARKER NAME");
  const auto f = parse_observation_file(text, "a.rnx");
  ASSERT_TRUE(f.ok()) << f.error().str();
  EXPECT_THAT(f->warnings, ElementsAre());
  ASSERT_EQ(f->epochs.size(), 2u);  // the cycle slips are none
  const auto& e = f->epochs[1];
  EXPECT_TRUE(e.after_power_failure);
  EXPECT_EQ(f->code_sets.size(), 2u);
  EXPECT_EQ(f->codes(f->epochs[0], GnssSystem::kGps)[0].str(), "C1C");
  EXPECT_EQ(f->codes(e, GnssSystem::kGps)[0].str(), "S1C");
  EXPECT_EQ(e.satellites.at(0).values.at(1).value, 21000000.0);
  ASSERT_EQ(f->events.size(), 3u);
  EXPECT_EQ(f->events[0].kind, ObservationEvent::Kind::kHeader);
  EXPECT_FALSE(f->events[0].t.has_value());
  EXPECT_EQ(f->events[1].kind, ObservationEvent::Kind::kExternal);
  EXPECT_EQ(*f->events[1].t, GpsTime::from_calendar(2020, 6, 25, 0, 0, 45.0));
  EXPECT_EQ(f->events[2].kind, ObservationEvent::Kind::kNewSite);
  EXPECT_EQ(f->header.marker_name, "THERE");
}

TEST(ObservationFile, ScaleFactorsAndZeros) {
  const auto f = parse_observation_file(header3(field("G  100   2 L1C D1C", "SYS / SCALE FACTOR")) +
                                            "> 2020 06 25 00 00 30.0000000  0  1\n"
                                            "G05  20000000.123   105100000.456           0.000            .500\n",
                                        "a.rnx");
  ASSERT_TRUE(f.ok()) << f.error().str();
  const auto& v = f->epochs.at(0).satellites.at(0).values;
  EXPECT_EQ(v[0].value, 20000000.123);
  EXPECT_EQ(v[1].value, 105100000.456 / 100.0);
  EXPECT_TRUE(v[2].missing());
  EXPECT_EQ(v[3].value, 0.5);
}

TEST(ObservationFile, ErrorsWordForWord) {
  const auto error = [](const std::string& text) {
    const auto f = parse_observation_file(text, "a.rnx");
    return f.ok() ? std::string("none") : f.error().str();
  };
  EXPECT_EQ(error(""), "a.rnx:1: the file is empty, expected a RINEX 2, 3 or 4 observation file");
  EXPECT_EQ(
      error("\x7f"
            "ELF\x01\x02"),
      "a.rnx:1: not a RINEX file: the first line has no version and \"RINEX VERSION / TYPE\", expected a RINEX 2, 3 "
      "or 4 observation file");
  EXPECT_EQ(error(field("     5.00           OBSERVATION DATA    M", "RINEX VERSION / TYPE")),
            "a.rnx:1: RINEX version 5.00 is not supported, expected 2.x, 3.x or 4.x");
  EXPECT_EQ(error(field("     3.04           NAVIGATION DATA     M", "RINEX VERSION / TYPE")),
            "a.rnx:1: RINEX file type \"N\", expected \"O\", observation data");
  EXPECT_EQ(error(header3().substr(0, 200)),
            "a.rnx:3: the file ends inside its header, expected a line \"END OF HEADER\"");
  EXPECT_EQ(error(header3()), "a.rnx:10: no epoch of observations, expected observations after the header");
  EXPECT_EQ(error(header3(field("E    3 C1C", "SYS / # / OBS TYPES")) + kEpoch3),
            "a.rnx:11: SYS / # / OBS TYPES: 1 codes of E listed, expected 3 as announced");
  EXPECT_EQ(error(header3("", "     3.04", "XYZ")),
            "a.rnx:8: TIME OF FIRST OBS: time system \"XYZ\", expected GPS, GLO, GAL, QZS or BDT");
  EXPECT_EQ(error(field("2.0                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE")),
            "a.rnx:1: Compact RINEX version \"2.0\" is not supported, expected 1.0 or 3.x");
}

TEST(ObservationFile, DamageIsCountedWordForWord) {
  const std::string text = header3() + kEpoch3 +
                           "> 2020 06 25 00 01 00.0000000  0  2\n"
                           "G05  20000x00.123   105100000.456\n"
                           "G06  20000000.123   1051000\n"
                           "> 2020 13 25 00 01 30.0000000  0  1\n"
                           "G05  20000000.123\n"
                           "> 2020 06 25 00 00 30.0000000  0  1\n"
                           "G05  20000000.123\n"
                           "> 2020 06 25 00 02 00.0000000  0  2\n"
                           "G05  20000000.123\n";
  const auto f = parse_observation_file(text, "a.rnx");
  ASSERT_TRUE(f.ok()) << f.error().str();
  EXPECT_THAT(
      f->warnings,
      ElementsAre("a.rnx:16: G05: \"  20000x00.123\", expected a number as F14.3; skipped",
                  "a.rnx:17: G06: \" 1051000\", expected a number as F14.3; skipped",
                  "a.rnx:18: not an epoch line: \"> 2020 13 25 00 01 30.0000000  0  1\", expected an epoch; skipped",
                  "a.rnx:22: the epoch has 1 satellites, expected 2 as announced; skipped",
                  "a.rnx:20: epoch 2020-06-25T00:00:30.000 does not follow 2020-06-25T00:01:00.000; skipped"));
  EXPECT_EQ(f->damaged, 5);
  ASSERT_EQ(f->epochs.size(), 3u);
  EXPECT_TRUE(f->epochs[1].satellites[0].values[0].missing());
  EXPECT_EQ(f->epochs[1].satellites[0].values[1].value, 105100000.456);
  EXPECT_EQ(f->epochs[1].satellites[1].values.size(), 1u);
}

/// Epochs every 30 s with one satellite; `minute` of each.
std::string epochs_at(const std::vector<double>& minutes) {
  std::string out;
  for (const double m : minutes) {
    const CalendarTime c = calendar(GpsTime::from_calendar(2020, 6, 25, 0, 0, 0) + 60.0 * m);
    char line[64];
    std::snprintf(line, sizeof line, "> %04d %02d %02d %02d %02d%11.7f  0  1\n", c.year, c.month, c.day, c.hour,
                  c.minute, c.second);
    out += line + std::string("G05  20000000.123\n");
  }
  return out;
}

std::vector<double> minutes_of(const ObservationFile& f) {
  std::vector<double> out;
  for (const auto& e : f.epochs) out.push_back((e.t - GpsTime::from_calendar(2020, 6, 25, 0, 0, 0)) / 60.0);
  return out;
}

// One time tag in the future costs that epoch, not all that follow; one in the past, or a piece that stands in the file
// twice, costs no more.
TEST(ObservationFile, AWrongTimeTagCostsOneEpoch) {
  const auto read = [](const std::vector<double>& minutes) {
    return *parse_observation_file(header3() + epochs_at(minutes), "a.rnx");
  };
  const auto future = read({0, 1, 700, 3, 4, 5});
  EXPECT_THAT(minutes_of(future), ElementsAre(0, 1, 3, 4, 5));
  EXPECT_THAT(future.warnings,
              ElementsAre("a.rnx:15: epoch 2020-06-25T11:40:00.000 lies after those that follow it; skipped"));
  EXPECT_THAT(minutes_of(read({700, 1, 2, 3})), ElementsAre(1, 2, 3));
  EXPECT_THAT(minutes_of(read({0, 700, 701, 3, 4, 5})), ElementsAre(0, 3, 4, 5));
  EXPECT_THAT(minutes_of(read({0, 10, 1, 11, 12})), ElementsAre(0, 10, 11, 12));
  EXPECT_THAT(minutes_of(read({0, 1, 2, 3, 0, 1, 2, 3, 4})), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(minutes_of(read({0, 1, 2, 2, 3})), ElementsAre(0, 1, 2, 3));
  const auto last = read({0, 1, 2, 1});
  EXPECT_THAT(minutes_of(last), ElementsAre(0, 1, 2));
  EXPECT_THAT(last.warnings, ElementsAre("a.rnx:17: epoch 2020-06-25T00:01:00.000 does not follow "
                                         "2020-06-25T00:02:00.000; skipped"));
}

// 31 February is no day, though the calendar's arithmetic would make it 2 March.
TEST(ObservationFile, ImpossibleDates) {
  const auto f = *parse_observation_file(
      header3() + kEpoch3 + "> 2021 02 31 00 00 30.0000000  0  1\nG05  20000000.123\n", "a.rnx");
  EXPECT_EQ(f.epochs.size(), 1u);
  EXPECT_THAT(f.warnings,
              ElementsAre("a.rnx:15: not an epoch line: \"> 2021 02 31 00 00 30.0000000  0  1\", expected an "
                          "epoch; skipped"));
}

TEST(ObservationFile, ASatelliteThatStandsTwiceCountsOnce) {
  const auto f = *parse_observation_file(header3() +
                                             "> 2020 06 25 00 00 30.0000000  0  3\n"
                                             "G05  20000000.123\nG07  21000000.123\nG05  22000000.123\n",
                                         "a.rnx");
  ASSERT_EQ(f.epochs[0].satellites.size(), 2u);
  EXPECT_EQ(f.epochs[0].satellites[0].values[0].value, 20000000.123);
  EXPECT_THAT(f.warnings, ElementsAre("a.rnx:14: G05 stands twice in its epoch; skipped"));
  EXPECT_EQ(f.damaged, 1);
}

// A header that announces many codes does not make short lines long.
TEST(ObservationFile, ShortLinesTakeLittleMemory) {
  std::string more = field("E   52 C1C L1C D1C S1C C5Q L5Q D5Q S5Q C7Q L7Q D7Q S7Q C8Q", "SYS / # / OBS TYPES");
  for (int k = 0; k < 3; ++k)
    more += field("       L8Q D8Q S8Q C6C L6C D6C S6C C1X L1X D1X S1X C5X L5X", "SYS / # / OBS TYPES");
  const auto f =
      *parse_observation_file(header3(more) + "> 2020 06 25 00 00 30.0000000  0999\nE01\nE02  20000000.123\n", "a.rnx");
  EXPECT_EQ(f.epochs[0].satellites[0].values.capacity(), 0u);
  EXPECT_EQ(f.epochs[0].satellites[1].values.capacity(), 1u);
  EXPECT_LT(f.epochs[0].satellites.capacity(), 10u);
}

// A file may end anywhere; what was cut off is never taken for a number.
TEST(ObservationFile, TruncationAnywhereGivesNoWrongNumber) {
  const std::string text = header3() + kEpoch3;
  const std::size_t header = header3().size();
  for (std::size_t n = header; n < text.size(); ++n) {
    const auto f = parse_observation_file(std::string_view(text).substr(0, n), "a.rnx");
    if (!f.ok()) continue;
    for (const auto& s : f->epochs.at(0).satellites)
      for (const auto& v : s.values)
        EXPECT_TRUE(v.missing() || v.value == 20000000.123 || v.value == 105100000.456 || v.value == -1234.567 ||
                    v.value == 45.25 || v.value == 19000000.0)
            << n << ": " << v.value;
  }
}

// Bytes changed at random, in plain and in compressed files: an error or counted damage, never a crash or a hang.
TEST(ObservationFile, SurvivesRandomBytes) {
  std::string plain = header3();
  for (int k = 0; k < 20; ++k) {
    char epoch[64];
    std::snprintf(epoch, sizeof epoch, "> 2020 06 25 00 %02d 30.0000000  0  2\n", k);
    plain +=
        epoch + std::string("G05  20000000.1231  105100000.456 7     -1234.567          45.250\nR01  19000000.000\n");
  }
  const std::string packed = HatanakaCompressor(true).compress(
      plain,
      field("3.0                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE") + field("", "CRINEX PROG / DATE"));
  ASSERT_TRUE(parse_observation_file(packed, "a.crx").ok());
  const RandomStream random(3, "test.bytes");
  for (const auto& good : {plain, packed}) {
    for (std::uint64_t k = 0; k < 3000; ++k) {
      std::string bad = good;
      for (std::uint32_t n = 0; n < 4; ++n) {
        const auto at = static_cast<std::size_t>(random.uniform(n, k, 0) * static_cast<double>(bad.size()));
        const double what = random.uniform(n, k, 1);
        if (what < 0.4)
          bad[at] = static_cast<char>(256.0 * random.uniform(n, k, 2));
        else if (what < 0.6)
          bad.erase(at, static_cast<std::size_t>(40.0 * random.uniform(n, k, 2)));
        else if (what < 0.8)
          bad.insert(at, "\n9&-&> 4");
        else
          bad[at] = static_cast<char>('0' + 10.0 * random.uniform(n, k, 2));
      }
      const auto f = parse_observation_file(bad, "bad");
      EXPECT_TRUE(!f.ok() || f->epochs.size() < 200u);
    }
  }
}

TEST(ObservationFile, CompressedFileNamesItsOwnLines) {
  std::string plain = header3() + kEpoch3 +
                      "> 2020 06 25 00 00 10.0000000  0  1\n"
                      "G05  20000000.123\n";
  const std::string packed = HatanakaCompressor(true).compress(
      plain,
      field("3.0                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE") + field("", "CRINEX PROG / DATE"));
  const auto f = parse_observation_file(packed, "a.crx");
  ASSERT_TRUE(f.ok());
  // Two lines of its own head, ten of the header, five of the first epoch, then the epoch line.
  EXPECT_THAT(f->warnings, ElementsAre("a.crx:18: epoch 2020-06-25T00:00:10.000 does not follow "
                                       "2020-06-25T00:00:30.000; skipped"));
}

TEST(ObservationFile, RealFilesAreReadWhole) {
  struct Want {
    const char* path;
    double version;
    std::size_t epochs;
    const char* marker;
    std::size_t satellites_of_first;
  };
  for (const Want& want :
       {Want{"gnss/usno_2005_020/usno0200.05o.gz", 2.10, 2880, "USNO", 10},
        Want{"gnss/arl_2015_200/arlm200a.15o", 2.11, 120, "ARL1", 8},
        Want{"gnss/esbc_2020_177/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz", 3.05, 2880, "ESBC00DNK", 43},
        Want{"gnss/rinex4/KMS300DNK_R_20221591000_01H_30S_MO.crx", 4.00, 19, "KMS3", 49}}) {
    CANYON_REAL_DATA(path, want.path);
    const auto f = read_observation_file(path);
    ASSERT_TRUE(f.ok()) << f.error().str();
    EXPECT_EQ(f->header.version, want.version);
    EXPECT_EQ(f->epochs.size(), want.epochs);
    EXPECT_EQ(f->header.marker_name, want.marker);
    EXPECT_EQ(f->epochs.front().satellites.size(), want.satellites_of_first);
    EXPECT_EQ(f->damaged, 0) << f->warnings.front();
    for (std::size_t i = 1; i < f->epochs.size(); ++i)
      ASSERT_EQ(f->epochs[i].t - f->epochs[i - 1].t, 30.0) << f->epochs[i].t.iso();
  }
}

}  // namespace
}  // namespace canyon::gnss
