#include "canyon/gnss/rinex/observation/observation_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "canyon/core/files/files.h"
#include "canyon/gnss/rinex/calendar_fields.h"
#include "canyon/gnss/rinex/observation/hatanaka.h"
#include "canyon/gnss/rinex/observation/observation_header.h"
#include "canyon/gnss/rinex/reader_warnings.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kField = 16;  // F14.3 and two flags
constexpr int kMostSatellites = 999;

/// A number in F14.3: its point stands in column 10 of the field, so a field that was cut off or has slipped is told
/// from a good one. The common case, digits around the point, is exact: fewer than 16 digits over a power of ten.
enum class Field { kBlank, kGood, kDamaged };
Field f14_3(std::string_view text, double& value) {
  if (text.find_first_not_of(' ') == std::string_view::npos) return Field::kBlank;
  if (text.size() < 14 || text[10] != '.') return Field::kDamaged;
  std::size_t at = text.find_first_not_of(' ');
  const bool negative = text[at] == '-';
  if (negative || text[at] == '+') ++at;
  std::int64_t thousandths = 0;
  for (; at < 14; ++at) {
    if (at == 10) continue;
    const auto digit = static_cast<unsigned>(text[at] - '0');
    if (digit > 9) return Field::kDamaged;
    thousandths = 10 * thousandths + static_cast<std::int64_t>(digit);
  }
  value = static_cast<double>(negative ? -thousandths : thousandths) / 1000.0;
  return Field::kGood;
}

std::uint8_t flag_digit(std::string_view line, std::size_t at) {
  return at < line.size() && line[at] >= '0' && line[at] <= '9' ? static_cast<std::uint8_t>(line[at] - '0') : 0;
}

/// Fields of an epoch line; both formats have them, in other columns.
struct EpochLine {
  std::optional<CalendarTime> time;  ///< blank for events without a time
  bool damaged_time = false;
  int flag = 0, number = 0;
  double clock_offset_s = kNaN;
};

std::optional<EpochLine> parse_epoch_line(std::string_view line, bool version3) {
  EpochLine out;
  const std::size_t flag_at = version3 ? 31 : 28;
  const std::string_view flag = columns(line, flag_at, 1);
  const auto number = whole_number(columns(line, flag_at + 1, 3));
  out.flag = flag.empty() ? 0 : flag[0] - '0';
  if (out.flag < 0 || out.flag > 6 || !number || *number < 0 || *number > kMostSatellites) return std::nullopt;
  out.number = *number;

  const std::size_t first = version3 ? 2 : 1;
  if (columns(line, first, flag_at - first).empty()) return out.flag > 1 ? std::optional(out) : std::nullopt;
  const std::size_t at = version3 ? 6 : 3;
  const auto year = whole_number(columns(line, first, version3 ? 4 : 2));
  const auto month = whole_number(columns(line, at, 3)), day = whole_number(columns(line, at + 3, 3));
  const auto hour = whole_number(columns(line, at + 6, 3)), minute = whole_number(columns(line, at + 9, 3));
  const auto second = fortran_number(columns(line, at + 12, 11));
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  const int full_year = version3 ? *year : *year + (*year < 80 ? 2000 : 1900);
  if (!is_date(full_year, *month, *day) || *hour < 0 || *hour > 23 || *minute < 0 || *minute > 59 || *second < 0.0 ||
      *second >= 61.0)
    return std::nullopt;
  out.time = CalendarTime{full_year, *month, *day, *hour, *minute, *second};
  const std::string_view offset = columns(line, version3 ? 41 : 68, version3 ? 15 : 12);
  if (!offset.empty()) out.clock_offset_s = fortran_number(offset).value_or(kNaN);
  return out;
}

GpsTime to_gps_time(const CalendarTime& c, const std::string& time_system) {
  GpsTime t = GpsTime::from_calendar(c.year, c.month, c.day, c.hour, c.minute, c.second);
  if (time_system == "BDT") return t + 14.0;
  if (time_system != "GLO") return t;
  return gps_time_of_utc(t, c.second >= 60.0);  // GLONASS time of RINEX is UTC
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, const std::vector<int>* source_line)
      : lines_(text), source_line_(source_line), header_(file), warnings_(file, "damaged epochs and values") {
    out_.name = file;
  }

  Result<ObservationFile> read() {
    CANYON_TRY_STATUS(read_header());
    while (next_data_line()) CANYON_TRY_STATUS(read_epoch());
    drop_waiting();
    out_.damaged += warnings_.count();
    out_.warnings = warnings_.list();
    out_.header = header_.header();
    if (out_.epochs.empty()) {
      std::string what = "no epoch of observations";
      if (!out_.warnings.empty()) what += " (the first damage: " + out_.warnings.front() + ")";
      return Error{out_.name, std::max(number(), 1), "", what, "observations after the header"};
    }
    return std::move(out_);
  }

 private:
  int number() const {
    const int n = lines_.number();
    if (source_line_ == nullptr || n < 1) return n;
    return n <= static_cast<int>(source_line_->size()) ? (*source_line_)[static_cast<std::size_t>(n - 1)] : n;
  }

  Status read_header() {
    if (!lines_.next()) return Error{out_.name, 1, "", "the file is empty", "a RINEX 2, 3 or 4 observation file"};
    CANYON_TRY_STATUS(header_.first_line(lines_.line(), number()));
    while (lines_.next()) {
      if (columns(lines_.line(), 60, 20) == "END OF HEADER") {
        CANYON_TRY_STATUS(header_.finish(number()));
        out_.code_sets.push_back(header_.codes());
        return Ok{};
      }
      CANYON_TRY_STATUS(header_.line(lines_.line(), number()));
    }
    return Error{out_.name, number(), "", "the file ends inside its header", "a line \"END OF HEADER\""};
  }

  static bool is_comment(std::string_view line) { return line.size() >= 67 && line.substr(60, 7) == "COMMENT"; }

  /// The next line that is no comment: files that were spliced have some between, and even inside, their epochs.
  bool next_data_line() {
    while (lines_.next())
      if (!is_comment(lines_.line())) return true;
    return false;
  }

  Status read_epoch() {
    const std::string_view line = lines_.line();
    if (line.find_first_not_of(" \t") == std::string_view::npos) return Ok{};
    const bool marked = !header_.version3() || line[0] == '>';
    const auto epoch = marked ? parse_epoch_line(line, header_.version3()) : std::nullopt;
    if (!epoch) {
      // One warning for all the lines up to the next epoch that can be read.
      if (!lost_) warnings_.add(number(), "not an epoch line: \"" + printable(line.substr(0, 35)) + "\"", "an epoch");
      lost_ = true;
      return Ok{};
    }
    lost_ = false;
    if (epoch->flag >= 2 && epoch->flag <= 5) return read_event(*epoch);
    if (header_.version3())
      read_observations3(*epoch);
    else
      read_observations2(*epoch);
    return Ok{};
  }

  Status read_event(const EpochLine& epoch) {
    ObservationEvent event;
    event.kind = static_cast<ObservationEvent::Kind>(epoch.flag);
    event.line = number();
    if (epoch.time) event.t = to_gps_time(*epoch.time, header_.header().time_system);
    out_.events.push_back(event);
    // Header records follow; an external event has none of its own, whatever its count says.
    for (int i = 0; i < epoch.number && !lines_.at_end(); ++i) {
      lines_.next();
      CANYON_TRY_STATUS(header_.line(lines_.line(), number()));
    }
    if (epoch.number > 0) CANYON_TRY_STATUS(header_.finish(number()));
    if (header_.codes() != out_.code_sets.back()) out_.code_sets.push_back(header_.codes());
    return Ok{};
  }

  ObservationEpoch new_epoch(const EpochLine& line) {
    ObservationEpoch out;
    out.t = to_gps_time(*line.time, header_.header().time_system);
    out.line = number();
    out.after_power_failure = line.flag == 1;
    out.clock_offset_s = line.clock_offset_s;
    out.code_set = out_.code_sets.size() - 1;
    return out;
  }

  std::optional<SatelliteId> satellite(std::string_view name) const {
    char letter = name.empty() ? ' ' : name[0];
    if (letter == ' ' && header_.header().system != 'M') letter = header_.header().system;
    const auto system = system_of_letter(letter);
    const auto prn = whole_number(columns(name, 1, 2));
    if (!system || !prn || *prn < 1) return std::nullopt;
    return SatelliteId{*system, static_cast<std::uint8_t>(*prn)};
  }
  static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || c == ' '; }

  /// Time ascends. An epoch that goes back waits: if more epochs follow it than it contradicts, those were the wrong
  /// ones, with a time tag in the future; else it is.
  void keep(ObservationEpoch epoch, int flag) {
    if (flag == 6) return;  // cycle slips, not observations
    auto& kept = out_.epochs;
    if (kept.empty() || epoch.t > kept.back().t) {
      drop_waiting();
      kept.push_back(std::move(epoch));
      return;
    }
    if (!waiting_.empty() && epoch.t <= waiting_.back().t) drop_waiting();
    waiting_.push_back(std::move(epoch));
    const auto wrong =
        std::find_if(kept.begin(), kept.end(), [&](const ObservationEpoch& e) { return e.t >= waiting_.front().t; });
    if (static_cast<std::ptrdiff_t>(waiting_.size()) <= kept.end() - wrong) return;
    for (auto e = wrong; e != kept.end(); ++e)
      warnings_.add(e->line, "epoch " + e->t.iso() + " lies after those that follow it");
    kept.erase(wrong, kept.end());
    std::move(waiting_.begin(), waiting_.end(), std::back_inserter(kept));
    waiting_.clear();
  }

  void drop_waiting() {
    for (const auto& e : waiting_)
      warnings_.add(e.line, "epoch " + e.t.iso() + " does not follow " + out_.epochs.back().t.iso());
    waiting_.clear();
  }

  /// False, with a warning, for a satellite that the epoch has already.
  bool is_new(SatelliteId sv, const ObservationEpoch& epoch) {
    const bool known = std::any_of(epoch.satellites.begin(), epoch.satellites.end(),
                                   [sv](const SatelliteObservations& s) { return s.sv == sv; });
    if (known) warnings_.add(number(), sv.str() + " stands twice in its epoch");
    return !known;
  }

  /// Values up to the last that is there: short lines take little memory, whatever the header announces.
  void add_satellite(SatelliteId sv, ObservationEpoch& epoch) const {
    std::size_t n = values_.size();
    while (n > 0 && values_[n - 1].missing() && values_[n - 1].loss_of_lock == 0) --n;
    epoch.satellites.push_back({sv, {values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(n)}});
  }

  void read_observations3(const EpochLine& line) {
    ObservationEpoch epoch = new_epoch(line);
    for (int i = 0; i < line.number; ++i) {
      if (lines_.at_end() || lines_.peek().starts_with('>')) {
        warnings_.add(epoch.line, "the epoch has " + std::to_string(i) + " satellites",
                      std::to_string(line.number) + " as announced");
        break;
      }
      lines_.next();
      if (is_comment(lines_.line())) {
        --i;
        continue;
      }
      const std::string_view record = lines_.line();
      const auto sv = satellite(record.substr(0, std::min<std::size_t>(3, record.size())));
      if (!sv) {
        skip_satellite(record.substr(0, std::min<std::size_t>(3, record.size())));
        continue;
      }
      if (!is_new(*sv, epoch)) continue;
      const auto& scale = header_.scale(sv->system);
      values_.assign(header_.codes()[static_cast<std::size_t>(sv->system)].size(), {});
      for (std::size_t k = 0; k < values_.size(); ++k) read_value(record, 3 + kField * k, scale[k], *sv, values_[k]);
      add_satellite(*sv, epoch);
    }
    keep(std::move(epoch), line.flag);
  }

  void read_observations2(const EpochLine& line) {
    ObservationEpoch epoch = new_epoch(line);
    std::string names;
    for (int i = 0; i < line.number; ++i) {
      if (i > 0 && i % 12 == 0 && !next_data_line()) break;
      const std::string_view list = lines_.line();
      const std::size_t at = 32 + 3 * static_cast<std::size_t>(i % 12);
      if (at + 3 > list.size()) break;
      names += list.substr(at, 3);
    }
    if (names.size() < 3 * static_cast<std::size_t>(line.number)) {
      warnings_.add(epoch.line, "the epoch lists " + std::to_string(names.size() / 3) + " satellites",
                    std::to_string(line.number) + " as announced");
      return;
    }
    const std::size_t types = header_.count('G');
    for (int i = 0; i < line.number; ++i) {
      const std::string_view name(names.data() + 3 * i, 3);
      const auto sv = satellite(name);
      values_.assign(types, {});
      for (std::size_t k = 0; k < types; ++k) {
        if (k % 5 == 0 && !next_data_line()) {
          warnings_.add(epoch.line, "the file ends inside the epoch");
          return;
        }
        if (sv) read_value(lines_.line(), kField * (k % 5), 1.0, *sv, values_[k]);
      }
      if (!sv)
        skip_satellite(name);
      else if (is_new(*sv, epoch))
        add_satellite(*sv, epoch);
    }
    keep(std::move(epoch), line.flag);
  }

  void skip_satellite(std::string_view name) {
    if (!name.empty() && is_letter(name[0]) && whole_number(columns(name, 1, 2)))
      ++out_.other_system_satellites;
    else
      warnings_.add(number(), "satellite \"" + printable(name) + "\"", "a letter and a number");
  }

  void read_value(std::string_view record, std::size_t at, double scale, SatelliteId sv, ObservationValue& out) {
    if (at >= record.size()) return;
    double value = 0.0;
    const Field field = f14_3(record.substr(at, 14), value);
    if (field == Field::kDamaged) {
      warnings_.add(number(), sv.str() + ": \"" + printable(record.substr(at, 14)) + "\"", "a number as F14.3");
      return;
    }
    out.loss_of_lock = flag_digit(record, at + 14);
    out.strength = flag_digit(record, at + 15);
    if (field == Field::kGood && value != 0.0) out.value = value / scale;
  }

  TextLines lines_;
  const std::vector<int>* source_line_;
  ObservationHeaderReader header_;
  ReaderWarnings warnings_;
  ObservationFile out_;
  std::vector<ObservationEpoch> waiting_;  // ascending; they go back after the last one kept
  std::vector<ObservationValue> values_;   // of the satellite at hand
  bool lost_ = false;
};

}  // namespace

Result<ObservationFile> parse_observation_file(std::string_view text, const std::string& file_name) {
  if (!is_hatanaka(text)) return Reader(text, file_name, nullptr).read();
  CANYON_TRY(HatanakaText plain, undo_hatanaka(text, file_name));
  CANYON_TRY(ObservationFile out, Reader(plain.text, file_name, &plain.source_line).read());
  out.damaged += static_cast<int>(plain.warnings.size());
  out.warnings.insert(out.warnings.begin(), plain.warnings.begin(), plain.warnings.end());
  return out;
}

Result<ObservationFile> read_observation_file(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_or_gzip_file(path));
  return parse_observation_file(text, path);
}

}  // namespace canyon::gnss
