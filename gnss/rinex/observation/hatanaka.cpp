#include "canyon/gnss/rinex/observation/hatanaka.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>

#include "canyon/gnss/rinex/reader_warnings.h"
#include "canyon/gnss/rinex/text_lines.h"

namespace canyon::gnss {
namespace {

constexpr int kHighestOrder = 9;
constexpr std::int64_t kLargest = 9'999'999'999'999;  // F14.3 holds 13 digits and a point
constexpr std::size_t kMostInEpoch = 999;
/// A value takes at least a byte, where the text has 16; more than this many times its size no file that was compressed
/// becomes.
constexpr std::size_t kMostGrowth = 64, kRoom = std::size_t{1} << 20;

/// One number that is sent as differences in time.
class Arc {
 public:
  void begin(int order, std::int64_t value) {
    order_ = order;
    depth_ = 0;
    difference_[0] = value;
  }
  void end() { order_ = -1; }
  bool open() const { return order_ >= 0; }
  std::int64_t value() const { return difference_[0]; }

  /// The k-th difference after k numbers of the arc, then always the highest. False: the sum leaves any sensible range.
  bool advance(std::int64_t sent) {
    if (depth_ < order_) ++depth_;
    difference_[static_cast<std::size_t>(depth_)] = sent;
    for (int i = depth_ - 1; i >= 0; --i) {
      const auto k = static_cast<std::size_t>(i);
      if (__builtin_add_overflow(difference_[k], difference_[k + 1], &difference_[k])) return false;
    }
    return std::abs(difference_[0]) <= kLargest;
  }

 private:
  int order_ = -1, depth_ = 0;
  std::array<std::int64_t, kHighestOrder + 1> difference_{};
};

std::optional<std::int64_t> integer(std::string_view text) {
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

/// What one field does to its arc. False if it cannot be read, or continues an arc that never began.
bool apply(std::string_view field, Arc& arc) {
  if (field.size() > 2 && field[1] == '&') {
    const int order = field[0] - '0';
    const auto value = integer(field.substr(2));
    if (order < 0 || order > kHighestOrder || !value || std::abs(*value) > kLargest) return false;
    arc.begin(order, *value);
    return true;
  }
  const auto sent = integer(field);
  return sent && arc.open() && arc.advance(*sent);
}

/// Lays the changes over a line: blank = as before, & = now blank.
void overlay(std::string& line, std::string_view changes) {
  if (line.size() < changes.size()) line.resize(changes.size(), ' ');
  for (std::size_t i = 0; i < changes.size(); ++i)
    if (changes[i] != ' ') line[i] = changes[i] == '&' ? ' ' : changes[i];
}

/// value / 10^decimals, right-justified.
void append_fixed(std::string& out, std::int64_t value, int decimals, std::size_t width) {
  std::array<char, 32> text{};
  std::size_t at = text.size();
  std::uint64_t rest = value < 0 ? 0u - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
  for (int digit = 0; digit <= decimals || rest > 0; ++digit) {
    if (digit == decimals) text[--at] = '.';
    text[--at] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  }
  if (value < 0) text[--at] = '-';
  const std::size_t length = text.size() - at;
  if (length < width) out.append(width - length, ' ');
  out.append(text.data() + at, length);
}

/// State of one satellite between epochs.
struct Satellite {
  std::int64_t epoch = -1;  // in which it was seen last
  std::size_t types = 0;
  std::vector<Arc> arcs;  // up to the last number that its line had
  std::string flags;
};

class Decoder {
 public:
  Decoder(std::string_view text, const std::string& file)
      : lines_(text),
        file_(file),
        largest_(kMostGrowth * text.size() + kRoom),
        warnings_(file, "damaged values and epochs") {
    out_.text.reserve(4 * text.size());
    satellites_.resize(26 * 100);
  }

  Result<HatanakaText> decode() {
    CANYON_TRY_STATUS(read_compact_header());
    CANYON_TRY_STATUS(copy_header());
    while (lines_.next()) {
      read_epoch();
      if (out_.text.size() > largest_)
        return Error{file_, lines_.number(), "",
                     "the file unpacks to more than " + std::to_string(kMostGrowth) + " times its size",
                     "an observation file"};
    }
    out_.warnings = warnings_.list();
    return std::move(out_);
  }

 private:
  Status read_compact_header() {
    lines_.next();
    const auto version = fortran_number(columns(lines_.line(), 0, 20));
    if (!version || !(*version == 1.0 || (*version >= 3.0 && *version < 4.0)))
      return Error{file_, 1, "",
                   "Compact RINEX version \"" + printable(columns(lines_.line(), 0, 20)) + "\" is not supported",
                   "1.0 or 3.x"};
    modern_ = *version >= 3.0;
    lines_.next();
    return Ok{};
  }

  Status copy_header() {
    while (lines_.next()) {
      put_line(lines_.line());
      note_types(lines_.line());
      if (columns(lines_.line(), 60, 20) == "END OF HEADER") return Ok{};
    }
    return Error{file_, lines_.number(), "", "the file ends inside its header", "a line \"END OF HEADER\""};
  }

  void put_line(std::string_view line) { put_line(line, lines_.number()); }
  void put_line(std::string_view line, int source) {
    out_.text.append(line);
    while (!out_.text.empty() && out_.text.back() == ' ') out_.text.pop_back();
    out_.text.push_back('\n');
    out_.source_line.push_back(source);
  }

  /// Header lines, also those inside the file, say how many numbers a satellite has.
  void note_types(std::string_view line) {
    const std::string_view label = columns(line, 60, 20);
    if (label == "SYS / # / OBS TYPES" && !line.empty() && line[0] >= 'A' && line[0] <= 'Z')
      types_[static_cast<std::size_t>(line[0] - 'A')] = count(columns(line, 1, 5));
    else if (label == "# / TYPES OF OBSERV" && !columns(line, 0, 6).empty())
      types_.fill(count(columns(line, 0, 6)));
  }
  static std::size_t count(std::string_view text) {
    return static_cast<std::size_t>(std::clamp(whole_number(text).value_or(0), 0, 999));
  }

  bool whole_epoch_line(std::string_view line) const { return !line.empty() && line[0] == (modern_ ? '>' : '&'); }

  void read_epoch() {
    const std::string_view line = lines_.line();
    if (whole_epoch_line(line)) {
      epoch_line_.assign(line);
      if (!modern_) epoch_line_[0] = ' ';
      in_step_ = true;
      ++epoch_;  // sent whole: all arcs and flags begin anew
    } else if (in_step_) {
      overlay(epoch_line_, line);
    } else {
      return;  // lost: wait for the next whole epoch line
    }
    const int flag = columns(epoch_line_, modern_ ? 31 : 28, 1).empty() ? 0 : epoch_line_[modern_ ? 31 : 28] - '0';
    const auto number = whole_number(columns(epoch_line_, modern_ ? 32 : 29, 3));
    if (flag < 0 || flag > 6 || !number || *number < 0) return lose("the epoch line cannot be read");
    if (flag > 1) return copy_event(static_cast<std::size_t>(*number));
    read_observations(static_cast<std::size_t>(*number));
  }

  void lose(const std::string& why) {
    warnings_.add(lines_.number(), why, "an epoch of Compact RINEX; lost until the next one that is sent whole");
    in_step_ = false;
    ++epoch_;  // whatever continues after the gap is no longer the same arc
  }

  void copy_event(std::size_t records) {
    put_line(epoch_line_);
    for (std::size_t i = 0; i < records && !lines_.at_end(); ++i) {
      lines_.next();
      put_line(lines_.line());
      note_types(lines_.line());
    }
    in_step_ = false;  // what follows an event is always sent whole
  }

  void read_observations(std::size_t number) {
    const std::size_t list_at = modern_ ? 41 : 32;
    if (number > kMostInEpoch || epoch_line_.size() < list_at + 3 * number)
      return lose("the list of satellites is shorter than " + std::to_string(number));
    const std::string names = epoch_line_.substr(list_at, 3 * number);
    const int source = lines_.number();
    if (!lines_.next()) return;
    std::string clock;
    if (!read_clock(clock)) return lose("the receiver clock cannot be read");

    ++epoch_;
    body_.clear();
    std::vector<int> body_lines;
    for (std::size_t i = 0; i < number; ++i) {
      const std::string_view name(names.data() + 3 * i, 3);
      Satellite* satellite = find(name);
      if (satellite == nullptr) return lose("satellite \"" + printable(name) + "\"");
      if (!lines_.next()) return lose("the file ends inside an epoch");
      read_satellite(name, *satellite, body_lines);
    }
    put_epoch_line(number, names, clock, source);
    out_.text += body_;
    out_.source_line.insert(out_.source_line.end(), body_lines.begin(), body_lines.end());
  }

  bool read_clock(std::string& out) {
    const std::string_view field = lines_.line();
    if (field.empty()) {
      clock_.end();
      return true;
    }
    if (!apply(field, clock_)) return false;
    append_fixed(out, clock_.value(), modern_ ? 12 : 9, modern_ ? 15 : 12);
    return true;
  }

  Satellite* find(std::string_view name) {
    const char letter = name[0] == ' ' ? 'G' : name[0];
    const auto digit = [](char c) { return c == ' ' ? 0 : c - '0'; };
    const int tens = digit(name[1]), units = digit(name[2]);
    if (letter < 'A' || letter > 'Z' || tens < 0 || tens > 9 || units < 0 || units > 9) return nullptr;
    return &satellites_[static_cast<std::size_t>((letter - 'A') * 100 + tens * 10 + units)];
  }

  void read_satellite(std::string_view name, Satellite& s, std::vector<int>& body_lines) {
    const std::size_t types = types_[static_cast<std::size_t>((name[0] == ' ' ? 'G' : name[0]) - 'A')];
    if (s.epoch != epoch_ - 1 || s.types != types) {
      s.types = types;
      s.arcs.clear();
      s.flags.clear();
    }
    s.epoch = epoch_;
    std::string_view rest = lines_.line();
    missing_.assign(types, true);
    std::size_t k = 0;
    for (; k < types && !rest.empty(); ++k) {
      if (k == s.arcs.size()) s.arcs.emplace_back();
      const std::string_view field = rest.substr(0, std::min(rest.find(' '), rest.size()));
      rest.remove_prefix(std::min(field.size() + 1, rest.size()));
      if (field.empty()) {
        s.arcs[k].end();
      } else if (apply(field, s.arcs[k])) {
        missing_[k] = false;
      } else {
        warnings_.add(lines_.number(),
                      std::string(name) + ": number " + std::to_string(k + 1) + " is \"" + printable(field) + "\"",
                      s.arcs[k].open() ? "a difference" : "the beginning of an arc");
        s.arcs[k].end();
      }
    }
    if (k < s.arcs.size()) s.arcs.resize(k);
    overlay(s.flags, rest);
    if (s.flags.size() < 2 * types) s.flags.resize(2 * types, ' ');
    put_satellite(name, s, types, body_lines);
  }

  void put_satellite(std::string_view name, const Satellite& s, std::size_t types, std::vector<int>& body_lines) {
    const auto close = [&] {
      while (!body_.empty() && body_.back() == ' ') body_.pop_back();
      body_.push_back('\n');
      body_lines.push_back(lines_.number());
    };
    if (modern_) body_.append(name);
    for (std::size_t k = 0; k < types; ++k) {
      if (!modern_ && k > 0 && k % 5 == 0) close();
      if (missing_[k])
        body_.append(14, ' ');
      else
        append_fixed(body_, s.arcs[k].value(), 3, 14);
      body_.append(s.flags, 2 * k, 2);
    }
    close();
  }

  void put_epoch_line(std::size_t number, const std::string& names, const std::string& clock, int source) {
    if (modern_) {
      std::string line = epoch_line_.substr(0, 35);
      if (!clock.empty()) {
        line.resize(41, ' ');
        line += clock;
      }
      return put_line(line, source);
    }
    for (std::size_t first = 0; first == 0 || first < number; first += 12) {
      std::string line = first == 0 ? epoch_line_.substr(0, 32) : std::string(32, ' ');
      line += names.substr(std::min(3 * first, names.size()), 36);
      if (first == 0 && !clock.empty()) {
        line.resize(68, ' ');
        line += clock;
      }
      put_line(line, source);
    }
  }

  TextLines lines_;
  const std::string& file_;
  std::size_t largest_;  // text that may come out
  ReaderWarnings warnings_;
  HatanakaText out_;
  bool modern_ = true;
  bool in_step_ = false;  // the last epoch line is known
  std::array<std::size_t, 26> types_{};
  std::string epoch_line_, body_;
  Arc clock_;
  std::int64_t epoch_ = 0;
  std::vector<Satellite> satellites_;  // by letter and number
  std::vector<bool> missing_;
};

}  // namespace

bool is_hatanaka(std::string_view text) {
  const std::string_view line = text.substr(0, std::min(text.find('\n'), text.size()));
  return columns(line, 60, 20).starts_with("CRINEX VERS");
}

Result<HatanakaText> undo_hatanaka(std::string_view text, const std::string& file_name) {
  return Decoder(text, file_name).decode();
}

}  // namespace canyon::gnss
