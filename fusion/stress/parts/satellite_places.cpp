// Places of satellites among a few states.
#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/measurements/satellite_slots.h"
#include "canyon/fusion/stress/parts/subjects.h"

namespace canyon::fusion {
namespace {

/// Places of satellites: one that is seen keeps its own, a new one takes a free one, else that of the one not seen for
/// longest, and of this epoch none gives way.
StressFigure slots() {
  int wrong = 0;
  SatelliteSlots places(3);
  const auto sv = [](int prn) { return SatelliteId{GnssSystem::kGps, static_cast<std::uint8_t>(prn)}; };
  const auto epoch = [&](double t, std::initializer_list<int> prns) {
    GnssEpoch e{.t = GpsTime{} + t, .observations = {}};
    for (const int prn : prns) {
      GnssObservation o;
      o.sv = sv(prn);
      e.observations.push_back(o);
    }
    places.assign(e);
  };
  const auto stand = [&](std::vector<int> of, const std::vector<int>& begun) {
    for (int prn = 1; prn <= 9; ++prn) {
      const auto at = std::find(of.begin(), of.end(), prn);
      wrong += places.of(sv(prn)) == (at == of.end() ? -1 : static_cast<int>(at - of.begin())) ? 0 : 1;
    }
    wrong += places.begun() == begun ? 0 : 1;
  };
  wrong += places.count() == 3 && !places.taken(0) && places.of(sv(0)) == -1 ? 0 : 1;
  epoch(1.0, {5, 6}), stand({5, 6}, {0, 1});
  wrong += places.taken(1) && !places.taken(2) ? 0 : 1;
  epoch(2.0, {6, 7}), stand({5, 6, 7}, {2});
  epoch(3.0, {7, 8}), stand({8, 6, 7}, {0});              // 5 was seen first
  epoch(4.0, {9, 7}), stand({8, 9, 7}, {1});              // then 6
  epoch(5.0, {1, 2, 3, 4}), stand({1, 2, 3}, {0, 1, 2});  // 8 before 9 and 7, of which the first stands first
  epoch(6.0, {4, 3}), stand({4, 2, 3}, {0});
  places.clear();
  wrong += !places.taken(0) && places.of(sv(3)) == -1 && places.count() == 3 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> satellite_place_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "places of satellites among a few states",
           "a satellite that is seen gives way, or the latest one", "by hand: exact", "wrong"});
  rows.add("states/places_of_satellites", slots);
  return rows.take();
}

}  // namespace canyon::fusion
