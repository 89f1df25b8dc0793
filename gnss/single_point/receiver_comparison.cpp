#include "canyon/gnss/single_point/receiver_comparison.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"

namespace canyon::gnss {
namespace {

/// The record nearest to t, if it is of the same epoch. `records`: in the order of time.
const NmeaRecord* record_at(const std::vector<NmeaRecord>& records, GpsTime t) {
  const auto next =
      std::lower_bound(records.begin(), records.end(), t, [](const NmeaRecord& r, GpsTime at) { return r.t < at; });
  const NmeaRecord* nearest = nullptr;
  for (const auto candidate : {next, next == records.begin() ? next : next - 1})
    if (candidate != records.end() && (!nearest || std::abs(candidate->t - t) < std::abs(nearest->t - t)))
      nearest = &*candidate;
  return nearest && std::abs(nearest->t - t) <= kSameEpoch_s ? nearest : nullptr;
}

TruePlace place_of(const NmeaRecord& record) {
  TruePlace out{ecef_from_geodetic(record.place), std::nullopt};
  const Eigen::Vector3d v_enu(record.speed_m_s * std::sin(record.course_rad),
                              record.speed_m_s * std::cos(record.course_rad), 0.0);
  if (v_enu.allFinite()) out.v_E = rotation_E_from_enu(record.place) * v_enu;
  return out;
}

}  // namespace

Result<ReceiverComparison> compare_with_receiver(const std::vector<GnssFix>& fixes, const std::string& nmea_path) {
  CANYON_CHECK(!fixes.empty(), "no epochs");
  const GpsTime first = fixes.front().t;
  const CalendarTime day = calendar(first - first.leap_seconds());
  CANYON_TRY(NmeaFile log, read_nmea_file(nmea_path, GpsTime::from_calendar(day.year, day.month, day.day, 0, 0, 0.0)));
  std::vector<NmeaRecord>& records = log.records;
  std::erase_if(records, [](const NmeaRecord& r) { return r.quality == 0; });
  if (records.empty()) return Error{nmea_path, 0, "", "holds no position", "a log with fixes"};
  std::stable_sort(records.begin(), records.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  if (std::none_of(fixes.begin(), fixes.end(), [&](const GnssFix& f) { return record_at(records, f.t) != nullptr; }))
    return Error{nmea_path, 0, "", "covers " + records.front().t.iso() + " to " + records.back().t.iso() + " GPS time",
                 "epochs of the observations, " + first.iso() + " to " + fixes.back().t.iso()};
  ReceiverComparison out{nmea_path, static_cast<int>(records.size()), {}, log.warnings};
  out.difference = position_statistics(fixes, [&](GpsTime t) -> std::optional<TruePlace> {
    const NmeaRecord* record = record_at(records, t);
    return record ? std::optional(place_of(*record)) : std::nullopt;
  });
  return out;
}

}  // namespace canyon::gnss
