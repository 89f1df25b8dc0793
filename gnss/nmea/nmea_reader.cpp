#include "canyon/gnss/nmea/nmea_reader.h"

#include <cmath>
#include <optional>

#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/gnss/nmea/sentence.h"
#include "canyon/gnss/rinex/calendar_fields.h"
#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {
namespace {

using Fields = std::vector<std::string_view>;

constexpr std::size_t kMaxWarnings = 10;
constexpr double kKnot = 1852.0 / 3600.0;  // m/s

/// Seconds of the UTC day of "hhmmss.ss".
std::optional<double> time_of_day(std::string_view text) {
  if (text.size() < 6) return std::nullopt;
  const auto h = whole_number(text.substr(0, 2)), m = whole_number(text.substr(2, 2));
  const auto s = fortran_number(text.substr(4));
  if (!h || !m || !s || *h < 0 || *h > 23 || *m < 0 || *m > 59 || *s < 0.0 || *s >= 61.0) return std::nullopt;
  return 3600.0 * *h + 60.0 * *m + *s;
}

/// Radians of "ddmm.mmmm" and its hemisphere.
std::optional<double> angle(std::string_view text, std::string_view side, char positive, char negative) {
  const auto value = fortran_number(text);
  if (!value || *value < 0.0 || side.size() != 1 || (side[0] != positive && side[0] != negative)) return std::nullopt;
  const double degrees = std::floor(*value / 100.0);
  const double rad = (degrees + (*value - 100.0 * degrees) / 60.0) * kDegree;
  return side[0] == negative ? -rad : rad;
}

/// Collects the sentences of one epoch; GGA and RMC of the same time of day make one record.
class Reader {
 public:
  Reader(NmeaFile& out, std::optional<GpsTime> day) : out_(out), day_(day) {}

  /// False if a field does not parse.
  bool take(const Fields& f) {
    if (f[0].size() < 5) return true;
    const std::string_view kind = f[0].substr(2);
    if (kind == "GGA") return gga(f);
    if (kind == "RMC") return rmc(f);
    if (kind == "ZDA") return zda(f);
    return true;
  }
  void finish() { close_epoch(); }
  bool saw_position_sentence() const { return saw_; }

 private:
  bool gga(const Fields& f) {
    saw_ = true;
    if (f.size() < 12) return false;
    const auto time = time_of_day(f[1]);
    const auto quality = whole_number(f[6]);
    if (!time || !quality) return f[1].empty();  // before the receiver knows the time: an epoch without content
    begin(*time);
    record_.quality = *quality;
    if (*quality == 0) return true;
    const auto lat = angle(f[2], f[3], 'N', 'S'), lon = angle(f[4], f[5], 'E', 'W');
    const auto altitude = fortran_number(f[9]), separation = fortran_number(f[11]);
    if (!lat || !lon || !altitude || std::abs(*lat) > 0.5 * kPi || std::abs(*lon) > kPi) return false;
    record_.place = {*lat, *lon, *altitude + separation.value_or(0.0)};
    record_.satellites = whole_number(f[7]).value_or(0);
    record_.hdop = fortran_number(f[8]).value_or(kNaN);
    has_place_ = true;
    return true;
  }

  bool rmc(const Fields& f) {
    saw_ = true;
    if (f.size() < 10) return false;
    const auto time = time_of_day(f[1]);
    if (!time) return f[1].empty();
    begin(*time);
    const auto date = whole_number(f[9]);
    if (f[9].size() == 6 && date) {
      const int year = *date % 100;
      if (!set_date(year < 80 ? 2000 + year : 1900 + year, *date / 100 % 100, *date / 10000)) return false;
    }
    if (f[2] != "A") return true;
    record_.speed_m_s = fortran_number(f[7]).value_or(kNaN) * kKnot;
    record_.course_rad = fortran_number(f[8]).value_or(kNaN) * kDegree;
    return true;
  }

  bool zda(const Fields& f) {
    if (f.size() < 5) return false;
    const auto time = time_of_day(f[1]);
    const auto day = whole_number(f[2]), month = whole_number(f[3]), year = whole_number(f[4]);
    if (!time || !day || !month || !year) return f[1].empty();
    begin(*time);
    return set_date(*year, *month, *day);
  }

  bool set_date(int year, int month, int day) {
    if (!is_date(year, month, day)) return false;
    day_ = GpsTime::from_calendar(year, month, day, 0, 0, 0.0);
    return true;
  }

  void begin(double time_s) {
    if (open_ && time_s == time_s_) return;
    close_epoch();
    // A GGA just past midnight comes before the RMC that tells the new date.
    if (day_ && time_s + 43200.0 < time_s_) day_ = *day_ + 86400.0;
    open_ = true;
    time_s_ = time_s;
  }

  void close_epoch() {
    if (open_ && day_ && (has_place_ || record_.quality == 0)) {
      record_.t = gps_time_of_utc(*day_ + time_s_, time_s_ >= 86400.0);
      out_.records.push_back(record_);
    }
    record_ = {};
    open_ = has_place_ = false;
  }

  NmeaFile& out_;
  NmeaRecord record_;
  std::optional<GpsTime> day_;  ///< midnight UTC, written as if it were GPS time
  double time_s_ = 0.0;
  bool open_ = false, has_place_ = false, saw_ = false;
};

}  // namespace

Result<NmeaFile> parse_nmea(std::string_view text, const std::string& file_name, std::optional<GpsTime> day) {
  NmeaFile out;
  Reader reader(out, day);
  TextLines lines(text);
  const auto damaged = [&](const char* what) {
    ++out.damaged_lines;
    if (out.warnings.size() < kMaxWarnings)
      out.warnings.push_back(file_name + ":" + std::to_string(lines.number()) + ": " + what + ": skipped");
  };
  while (lines.next()) {
    if (lines.line().empty() || lines.line().front() != '$') continue;
    const auto fields = nmea_fields(lines.line());
    if (!fields)
      damaged("NMEA sentence without a right checksum");
    else if (!reader.take(*fields))
      damaged("NMEA sentence with a field that does not parse");
  }
  reader.finish();
  if (!reader.saw_position_sentence())
    return Error{file_name, 0, "", "no GGA or RMC sentence in it", "an NMEA 0183 log"};
  return out;
}

Result<NmeaFile> read_nmea_file(const std::string& path, std::optional<GpsTime> day) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  return parse_nmea(text, path, day);
}

}  // namespace canyon::gnss
