#pragma once

#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace canyon::gnss {

/// A straightforward Hatanaka compression, written from the published format and sharing nothing with the decoder:
/// third-order differences, every satellite that was absent in the epoch before begins anew.
class HatanakaCompressor {
 public:
  explicit HatanakaCompressor(bool modern) : modern_(modern) {}

  std::string compress(const std::string& rinex, const std::string& two_lines) {
    std::istringstream in(rinex);
    std::string line;
    out_ = two_lines;
    while (std::getline(in, line)) {
      out_ += line + "\n";
      note_types(line);
      if (line.size() >= 73 && line.substr(60, 13) == "END OF HEADER") break;
    }
    while (std::getline(in, line)) epoch(in, line);
    return out_;
  }

 private:
  struct State {
    std::vector<std::vector<long long>> arcs;  // all earlier values of the arc, newest last
    std::string flags;
  };

  static std::string trimmed(std::string s) {
    while (!s.empty() && s.back() == ' ') s.pop_back();
    return s;
  }
  static std::string padded(std::string s, std::size_t n) {
    if (s.size() < n) s.resize(n, ' ');
    return s;
  }

  void note_types(const std::string& line) {
    const std::string label = padded(line, 80).substr(60, 20);
    if (label.rfind("SYS / # / OBS TYPES", 0) == 0 && line[0] != ' ') types_[line[0]] = std::stoul(line.substr(1, 5));
    if (label.rfind("# / TYPES OF OBSERV", 0) == 0 && !trimmed(line.substr(0, 6)).empty())
      for (char c = 'A'; c <= 'Z'; ++c) types_[c] = std::stoul(line.substr(0, 6));
  }

  /// Characters that changed; blank = unchanged, & = became blank.
  static std::string difference(const std::string& before, const std::string& now) {
    std::string out;
    for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
      const char b = i < before.size() ? before[i] : '\0', n = i < now.size() ? now[i] : ' ';
      out += b == n ? ' ' : (n == ' ' ? '&' : n);
    }
    return trimmed(out);
  }

  void epoch(std::istringstream& in, std::string line) {
    const std::size_t flag_at = modern_ ? 31 : 28;
    const std::string head = padded(line, 80);
    const std::size_t number = std::stoul(head.substr(flag_at + 1, 3));
    if (head[flag_at] > '1') {
      if (!modern_) line[0] = '&';
      out_ += line + "\n";
      for (std::size_t i = 0; i < number; ++i) {
        std::getline(in, line);
        out_ += line + "\n";
        note_types(line);
      }
      states_.clear();
      before_.clear();
      return;
    }
    std::string names;
    std::vector<std::string> records;
    std::string clock = trimmed(modern_ ? head.substr(41) : head.substr(68, 12));
    if (modern_) {
      for (std::size_t i = 0; i < number; ++i) {
        std::getline(in, line);
        names += line.substr(0, 3);
        records.push_back(line.substr(3));
      }
    } else {
      names = head.substr(32, 36);
      for (std::size_t i = 12; i < number; i += 12) {
        std::getline(in, line);
        names += padded(line, 68).substr(32, 36);
      }
      names = padded(names, 3 * number).substr(0, 3 * number);
      for (std::size_t i = 0; i < number; ++i) {
        std::string record;
        for (std::size_t k = 0; k < types_['G']; k += 5) {
          std::getline(in, line);
          record += padded(line, 80);
        }
        records.push_back(record);
      }
    }
    std::string now = modern_ ? padded(head.substr(0, 35), 41) + names : head.substr(0, 32) + names;
    if (before_.empty()) {
      out_ += modern_ ? now : "&" + now.substr(1);
      clock_arc_.clear();
    } else {
      out_ += difference(before_, now);
    }
    out_ += "\n";
    before_ = now;
    out_ += (clock.empty() ? (clock_arc_.clear(), std::string()) : send(clock_arc_, thousandths(clock))) + "\n";

    std::map<std::string, State> next;
    for (std::size_t i = 0; i < number; ++i) {
      const std::string name = names.substr(3 * i, 3);
      const std::size_t types = types_[name[0] == ' ' ? 'G' : name[0]];
      State s = states_.count(name) != 0 ? states_[name] : State{};
      s.arcs.resize(types);
      const std::string record = padded(records[i], 16 * types);
      std::string sent, flags;
      for (std::size_t k = 0; k < types; ++k) {
        const std::string value = trimmed(record.substr(16 * k, 14));
        if (value.empty())
          s.arcs[k].clear();
        else
          sent += send(s.arcs[k], thousandths(value));
        sent += " ";
        flags += record.substr(16 * k + 14, 2);
      }
      out_ += trimmed(sent + difference(s.flags, flags)) + "\n";
      s.flags = flags;
      next[name] = s;
    }
    states_ = next;
  }

  static long long thousandths(const std::string& text) {
    std::string digits;
    for (const char c : text)
      if (c != '.' && c != ' ') digits += c;
    return std::stoll(digits);
  }

  static std::string send(std::vector<long long>& arc, long long value) {
    arc.push_back(value);
    const std::size_t n = arc.size();
    if (n == 1) return "3&" + std::to_string(value);
    std::vector<long long> d(arc.end() - static_cast<std::ptrdiff_t>(std::min<std::size_t>(n, 4)), arc.end());
    while (d.size() > 1) {
      for (std::size_t i = 0; i + 1 < d.size(); ++i) d[i] = d[i + 1] - d[i];
      d.pop_back();
    }
    if (n > 4) arc.erase(arc.begin());
    return std::to_string(d[0]);
  }

  bool modern_;
  std::string out_, before_;
  std::map<char, std::size_t> types_;
  std::map<std::string, State> states_;
  std::vector<long long> clock_arc_;
};

}  // namespace canyon::gnss
