#include "canyon/gnss/satellites/navigation_data.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/process/progress.h"

namespace canyon::gnss {
namespace {

template <class T>
void append_all(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

std::string NavigationData::names() const {
  std::string out;
  for (const Source& file : files) out += (out.empty() ? "" : ", ") + file.name;
  return out;
}

std::string NavigationData::skipped() const {
  std::string out;
  for (const auto& [kind, count] : skipped_records)
    out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
  return out;
}

void NavigationData::append(NavigationData other) {
  append_all(files, other.files);
  append_all(kepler, other.kepler);
  append_all(glonass, other.glonass);
  append_all(klobuchar, other.klobuchar);
  append_all(warnings, other.warnings);
  if (!leap_seconds) leap_seconds = other.leap_seconds;
  for (const auto& [kind, count] : other.skipped_records) skipped_records[kind] += count;
}

std::optional<KlobucharCoefficients> NavigationData::klobuchar_at(GnssSystem system, GpsTime t) const {
  const BroadcastKlobuchar* last = nullptr;   // at or before t
  const BroadcastKlobuchar* first = nullptr;  // of all
  for (const auto& k : klobuchar) {
    if (k.system != system) continue;
    if (first == nullptr || k.t < first->t) first = &k;
    if (k.t <= t && (last == nullptr || k.t >= last->t)) last = &k;
  }
  if (last == nullptr) last = first;
  if (last == nullptr) return std::nullopt;
  return last->coefficients;
}

Status check_systems(const std::string& letters, const std::string& key) {
  const std::string expected = "letters of G (GPS), R (GLONASS), E (Galileo), C (BeiDou), J (QZSS), for example GREC";
  if (letters.empty()) return Error{"", 0, key, "no satellite system is named", expected};
  for (std::size_t i = 0; i < letters.size(); ++i) {
    if (std::string_view("GRECJ").find(letters[i]) == std::string_view::npos)
      return Error{"", 0, key, "unknown satellite system \"" + letters.substr(i, 1) + "\"", expected};
    if (letters.find(letters[i]) != i)
      return Error{"", 0, key, "satellite system \"" + letters.substr(i, 1) + "\" is named twice", expected};
  }
  return Ok{};
}

Status check_coverage(const NavigationData& data, const std::string& systems, GpsTime start, GpsTime end,
                      const std::string& key) {
  std::optional<GpsTime> first, last;
  const auto include = [&](const auto& record, double before_s, double after_s) {
    if (!record.healthy() || systems.find(system_letter(record.sv.system)) == std::string::npos) return;
    const GpsTime begin = record.toe - before_s, finish = record.toe + after_s;
    first = first ? std::min(*first, begin) : begin;
    last = last ? std::max(*last, finish) : finish;
  };
  for (const auto& r : data.kepler) include(r, r.valid_before_s, r.valid_after_s);
  for (const auto& r : data.glonass) include(r, GlonassEphemeris::kValidS, GlonassEphemeris::kValidS);
  if (!first)
    return Error{data.names(), 0, key, "no satellite of " + systems + " in it is healthy",
                 "a navigation file of the mission's day"};
  const std::string span = first->iso(0) + " to " + last->iso(0);
  if (start < *first || end > *last)
    return Error{data.names(), 0, key,
                 "covers " + span + " GPS time, not the mission's " + start.iso(0) + " to " + end.iso(0),
                 "a navigation file of the mission's day, or a mission within it (time.start, time.limit_s)"};

  const auto constellation = make_broadcast(data, {.systems = systems});
  constexpr double kStepS = 300.0;
  const double length_s = end - start;
  const int steps = static_cast<int>(std::ceil(length_s / kStepS));
  for (int k = 0; k <= steps; ++k) {
    throw_if_cancelled();
    const GpsTime t = start + std::min(k * kStepS, length_s);
    const auto valid = std::count_if(constellation->satellites().begin(), constellation->satellites().end(),
                                     [&](SatelliteId sv) { return constellation->state(sv, t).has_value(); });
    if (valid < 4)
      return Error{data.names(), 0, key,
                   "only " + std::to_string(valid) + " satellites of " + systems + " have a valid ephemeris at " +
                       t.iso(0) + " (the file covers " + span + ")",
                   "at least 4"};
  }
  return Ok{};
}

}  // namespace canyon::gnss
