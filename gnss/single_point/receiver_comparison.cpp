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

Result<ReceiverLog> read_receiver_log(const std::string& nmea_path, GpsTime first) {
  const CalendarTime day = calendar(first - first.leap_seconds());
  CANYON_TRY(NmeaFile log, read_nmea_file(nmea_path, GpsTime::from_calendar(day.year, day.month, day.day, 0, 0, 0.0)));
  ReceiverLog out{nmea_path, std::move(log.records), std::move(log.warnings)};
  std::erase_if(out.records, [](const NmeaRecord& r) { return r.quality == 0; });
  if (out.records.empty()) return Error{nmea_path, 0, "", "holds no GGA with a fix", "a log with fixes"};
  std::stable_sort(out.records.begin(), out.records.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return out;
}

Result<ReceiverComparison> compare_with_receiver(const std::vector<GnssFix>& fixes, const ReceiverLog& log) {
  CANYON_CHECK(!fixes.empty() && !log.records.empty(), fixes.size(), " epochs, ", log.records.size(), " records");
  if (std::none_of(fixes.begin(), fixes.end(),
                   [&](const GnssFix& f) { return record_at(log.records, f.t) != nullptr; }))
    return Error{log.file, 0, "",
                 "covers " + log.records.front().t.iso() + " to " + log.records.back().t.iso() + " GPS time",
                 "epochs of the observations, " + fixes.front().t.iso() + " to " + fixes.back().t.iso()};
  ReceiverComparison out{log.file, static_cast<int>(log.records.size()), {}, log.warnings};
  out.difference = position_statistics(fixes, [&](GpsTime t) -> std::optional<TruePlace> {
    const NmeaRecord* record = record_at(log.records, t);
    return record ? std::optional(place_of(*record)) : std::nullopt;
  });
  return out;
}

}  // namespace canyon::gnss
