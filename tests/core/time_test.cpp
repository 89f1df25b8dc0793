#include "canyon/core/time.h"

#include <cmath>

#include <gtest/gtest.h>

namespace canyon {
namespace {

GpsTime parsed(const std::string& text) {
  const auto t = GpsTime::parse(text, "--start");
  EXPECT_TRUE(t.ok()) << text << ": " << (t.ok() ? "" : t.error().str());
  return t.ok() ? *t : GpsTime{-1};
}

TEST(GpsTime, EpochIsTheSixthOfJanuary1980) {
  EXPECT_EQ(GpsTime::from_calendar(1980, 1, 6, 0, 0, 0.0).ns, 0);
  EXPECT_EQ(GpsTime{}.iso(), "1980-01-06T00:00:00.000");
  EXPECT_EQ(GpsTime{}.week(), 0);
}

// GPS weeks of known days: the two roll-overs of the ten-bit week, and day 182 of 2010 (week 1590, a Thursday).
TEST(GpsTime, KnownWeeks) {
  const GpsTime first_roll_over = GpsTime::from_calendar(1999, 8, 22, 0, 0, 0.0);
  EXPECT_EQ(first_roll_over.week(), 1024);
  EXPECT_EQ(first_roll_over.sow_ns(), 0);
  const GpsTime second_roll_over = GpsTime::from_calendar(2019, 4, 7, 0, 0, 0.0);
  EXPECT_EQ(second_roll_over.week(), 2048);
  EXPECT_EQ(second_roll_over.sow_ns(), 0);
  const GpsTime t = GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.0);
  EXPECT_EQ(t.week(), 1590);
  EXPECT_EQ(t.sow_s(), 4 * 86400.0 + 13 * 3600.0);
  EXPECT_EQ(t.day_of_year(), 182.0 + 13.0 / 24.0);
}

TEST(GpsTime, CalendarRoundTripOverEveryDayOfTheValidRange) {
  int year = 1980, month = 1, day = 6;
  for (std::int64_t d = 0; year <= 2261; ++d) {
    const GpsTime t{d * 86400 * kNsPerSecond};
    const CalendarTime c = calendar(t);
    ASSERT_TRUE(c.year == year && c.month == month && c.day == day) << d;
    ASSERT_EQ(GpsTime::from_calendar(year, month, day, 0, 0, 0.0), t);
    // The next day by the calendar's rules, written differently from the code under test.
    const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    const int lengths[] = {31, leap ? 29 : 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    if (++day > lengths[month - 1]) {
      day = 1;
      if (++month > 12) {
        month = 1;
        ++year;
      }
    }
  }
}

TEST(GpsTime, FieldsOfAnInstant) {
  const CalendarTime c = calendar(GpsTime::from_calendar(2024, 2, 29, 23, 59, 58.125));
  EXPECT_EQ(c.year, 2024);
  EXPECT_EQ(c.month, 2);
  EXPECT_EQ(c.day, 29);
  EXPECT_EQ(c.hour, 23);
  EXPECT_EQ(c.minute, 59);
  EXPECT_EQ(c.second, 58.125);
}

TEST(GpsTime, BeforeTheEpochWeeksAreNegativeAndSecondsOfWeekAreNot) {
  const GpsTime t{-1};
  EXPECT_EQ(t.week(), -1);
  EXPECT_EQ(t.sow_ns(), 604800 * kNsPerSecond - 1);
  EXPECT_EQ(t.iso(9), "1980-01-05T23:59:59.999999999");
}

TEST(GpsTime, IsoRoundsWithCarry) {
  const GpsTime t = GpsTime::from_calendar(2010, 12, 31, 23, 59, 59.9996);
  EXPECT_EQ(t.iso(3), "2011-01-01T00:00:00.000");
  EXPECT_EQ(t.iso(4), "2010-12-31T23:59:59.9996");
  EXPECT_EQ(t.iso(0), "2011-01-01T00:00:00");
  EXPECT_EQ(GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.0).iso(), "2010-07-01T13:00:00.000");
}

TEST(GpsTime, WeekAndSecondsOfWeek) {
  const GpsTime t = GpsTime::from_week_sow(1590, 392400.123456789);
  EXPECT_EQ(t.ns, (1590LL * 604800 + 392400) * kNsPerSecond + 123456789);
  EXPECT_EQ(t.sow_ns(), 392400123456789);
  EXPECT_EQ(t.sow_s(), 392400.123456789);
  EXPECT_EQ(GpsTime::from_week_sow(1590, 604800.0), GpsTime::from_week_sow(1591, 0.0));
}

// IERS Bulletin C: GPS minus UTC on some dates.
TEST(GpsTime, LeapSecondsOverTheYears) {
  const struct {
    int year, month, day, leap;
  } rows[] = {{1980, 1, 6, 0},  {1981, 6, 30, 0},   {1981, 7, 2, 1},  {1990, 6, 1, 6},  {1999, 6, 1, 13},
              {2005, 6, 1, 13}, {2006, 1, 2, 14},   {2009, 1, 2, 15}, {2010, 7, 1, 15}, {2012, 7, 2, 16},
              {2015, 7, 2, 17}, {2016, 12, 31, 17}, {2017, 1, 2, 18}, {2026, 1, 1, 18}};
  for (const auto& r : rows) {
    EXPECT_EQ(GpsTime::from_calendar(r.year, r.month, r.day, 0, 0, 0.0).leap_seconds(), r.leap)
        << r.year << "-" << r.month;
  }
}

TEST(GpsTime, LeapSecondOf2016SecondBySecond) {
  const GpsTime before = parsed("2016-12-31T23:59:59Z");
  const GpsTime leap = parsed("2016-12-31T23:59:60Z");
  const GpsTime after = parsed("2017-01-01T00:00:00Z");
  EXPECT_EQ(before.iso(0), "2017-01-01T00:00:16");
  EXPECT_EQ(leap.iso(0), "2017-01-01T00:00:17");
  EXPECT_EQ(after.iso(0), "2017-01-01T00:00:18");
  EXPECT_EQ(before.leap_seconds(), 17);
  EXPECT_EQ(leap.leap_seconds(), 17);
  EXPECT_EQ(after.leap_seconds(), 18);
  EXPECT_EQ(parsed("2016-12-31T23:59:60.5Z") - before, 1.5);
}

TEST(GpsTimeParse, AllForms) {
  const GpsTime t = GpsTime::from_calendar(2010, 7, 1, 13, 0, 0.0);
  EXPECT_EQ(parsed("2010-07-01T13:00:00"), t);
  EXPECT_EQ(parsed("2010-07-01 13:00:00"), t);
  EXPECT_EQ(parsed("2010-07-01T13:00"), t);
  EXPECT_EQ(parsed("2010-07-01"), t - 13 * 3600.0);
  EXPECT_EQ(parsed("2010-07-01T12:59:45Z"), t);
  EXPECT_EQ(parsed("1590:392400"), t);
  EXPECT_EQ(parsed("1590:392400.25"), t + 0.25);
  EXPECT_EQ(parsed("2010-07-01T13:00:00.000000001").ns, t.ns + 1);
  EXPECT_EQ(parsed("2010-07-01T13:00:00.0000000005").ns, t.ns + 1);
  EXPECT_EQ(parsed(t.iso(9)), t);
}

TEST(GpsTimeParse, MalformedTextIsAnErrorWordForWord) {
  const auto bad = GpsTime::parse("yesterday", "--start");
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().str(),
            "--start: \"yesterday\" is not a time, expected YYYY-MM-DDTHH:MM:SS (GPS time), the same with a trailing Z "
            "(UTC), or "
            "WEEK:SECONDS_OF_WEEK, from 1980-01-06 to 2261-12-31");
  EXPECT_EQ(bad.error().exit_code, 2);
}

TEST(GpsTimeParse, RefusesWhatIsNoInstant) {
  for (const char* text : {"",
                           "2010",
                           "2010-7-1",
                           "2010-13-01",
                           "2010-02-29",
                           "2010-04-31",
                           "2010-00-10",
                           "2010-07-00",
                           "2010-07-01T24:00:00",
                           "2010-07-01T13:60:00",
                           "2010-07-01T13:00:60",
                           "2010-07-01T13:00:60Z",
                           "2010-07-01T13:00:00.",
                           "2010-07-01T13:00:00+02:00",
                           "2010-07-01T13:00:00 ",
                           "2010-07-01T",
                           "2010-07-01T13",
                           "1979-12-31",
                           "1980-01-05T23:59:59",
                           "2262-01-01",
                           "1590:604800",
                           "1590:-1",
                           "-1:5",
                           "1590:",
                           ":5",
                           "1590:12.",
                           "99999:0",
                           "2016-12-31T23:59:60"}) {
    EXPECT_FALSE(GpsTime::parse(text, "--start").ok()) << text;
  }
  EXPECT_TRUE(GpsTime::parse("2012-02-29", "--start").ok());
}

TEST(GpsTime, ArithmeticIsExactToTheNanosecond) {
  const GpsTime t = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);
  EXPECT_EQ((t + 1e-9).ns, t.ns + 1);
  EXPECT_EQ((t - 1e-9).ns, t.ns - 1);
  EXPECT_EQ((t + 0.1).ns, t.ns + 100'000'000);
  EXPECT_EQ((t - 0.1).ns, t.ns - 100'000'000);
  EXPECT_EQ((t + 8'000'000'000.0).ns, t.ns + 8'000'000'000 * kNsPerSecond);
  EXPECT_THROW((void)(t + 9'000'000'000.0), ProgramError);  // beyond what 64 bits hold
  EXPECT_EQ((t + 0.1) - t, 0.1);
  const GpsTime late{t.ns + 100LL * 86400 * kNsPerSecond + 1};
  EXPECT_LE(std::abs(std::llround((late - t) * 1e9) - (100LL * 86400 * kNsPerSecond + 1)), 1);
  EXPECT_THROW((void)(t + std::nan("")), ProgramError);
  EXPECT_THROW((void)(t + 1e300), ProgramError);
}

TEST(GpsTime, TicksOfWholeAndDyadicRatesAreExact) {
  const GpsTime t = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);
  for (const std::int64_t k : {0LL, 1LL, 7LL, 200LL, 1'000'001LL, 2'000'000'000LL}) {
    EXPECT_EQ(tick(t, k, 200.0).ns, t.ns + k * 5'000'000);
    EXPECT_EQ(tick(t, k, 12.5).ns, t.ns + k * 80'000'000);
    EXPECT_EQ(tick(t, k, 0.5).ns, t.ns + k * 2'000'000'000);
    EXPECT_EQ(tick(t, -k, 200.0).ns, t.ns - k * 5'000'000);
  }
}

TEST(GpsTime, TicksRoundToTheNearestNanosecondAndNeverDrift) {
  const GpsTime t{};
  EXPECT_EQ(tick(t, 1, 3.0).ns, 333'333'333);
  EXPECT_EQ(tick(t, 2, 3.0).ns, 666'666'667);
  EXPECT_EQ(tick(t, -2, 3.0).ns, -666'666'667);
  for (std::int64_t k = 0; k < 3'000'000'000; k += 300'000'003) EXPECT_EQ(tick(t, k, 3.0).ns * 3, k * kNsPerSecond);
  // The documented rule in extended precision, where its rounding is far from a half.
  for (std::int64_t k = 1; k < 2'000'000; k += 777) {
    const double rate_hz = 99.7;
    EXPECT_EQ(tick(t, k, rate_hz).ns, std::llround(static_cast<long double>(k) * 1e9L / rate_hz)) << k;
  }
  EXPECT_THROW((void)tick(t, 1, 0.0), ProgramError);
}

}  // namespace
}  // namespace canyon
