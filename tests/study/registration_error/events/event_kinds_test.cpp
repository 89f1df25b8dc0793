#include "canyon/study/registration_error/events/event_kinds.h"

#include <vector>

#include <gtest/gtest.h>

namespace canyon::study {
namespace {

constexpr double kFirstFix_s = 3.5, kFixPeriod_s = 0.5;

/// An epoch so long after the start; GDOP 0: no fix.
mission::GnssRow fix_row(double t_s, double gdop, int hidden = 0) {
  mission::GnssRow row;
  row.fix.t = GpsTime{} + t_s;
  row.fix.status = gdop > 0.0 ? FixStatus::kSingle : FixStatus::kNone;
  row.fix.dop.gdop = gdop > 0.0 ? gdop : kNaN;
  row.truth.satellites.resize(static_cast<std::size_t>(hidden));
  for (GnssObservationTruth& satellite : row.truth.satellites)
    satellite.tracked = true, satellite.line_of_sight = false;
  return row;
}

/// What is made of fixes from kFirstFix_s to `until_s` whose GDOP is `gdop(t_s)`.
template <class Gdop, class Hidden>
std::vector<MapEvent> events_of_fixes(double until_s, Gdop&& gdop, Hidden&& hidden) {
  RunEvents seen;
  for (double t_s = kFirstFix_s; t_s < until_s; t_s += kFixPeriod_s)
    EXPECT_TRUE(seen.gnss(fix_row(t_s, gdop(t_s), hidden(t_s))).ok());
  return fix_events(seen.events(), kFirstFix_s, until_s - kFixPeriod_s, kFixPeriod_s);
}
int nothing_hidden(double) {
  return 0;
}

void expect_event(const MapEvent& event, MapEventKind kind, double t_s, double from_s, double to_s, double size) {
  EXPECT_EQ(event.kind, kind);
  EXPECT_EQ(event.t_s, t_s);
  EXPECT_EQ(event.from_s, from_s);
  EXPECT_EQ(event.to_s, to_s);
  EXPECT_EQ(event.size, size);
}

// All times are halves of a second, so exact. Events are counted from the mission's start, not from the first fix.
TEST(MapEvents, JumpsLossesReturnsAndHiddenSignalsAreWhereTheFixesSay) {
  const auto gdop = [](double t_s) {
    if (t_s < 8.0) return 2.0;
    if (t_s < 20.0) return 5.5;
    if (t_s < 23.0 || t_s == 40.0) return 0.0;
    return t_s < 30.0 ? 9.0 : 7.0;  // by 2, which is not more than 2
  };
  const auto hidden = [](double t_s) { return t_s < 50.0 || t_s > 51.5 ? 0 : t_s == 50.5 ? 3 : 1; };
  const std::vector<MapEvent> events = events_of_fixes(60.0, gdop, hidden);
  ASSERT_EQ(events.size(), 6U) << "a fix that comes back with another GDOP is no jump of it";
  expect_event(events[0], MapEventKind::kDilutionJump, 8.0, 8.0, 8.0, 3.5);
  expect_event(events[1], MapEventKind::kFixLost, 20.0, 20.0, 22.5, 3.0);
  expect_event(events[2], MapEventKind::kFixBack, 23.0, 20.0, 23.0, 3.0);
  expect_event(events[3], MapEventKind::kFixLost, 40.0, 40.0, 40.0, 0.5);
  expect_event(events[4], MapEventKind::kFixBack, 40.5, 40.0, 40.5, 0.5);
  expect_event(events[5], MapEventKind::kNlosBegin, 50.0, 50.0, 51.5, 3.0);
}

// Up by 4, down by 5 two seconds later: one jump of the larger size, which lasts while GDOP does not settle.
TEST(MapEvents, JumpsTwoSecondsApartAreOne) {
  const std::vector<MapEvent> events = events_of_fixes(
      20.0, [](double t_s) { return t_s < 10.0   ? 3.0
                                    : t_s < 12.0 ? 7.0
                                                 : 2.0; }, nothing_hidden);
  ASSERT_EQ(events.size(), 1U);
  expect_event(events[0], MapEventKind::kDilutionJump, 10.0, 10.0, 12.0, 5.0);
}

TEST(MapEvents, AFixOfASecondDoesNotEndALoss) {
  const std::vector<MapEvent> events = events_of_fixes(
      20.0, [](double t_s) { return t_s == 10.0 || t_s == 11.5 ? 0.0 : 2.0; }, nothing_hidden);
  ASSERT_EQ(events.size(), 2U);
  expect_event(events[0], MapEventKind::kFixLost, 10.0, 10.0, 11.5, 2.0);
  expect_event(events[1], MapEventKind::kFixBack, 12.0, 10.0, 12.0, 2.0);
}

TEST(MapEvents, ALossThatLastsToTheEndHasNoReturn) {
  const std::vector<MapEvent> events = events_of_fixes(
      20.0, [](double t_s) { return t_s < 17.0 ? 2.0 : 0.0; }, nothing_hidden);
  ASSERT_EQ(events.size(), 1U);
  expect_event(events[0], MapEventKind::kFixLost, 17.0, 17.0, 19.5, 3.0);
}

TEST(MapEvents, WhatAMissionFailsByMovesNoMap) {
  std::vector<Event> seen;
  for (const EventKind kind : {EventKind::kUnlikelyFix, EventKind::kOverconfident, EventKind::kMapDoubled,
                               EventKind::kPhantom, EventKind::kStopped})
    seen.push_back({kind, 1.0, 2.0, 3.0});
  EXPECT_TRUE(fix_events(seen, kFirstFix_s, 20.0, kFixPeriod_s).empty());
}

}  // namespace
}  // namespace canyon::study
