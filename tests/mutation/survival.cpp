#include "canyon/tests/mutation/survival.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/command_line.h"
#include "canyon/core/check.h"
#include "canyon/tests/mutation/damage.h"
#include "canyon/tests/report/temporary_directory.h"

namespace canyon::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSideBySide = 2, kMostFindings = 20;

void store_bytes(const fs::path& file, const std::string& bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  out.close();
  CANYON_CHECK(out.good(), "file = ", file.string());
}

std::string load_bytes(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// What is run: the command with the file's name in it.
std::vector<std::string> arguments_of(const Format& format, const std::string& file, bool json) {
  std::vector<std::string> out{"canyon"};
  for (const std::string& argument : format.command) out.push_back(argument == "@" ? file : argument);
  out.insert(out.end(), {"--threads", "1"});
  if (json) out.emplace_back("--json");
  return out;
}

/// Every other time.
bool has_json(const Format& format, std::uint64_t variant) {
  return !format.command.empty() && variant % 2 == 1;
}

int run_in_this_process(const Format& format, const std::string& file, bool json) {
  if (format.command.empty()) return format.read(file);
  std::vector<std::string> arguments = arguments_of(format, file, json);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return apps::run_command_line(static_cast<int>(argv.size()), argv.data(), "");
}

bool is_utf8_without_controls(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x20 || c == 0x7f) return false;
    const std::size_t length = c < 0x80 ? 1 : c >= 0xf0 ? 4 : c >= 0xe0 ? 3 : c >= 0xc2 ? 2 : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (std::size_t k = 1; k < length; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    i += length;
  }
  return true;
}

/// The lines of stderr that are no warnings, notes of progress, or messages of libraries' own beginnings.
std::vector<std::string> error_lines(const std::string& err) {
  std::vector<std::string> out;
  std::istringstream in(err);
  for (std::string line; std::getline(in, line);)
    if (line.rfind("warning: ", 0) != 0 && line.rfind("note: ", 0) != 0) out.push_back(line);
  return out;
}

constexpr std::size_t kLongestMessage = 1500;

std::string quoted(const std::string& text) {
  return "\"" + text.substr(0, 400) + (text.size() > 400 ? "...\"" : "\"");
}

/// What is wrong with an end, empty if nothing is.
std::string wrong(const ChildEnd& end, const ChildLimits& limits, bool json, bool left_something, bool must_succeed) {
  if (const std::string what = breach(end, limits); !what.empty()) return what + "; stderr: " + quoted(end.err);
  if (end.exit_status != 0 && end.exit_status != 2)
    return "exit status " + std::to_string(end.exit_status) + ": " + quoted(end.err);
  if (must_succeed && end.exit_status != 0) return "is not read: " + quoted(end.err);
  if (end.exit_status == 0) {
    if (json && !nlohmann::json::accept(end.out)) return "--json wrote no JSON: " + quoted(end.out);
    return "";
  }
  if (left_something) return "an error, and files left behind; stderr: " + quoted(end.err);
  const auto lines = error_lines(end.err);
  if (lines.size() != 1) return "an error of " + std::to_string(lines.size()) + " lines: " + quoted(end.err);
  if (!is_utf8_without_controls(lines[0])) return "an error with bytes that are no text: " + quoted(lines[0]);
  if (lines[0].size() > kLongestMessage)
    return "an error of " + std::to_string(lines[0].size()) + " characters: " + quoted(lines[0]);
  if (!end.out.empty()) return "an error, and text on stdout: " + quoted(end.out);
  return "";
}

/// A folder in which one variant after the other is read.
class Bench {
 public:
  Bench(const fs::path& folder, const std::vector<Companion>& beside) : folder_(folder) {
    fs::create_directories(folder_ / "files");
    for (const Companion& file : beside) {
      store_bytes(folder_ / "files" / file.name, file.bytes);
      standing_.insert((folder_ / "files" / file.name).string());
      whole_[file.name] = file.bytes;
    }
  }

  void start(const Format& format, const std::string& name, const std::string& bytes, std::uint64_t variant, bool json,
             bool must_succeed, const ChildLimits& limits) {
    name_ = name, variant_ = variant, json_ = json, must_succeed_ = must_succeed;
    store_bytes(folder_ / "files" / name, bytes);
    child_ = start_child([&] { return run_in_this_process(format, name, json); }, folder_ / "files", folder_ / "out",
                         folder_ / "err", limits);
  }
  /// What was wrong with the one that has ended.
  std::string finish(ChildEnd end, const ChildLimits& limits) {
    end.out = load_bytes(folder_ / "out");
    end.err = load_bytes(folder_ / "err");
    const std::string damaged = (folder_ / "files" / name_).string();
    bool left_something = false;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "files")) {
      const std::string path = entry.path().string();
      if (!entry.is_regular_file() || path == damaged || standing_.count(path) != 0) continue;
      left_something = true;
      extra_.push_back(path);
    }
    for (const std::string& path : extra_) fs::remove(path);
    extra_.clear();
    if (standing_.count(damaged) != 0)
      store_bytes(damaged, whole_[name_]);
    else
      fs::remove(damaged);
    child_ = 0;
    return wrong(end, limits, json_, left_something, must_succeed_);
  }
  pid_t child() const { return child_; }
  std::uint64_t variant() const { return variant_; }

 private:
  fs::path folder_;
  std::set<std::string> standing_;
  std::map<std::string, std::string> whole_;
  std::vector<std::string> extra_;
  std::string name_;
  std::uint64_t variant_ = 0;
  bool json_ = false, must_succeed_ = false;
  pid_t child_ = 0;
};

struct File {
  std::string name, bytes, how;
  bool must_succeed;
};

/// Reads the file that `make` makes of each number, on all benches.
template <class Make>
std::vector<Finding> run_all(const Format& format, std::uint64_t first, std::uint64_t count, const ChildLimits& limits,
                             const Make& make) {
  const TemporaryDirectory scratch;
  const std::vector<Companion> beside = format.beside();
  std::vector<Bench> benches;
  for (std::size_t i = 0; i < kSideBySide; ++i)
    benches.emplace_back(fs::path(scratch.path()) / std::to_string(i), beside);
  std::vector<Finding> found;
  std::uint64_t next = first;
  std::size_t running = 0;
  const auto start_next = [&](Bench& bench) {
    if (next >= first + count || found.size() >= kMostFindings) return;
    const File file = make(next);
    bench.start(format, file.name, file.bytes, next, has_json(format, next), file.must_succeed, limits);
    ++next, ++running;
  };
  for (Bench& bench : benches) start_next(bench);
  while (running > 0) {
    const auto [child, end] = wait_for_a_child();
    const auto bench =
        std::find_if(benches.begin(), benches.end(), [child = child](const Bench& b) { return b.child() == child; });
    CANYON_CHECK(bench != benches.end(), "child = ", child);
    --running;
    const std::uint64_t variant = bench->variant();
    if (const std::string what = bench->finish(end, limits); !what.empty())
      found.push_back({variant, make(variant).how, what});
    start_next(*bench);
  }
  std::sort(found.begin(), found.end(), [](const Finding& a, const Finding& b) { return a.variant < b.variant; });
  return found;
}

struct SeedBytes {
  std::vector<Seed> seeds;
  std::vector<std::string> bytes;
  explicit SeedBytes(const Format& format) : seeds(format.seeds()) {
    CANYON_CHECK(!seeds.empty(), "format = ", format.name);
    for (const Seed& seed : seeds) bytes.push_back(seed.bytes);
  }
};

std::string shell_text(const std::vector<std::string>& arguments) {
  std::string out;
  for (const std::string& argument : arguments) {
    const bool plain = argument.find_first_of(" '\"[]*?&;") == std::string::npos;
    out += (out.empty() ? "" : " ") + (plain ? argument : "'" + argument + "'");
  }
  return out;
}

}  // namespace

std::vector<Finding> findings(const Format& format, std::uint64_t first, std::uint64_t count,
                              const ChildLimits& limits) {
  const SeedBytes seeds(format);
  return run_all(format, first, count, limits, [&](std::uint64_t variant) {
    Damaged damaged = damage(seeds.bytes, format.name, variant);
    return File{seeds.seeds[damaged.seed].name, std::move(damaged.bytes), std::move(damaged.how), false};
  });
}

std::vector<Finding> findings_of_seeds(const Format& format, const ChildLimits& limits) {
  const SeedBytes seeds(format);
  return run_all(format, 0, seeds.seeds.size(), limits, [&](std::uint64_t i) {
    const Seed& seed = seeds.seeds[i];
    return File{seed.name, seed.bytes, "undamaged " + seed.name, seed.fits};
  });
}

int reproduce(const Format& format, std::uint64_t variant, const std::string& folder) {
  const SeedBytes seeds(format);
  const Damaged damaged = damage(seeds.bytes, format.name, variant);
  const std::string& name = seeds.seeds[damaged.seed].name;
  const fs::path files = fs::path(folder) / "files";
  for (const Companion& file : format.beside()) store_bytes(files / file.name, file.bytes);
  store_bytes(files / name, damaged.bytes);
  const bool json = has_json(format, variant);
  std::printf("%s: %s\n", (files / name).c_str(), damaged.how.c_str());
  if (!format.command.empty())
    std::printf("cd %s && %s\n", files.c_str(), shell_text(arguments_of(format, name, json)).c_str());
  const ChildLimits limits;
  start_child([&] { return run_in_this_process(format, name, json); }, files, fs::path(folder) / "out",
              fs::path(folder) / "err", limits);
  auto [child, end] = wait_for_a_child();
  end.out = load_bytes(fs::path(folder) / "out");
  end.err = load_bytes(fs::path(folder) / "err");
  std::printf("exit status %d, signal %d, %.2f s, %.0f MB\n%s%s", end.exit_status, end.signal, end.cpu_s,
              1e-6 * static_cast<double>(end.peak_memory_bytes), end.out.substr(0, 2000).c_str(),
              end.err.substr(0, 2000).c_str());
  const std::string what = wrong(end, limits, json, false, false);
  std::printf("%s\n", what.empty() ? "nothing wrong" : what.c_str());
  return what.empty() ? 0 : 1;
}

}  // namespace canyon::testing
