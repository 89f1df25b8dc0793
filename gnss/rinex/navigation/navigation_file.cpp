#include "canyon/gnss/rinex/navigation/navigation_file.h"

#include <algorithm>
#include <cstdio>

#include "canyon/core/files/files.h"
#include "canyon/gnss/rinex/navigation/glonass_record.h"
#include "canyon/gnss/rinex/navigation/kepler_record.h"
#include "canyon/gnss/rinex/navigation/klobuchar_record.h"
#include "canyon/gnss/rinex/navigation/navigation_header.h"
#include "canyon/gnss/rinex/reader_warnings.h"
#include "canyon/gnss/rinex/satellite_name.h"
#include "canyon/gnss/rinex/text_lines.h"
#include "canyon/gnss/satellites/contradictions.h"

namespace canyon::gnss {
namespace {

constexpr const char* kExpectedStart = "a satellite number first";

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t") == std::string_view::npos;
}

class RecordReader {
 public:
  RecordReader(TextLines& lines, const NavigationHeader& header, const std::string& file, NavigationData& out)
      : lines_(lines), header_(header), file_(file), out_(out) {}

  void read_all() {
    while (lines_.next()) {
      if (is_blank(lines_.line())) continue;
      RecordLines record{{}, lines_.number(), file_, header_.version2()};
      const std::string_view first = lines_.line();
      record_line_ = lines_.number();
      if (!starts_record(first)) {
        warn(Error{file_, lines_.number(), "", "a line that belongs to no record", expected_start()});
        collect(record);
        continue;
      }
      if (header_.version < 4.0) {
        record.lines.push_back(first);
        collect(record);
        read_old(record);
      } else {
        ++record.first_line;
        collect(record);
        read_named(first, record);
      }
    }
    drop_contradictions(out_.kepler, kepler_lines_);
    drop_contradictions(out_.glonass, glonass_lines_);
    const auto listed = warnings_.list();
    out_.warnings.insert(out_.warnings.end(), listed.begin(), listed.end());
  }
  int damaged() const { return warnings_.count(); }

 private:
  /// RINEX 2 and 3: a record's first line begins with a satellite, those that continue it with blanks. RINEX 4: `>`.
  bool starts_record(std::string_view line) const {
    if (line.empty()) return false;
    if (header_.version2()) return line[0] != ' ' || (line.size() > 1 && line[1] != ' ');
    return header_.version < 4.0 ? line[0] != ' ' : line[0] == '>';
  }
  std::string expected_start() const {
    return header_.version < 4.0 ? kExpectedStart : "a line that starts with \">\"";
  }

  /// Adds the lines up to the next record.
  void collect(RecordLines& record) {
    while (!lines_.at_end() && !starts_record(lines_.peek())) {
      lines_.next();
      if (!is_blank(lines_.line())) record.lines.push_back(lines_.line());
    }
  }

  void read_old(const RecordLines& record) {
    const char letter = header_.version2() ? header_.system : record.lines.front()[0];
    const auto system = system_of_letter(letter);
    if (!system && letter != 'I') {
      warn(Error{file_, record.first_line, "", "a line that belongs to no record", kExpectedStart});
      return;
    }
    if (!system || *system == GnssSystem::kSbas) {
      ++out_.skipped_records[std::string("EPH ") + letter];
      return;
    }
    const auto sv = satellite(record, *system);
    if (!sv) return;
    if (*system == GnssSystem::kGlonass)
      keep(parse_glonass_record(record, *sv), out_.glonass, &glonass_lines_);
    else
      keep(parse_kepler_record(record, *sv, kepler_message_of_old_record(record, *sv)), out_.kepler, &kepler_lines_);
  }

  /// `> EPH G01 LNAV` and the lines after it.
  void read_named(std::string_view name_line, const RecordLines& record) {
    const std::string kind(columns(name_line, 2, 3)), message(columns(name_line, 10, 4));
    const std::string_view who = columns(name_line, 6, 3);
    const std::optional<GnssSystem> known = who.empty() ? std::nullopt : system_of_letter(who[0]);
    const GnssSystem system = known.value_or(GnssSystem::kSbas);  // of NavIC and others nothing is read either
    // Only ephemerides need a satellite; other records may name the system alone.
    const auto prn = who.size() > 1 ? whole_number(who.substr(1)) : std::optional<int>(kind == "EPH" ? 0 : 1);
    if (kind.size() != 3 || who.empty() || !prn || *prn < 1 || *prn > 63 || record.lines.empty()) {
      warn(Error{file_, record.first_line - 1, "", "record \"" + printable(name_line.substr(0, 14)) + "\"",
                 "kind, satellite and message, for example \"> EPH G01 LNAV\", and lines of data"});
      return;
    }
    const SatelliteId sv{system, static_cast<std::uint8_t>(*prn)};
    const auto kepler = kepler_message(system, message);
    if (kind == "EPH" && (kepler || (system == GnssSystem::kGlonass && message == "FDMA"))) {
      if (satellite(record, system) != sv) {
        warn(Error{file_, record.first_line, "", "satellite \"" + printable(columns(record.lines.front(), 0, 3)) + "\"",
                   sv.str()});
      } else if (kepler) {
        keep(parse_kepler_record(record, sv, *kepler), out_.kepler, &kepler_lines_);
      } else {
        keep(parse_glonass_record(record, sv), out_.glonass, &glonass_lines_);
      }
    } else if (kind == "ION" && is_klobuchar(system, message)) {
      keep(parse_klobuchar_record(record, sv), out_.klobuchar);
    } else {
      // Bounded, whatever bytes stand there.
      const bool plain = printable(kind + message).find('?') == std::string::npos && out_.skipped_records.size() < 64;
      ++out_.skipped_records[plain ? kind + " " + who[0] + " " + message : "other"];
    }
  }

  static bool is_klobuchar(GnssSystem system, const std::string& message) {
    switch (system) {
      case GnssSystem::kGps:
      case GnssSystem::kQzss:
        return message == "LNAV" || message == "CNVX";
      case GnssSystem::kBeidou:
        return message == "D1D2";  // CNVX is BDGIM, a model of its own
      default:
        return false;
    }
  }

  std::optional<SatelliteId> satellite(const RecordLines& record, GnssSystem system) {
    const auto prn = satellite_number(record);
    if (prn) return SatelliteId{system, static_cast<std::uint8_t>(*prn)};
    const char letter = system_letter(system);
    warn(Error{file_, record.first_line, "",
               "satellite number \"" + printable(columns(record.lines.front(), 0, 3)) + "\"",
               std::string(1, letter) + "01 to " + letter + "63"});
    return std::nullopt;
  }

  /// `lines`: where to note the line that the record begins with.
  template <class T>
  void keep(const Result<T>& parsed, std::vector<T>& to, std::vector<int>* lines = nullptr) {
    if (!parsed.ok()) {
      warn(parsed.error());
      return;
    }
    to.push_back(*parsed);
    if (lines != nullptr) lines->push_back(record_line_);
  }

  template <class T>
  void drop_contradictions(std::vector<T>& records, const std::vector<int>& lines) {
    const auto found = contradictions(records);
    for (const Contradiction& c : found) {
      char distance[32];
      std::snprintf(distance, sizeof distance, "%.0f km", 1e-3 * c.distance_m);
      warn(Error{file_, lines[c.index], "",
                 records[c.index].sv.str() + ": the orbit of " + records[c.index].toe.iso(0) + " is " + distance +
                     " away from what the records before and after it say",
                 ""});
    }
    for (auto c = found.rbegin(); c != found.rend(); ++c)
      records.erase(records.begin() + static_cast<std::ptrdiff_t>(c->index));
  }

  void warn(const Error& error) { warnings_.add(error.line, error.what, error.expected); }

  TextLines& lines_;
  const NavigationHeader& header_;
  const std::string& file_;
  NavigationData& out_;
  ReaderWarnings warnings_{file_, "damaged records"};
  int record_line_ = 0;  // where the record at hand begins
  std::vector<int> kepler_lines_, glonass_lines_;
};

std::optional<GpsTime> first_epoch(const NavigationData& data) {
  std::optional<GpsTime> first;
  for (const auto& r : data.kepler) first = first ? std::min(*first, r.toe) : r.toe;
  for (const auto& r : data.glonass) first = first ? std::min(*first, r.toe) : r.toe;
  return first;
}

}  // namespace

Result<NavigationData> parse_navigation_file(std::string_view text, const std::string& file_name) {
  TextLines lines(text);
  CANYON_TRY(const NavigationHeader header, parse_navigation_header(lines, file_name));
  NavigationData out;
  out.files.push_back({file_name, header.version});
  out.leap_seconds = header.leap_seconds;
  out.warnings = header.warnings;
  RecordReader reader(lines, header, file_name, out);
  reader.read_all();
  const auto first = first_epoch(out);
  if (!first) {
    std::string what = "no usable ephemeris";
    if (!out.warnings.empty())
      what += " (" + std::to_string(reader.damaged()) + " damaged, the first: " + out.warnings.front() + ")";
    int skipped = 0;
    for (const auto& [kind, count] : out.skipped_records) skipped += count;
    if (skipped > 0) what += " (" + std::to_string(skipped) + " records of other kinds)";
    return Error{file_name, std::max(lines.number(), 1), "", what,
                 "broadcast ephemerides of GPS, GLONASS, Galileo, BeiDou or QZSS"};
  }
  for (BroadcastKlobuchar k : header.klobuchar) {
    k.t = *first;
    out.klobuchar.push_back(k);
  }
  return out;
}

Result<NavigationData> read_navigation_file(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  return parse_navigation_file(text, path);
}

Result<NavigationData> read_navigation_files(const std::vector<std::string>& paths) {
  NavigationData all;
  for (const std::string& path : paths) {
    CANYON_TRY(NavigationData one, read_navigation_file(path));
    all.append(std::move(one));
  }
  return all;
}

}  // namespace canyon::gnss
