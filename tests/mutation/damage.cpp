#include "canyon/tests/mutation/damage.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "canyon/core/random/random.h"

namespace canyon::testing {
namespace {

/// Damage does not make a file longer than this.
constexpr std::size_t kLongest = 8u << 20;

/// The draws of one variant, one after the other.
class Draws {
 public:
  Draws(std::string_view format, std::uint64_t variant)
      : stream_(12, "mutation." + std::string(format)), variant_(variant) {}

  /// 0 <= result < n; 0 for n = 0.
  std::size_t below(std::size_t n) {
    const double u = stream_.uniform(0, variant_, draw_++);
    return n == 0 ? 0 : std::min(n - 1, static_cast<std::size_t>(u * static_cast<double>(n)));
  }
  bool one_in(std::size_t n) { return below(n) == 0; }
  /// Mostly small, sometimes as large as `most`.
  std::size_t length(std::size_t most) { return 1 + below(one_in(3) ? most : std::min<std::size_t>(most, 16)); }
  char byte() { return static_cast<char>(below(256)); }
  template <class Table>
  const auto& of(const Table& table) {
    return table[below(std::size(table))];
  }

 private:
  RandomStream stream_;
  std::uint64_t variant_;
  std::uint32_t draw_ = 0;
};

constexpr std::array kNumbers{"1e308",
                              "-1e308",
                              "1e400",
                              "1e20",
                              "-1e20",
                              "1e9",
                              "-1e9",
                              "1e6",
                              "-1",
                              "0",
                              "-0.0",
                              "1",
                              "0.1",
                              "1e-320",
                              "1e-12",
                              "65536",
                              "-32769",
                              "999999",
                              "nan",
                              "-nan",
                              "inf",
                              "-inf",
                              "2147483648",
                              "-2147483649",
                              "1D+306",
                              "0x10",
                              "1e",
                              "--1",
                              "4294967296",
                              "-4294967296",
                              "180",
                              "360.0000001",
                              "9223372036854775808",
                              "99999999999999999999",
                              "1e99999",
                              "0.00000000000000000000000000001"};

bool in_number(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == '+' || c == '-' || c == 'e' || c == 'E' || c == 'D';
}

/// A number of the text, as [begin, end): the first at or after a random place; empty if there is none.
std::pair<std::size_t, std::size_t> some_number(const std::string& text, Draws& draws) {
  const std::size_t from = draws.below(text.size());
  std::size_t at = text.find_first_of("0123456789", from);
  if (at == std::string::npos) at = text.find_first_of("0123456789");
  if (at == std::string::npos) return {0, 0};
  std::size_t begin = at, end = at;
  while (begin > 0 && in_number(text[begin - 1])) --begin;
  while (end < text.size() && in_number(text[end])) ++end;
  return {begin, end};
}

/// Formats of fixed columns are only reached by a number that keeps its width, others by any.
void put_extreme_number(std::string& text, Draws& draws) {
  const auto [begin, end] = some_number(text, draws);
  std::string number = draws.of(kNumbers);
  const std::size_t width = end - begin;
  if (draws.one_in(2) && number.size() < width) number.insert(0, width - number.size(), ' ');
  text.replace(begin, width, number);
}

void exchange_numbers(std::string& text, Draws& draws) {
  const auto [a, a_end] = some_number(text, draws);
  const auto [b, b_end] = some_number(text, draws);
  if (a_end > b) return;
  const std::string first = text.substr(a, a_end - a), second = text.substr(b, b_end - b);
  text.replace(b, b_end - b, first);
  text.replace(a, a_end - a, second);
}

/// Whole numbers and floating-point ones as binary formats hold them, of both byte orders.
void put_extreme_bytes(std::string& text, Draws& draws) {
  static constexpr std::array<std::uint64_t, 14> kValues{0,
                                                         1,
                                                         0x7f,
                                                         0x80,
                                                         0xff,
                                                         0x7fff,
                                                         0xffff,
                                                         0x7fffffff,
                                                         0x80000000,
                                                         0xffffffff,
                                                         0x7f800000,           // infinity, single
                                                         0x7149f2ca,           // 1e30, single
                                                         0x7ff8000000000000,   // NaN, double
                                                         0x7fe1ccf385ebc8a0};  // 1e308, double
  static constexpr std::array<std::size_t, 4> kWidths{1, 2, 4, 8};
  const std::size_t width = draws.of(kWidths);
  if (text.size() < width) return;
  std::size_t at = draws.below(text.size() - width + 1);
  if (!draws.one_in(4)) at -= at % width;
  const std::uint64_t value = draws.of(kValues);
  const bool big_endian = draws.one_in(2);
  for (std::size_t i = 0; i < width; ++i)
    text[at + i] = static_cast<char>(value >> (8 * (big_endian ? width - 1 - i : i)));
}

void flip_bits(std::string& text, Draws& draws) {
  for (std::size_t n = 1 + draws.below(8); n > 0 && !text.empty(); --n)
    text[draws.below(text.size())] ^= static_cast<char>(1 << draws.below(8));
}

/// Half of them digits, signs, letters and brackets that text formats are made of: they reach further into a reader.
void replace_bytes(std::string& text, Draws& draws) {
  static constexpr std::string_view kPlausible = "0123456789.-+DEe ,:;\"'<>[]{}()=/\\&#\n\t";
  for (std::size_t n = 1 + draws.below(6); n > 0 && !text.empty(); --n)
    text[draws.below(text.size())] = draws.one_in(2) ? draws.byte() : draws.of(kPlausible);
}

void cut_short(std::string& text, Draws& draws) {
  text.resize(draws.below(text.size() + 1));
}

void insert_bytes(std::string& text, Draws& draws) {
  std::string bytes(draws.length(200), '\0');
  for (char& c : bytes) c = draws.byte();
  text.insert(draws.below(text.size() + 1), bytes);
}

void leave_a_block_out(std::string& text, Draws& draws) {
  const std::size_t at = draws.below(text.size());
  text.erase(at, draws.length(text.size() / 4 + 1));
}

void double_a_block(std::string& text, Draws& draws) {
  const std::string block = text.substr(draws.below(text.size()), draws.length(text.size() / 4 + 1));
  const std::size_t at = draws.below(text.size() + 1), times = draws.one_in(8) ? 50 : 1;
  for (std::size_t n = 0; n < times && text.size() + block.size() < kLongest; ++n) text.insert(at, block);
}

/// The line around a random place, with its end, as [begin, end).
std::pair<std::size_t, std::size_t> some_line(const std::string& text, Draws& draws) {
  const std::size_t at = draws.below(text.size());
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const std::size_t after = text.find('\n', at);
  return {before == std::string::npos ? 0 : before + 1, after == std::string::npos ? text.size() : after + 1};
}

void leave_a_line_out(std::string& text, Draws& draws) {
  const auto [begin, end] = some_line(text, draws);
  text.erase(begin, end - begin);
}

/// Another line's copy, beside itself or elsewhere: keys that occur twice, and things out of order.
void double_a_line(std::string& text, Draws& draws) {
  const auto [begin, end] = some_line(text, draws);
  const std::string line = text.substr(begin, end - begin);
  text.insert(draws.one_in(2) ? end : some_line(text, draws).first, line);
}

void move_a_line(std::string& text, Draws& draws) {
  const auto [begin, end] = some_line(text, draws);
  const std::string line = text.substr(begin, end - begin);
  text.erase(begin, end - begin);
  text.insert(some_line(text, draws).first, line);
}

/// The quoted string around or after a random place takes the place of another: repeated and wrong keys.
void copy_a_string(std::string& text, Draws& draws) {
  const auto some_string = [&]() -> std::pair<std::size_t, std::size_t> {
    const std::size_t open = text.find('"', draws.below(text.size()));
    const std::size_t close = open == std::string::npos ? open : text.find('"', open + 1);
    return close == std::string::npos ? std::pair<std::size_t, std::size_t>{0, 0} : std::pair{open, close + 1};
  };
  const auto [from, from_end] = some_string();
  const auto [to, to_end] = some_string();
  text.replace(to, to_end - to, text.substr(from, from_end - from));
}

/// One kind of bracket, or an element of the file's own, opened over and over, with or without its ends.
void nest(std::string& text, Draws& draws) {
  struct Bracket {
    const char *open, *close;
  };
  static constexpr std::array<Bracket, 7> kBrackets{{{"[", "]"},
                                                     {"{\"a\":", "}"},
                                                     {"<a>", "</a>"},
                                                     {"(", ")"},
                                                     {"[{\"geometry\":", "}]"},
                                                     {"{", "}"},
                                                     {"<g id='1'>", "</g>"}}};
  const Bracket& bracket = draws.of(kBrackets);
  static constexpr std::array<std::size_t, 4> kDepths{10, 300, 5'000, 100'000};
  const std::size_t depth = draws.of(kDepths);
  std::string open, close;
  for (std::size_t n = 0; n < depth; ++n) open += bracket.open, close += bracket.close;
  const std::size_t at = draws.below(text.size() + 1);
  if (draws.one_in(2)) text.insert(std::min(text.size(), at + draws.below(40)), close);
  text.insert(at, open);
}

void put_bytes_that_are_no_text(std::string& text, Draws& draws) {
  static const std::array<std::string, 8> kBytes{std::string("\xff\xfe"),     std::string("\x80\x80\x80"),
                                                 std::string("\xc3\x28"),     std::string("\xed\xa0\x80"),
                                                 std::string("\xf0\x9f\x92"), std::string("\0", 1),
                                                 std::string("\xef\xbb\xbf"), std::string("\x1b[31m\r\b\x07")};
  const std::string& bytes = draws.of(kBytes);
  // Most telling inside of a name: before a letter.
  std::size_t at = draws.below(text.size() + 1);
  while (at < text.size() && std::isalpha(static_cast<unsigned char>(text[at])) == 0) ++at;
  text.insert(at, bytes);
}

void lengthen_a_line(std::string& text, Draws& draws) {
  static constexpr std::array<std::size_t, 3> kLengths{300, 10'000, 1'000'000};
  const std::size_t length = draws.of(kLengths);
  static constexpr std::string_view kFillers = "a0 9,[\"\t";
  text.insert(draws.below(text.size() + 1), length, draws.of(kFillers));
}

void change_line_ends(std::string& text, Draws& draws) {
  static constexpr std::array<const char*, 4> kEnds{"\r\n", "\r", " ", ""};
  const std::string_view end = draws.of(kEnds);
  std::string out;
  for (const char c : text) {
    if (c == '\n')
      out += end;
    else
      out += c;
  }
  text = std::move(out);
}

struct Kind {
  const char* name;
  void (*damage)(std::string&, Draws&);
  int weight;
};
constexpr std::array<Kind, 17> kKinds{{{"extreme number", put_extreme_number, 24},
                                       {"extreme bytes", put_extreme_bytes, 10},
                                       {"bits flipped", flip_bits, 8},
                                       {"bytes replaced", replace_bytes, 8},
                                       {"cut short", cut_short, 8},
                                       {"bytes inserted", insert_bytes, 4},
                                       {"block left out", leave_a_block_out, 6},
                                       {"block doubled", double_a_block, 5},
                                       {"line left out", leave_a_line_out, 5},
                                       {"line doubled", double_a_line, 5},
                                       {"line moved", move_a_line, 4},
                                       {"string copied", copy_a_string, 4},
                                       {"numbers exchanged", exchange_numbers, 4},
                                       {"nested", nest, 4},
                                       {"no text", put_bytes_that_are_no_text, 4},
                                       {"line lengthened", lengthen_a_line, 2},
                                       {"other line ends", change_line_ends, 1}}};

const Kind& some_kind(Draws& draws) {
  int sum = 0;
  for (const Kind& kind : kKinds) sum += kind.weight;
  auto at = static_cast<int>(draws.below(static_cast<std::size_t>(sum)));
  const Kind* kind = kKinds.data();
  while (at >= kind->weight) at -= kind++->weight;
  return *kind;
}

/// Damage of the whole file that is the same for every format.
Damaged whole_file(const std::vector<std::string>& seeds, std::uint64_t variant) {
  const std::string& seed = seeds.front();
  switch (variant) {
    case 0:
      return {0, "", "empty"};
    case 1:
      return {0, std::string(1, '\0'), "one byte 0"};
    case 2:
      return {0, "\n", "one line end"};
    case 3:
      return {0, std::string(100'000, '['), "brackets"};
    case 4:
      return {0, std::string(1'000'000, 'a'), "one long line"};
    case 5:
      return {0, std::string(65'536, '\0'), "zeros"};
    case 6:
      return {0, seed.substr(0, seed.size() / 2), "half"};
    case 7:
      return {0, seed + seed, "twice"};
    case 8:
      return {0, seed.substr(seed.size() / 2), "second half"};
    default:
      return {0, "\xff\xfe" + seed, "byte order mark of UTF-16"};
  }
}

}  // namespace

Damaged damage(const std::vector<std::string>& seeds, std::string_view format, std::uint64_t variant) {
  if (variant < kWholeFileVariants) return whole_file(seeds, variant);
  Draws draws(format, variant);
  Damaged out;
  out.seed = draws.below(seeds.size());
  out.bytes = seeds[out.seed];
  if (draws.one_in(20)) {  // a file that goes on as another one
    const std::string& other = draws.of(seeds);
    out.bytes.resize(draws.below(out.bytes.size() + 1));
    out.bytes += other.substr(draws.below(other.size() + 1));
    out.how = "spliced";
  }
  const std::size_t kinds = draws.one_in(3) ? 2 + draws.below(2) : 1;
  for (std::size_t n = 0; n < kinds; ++n) {
    const Kind& kind = some_kind(draws);
    kind.damage(out.bytes, draws);
    out.how += (out.how.empty() ? "" : ", ") + std::string(kind.name);
  }
  return out;
}

}  // namespace canyon::testing
