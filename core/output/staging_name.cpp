#include "canyon/core/output/staging_name.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

#include <unistd.h>

#include "canyon/core/files/files.h"

namespace canyon {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPartial = "partial";
constexpr std::size_t kLongestName = 255;  // bytes, on every file system in use

/// Boot and process namespace as 16 hexadecimal digits: process numbers can be compared only where these agree. Two
/// containers of one machine share the boot, but not the numbers. Empty where the system does not say.
const std::string& realm() {
  static const std::string value = [] {
    std::ifstream in("/proc/sys/kernel/random/boot_id");
    const std::string boot(std::istreambuf_iterator<char>(in), {});
    std::string spaces;
    for (const char* space : {"/proc/self/ns/pid", "/proc/self/ns/time"}) {
      std::error_code code;
      const fs::path link = fs::read_symlink(space, code);
      if (code && space == std::string("/proc/self/ns/pid")) return std::string();
      spaces += link.string() + "\n";  // kernels before 5.6 have one time for all
    }
    return boot.empty() ? std::string() : sha256_hex(boot + spaces).substr(0, 16);
  }();
  return value;
}

/// When a process started, in clock ticks since the boot; nullopt if that cannot be seen.
std::optional<std::uint64_t> start_of(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  const std::string stat(std::istreambuf_iterator<char>(in), {});
  // The second field is the program's name in brackets, which may hold blanks and brackets; the start is the 22nd.
  std::size_t at = stat.rfind(')');
  for (int field = 2; field < 22 && at != std::string::npos; ++field) at = stat.find(' ', at + 1);
  if (at == std::string::npos) return std::nullopt;
  std::uint64_t ticks = 0;
  const auto [end, status] = std::from_chars(stat.data() + at + 1, stat.data() + stat.size(), ticks);
  return status == std::errc{} ? std::optional(ticks) : std::nullopt;
}

std::string host() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "host";
  std::string out(name.data());
  for (char& c : out)
    if (c == '/' || c == '-') c = '_';
  return out.substr(0, 32);
}

/// Who made a name: its last four parts but the count.
struct Maker {
  std::string realm;
  pid_t pid = 0;
  std::uint64_t start = 0;
};

template <class T>
bool whole(const std::string& text, T& value) {
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && status == std::errc{} && end == text.data() + text.size();
}

/// HOST-REALM-PID-START-N behind the role.
std::optional<Maker> maker_of(const std::string& behind_role) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= behind_role.size();) {
    const std::size_t end = std::min(behind_role.find('-', begin), behind_role.size());
    parts.push_back(behind_role.substr(begin, end - begin));
    begin = end + 1;
  }
  Maker maker;
  std::uint64_t count = 0;
  if (parts.size() != 5 || parts[1].size() != 16 || !whole(parts[2], maker.pid) || !whole(parts[3], maker.start) ||
      !whole(parts[4], count))
    return std::nullopt;
  maker.realm = parts[1];
  return maker;
}

/// Of a name `.NAME.ROLE-…`: NAME, and what follows the role's hyphen.
struct Parts {
  std::string name, behind_role;
};
std::optional<Parts> parts_of(const std::string& name, const char* role) {
  const std::string mark = std::string(".") + role + "-";
  const std::size_t at = name.rfind(mark);
  if (name.empty() || name[0] != '.' || at == std::string::npos || at == 0) return std::nullopt;
  return Parts{name.substr(1, at - 1), name.substr(at + mark.size())};
}

bool is_gone(const Maker& maker) {
  if (realm().empty() || maker.realm != realm() || maker.pid <= 0) return false;
  // A process that exists but may not be signalled gives EPERM.
  if (kill(maker.pid, 0) != 0) return errno == ESRCH;
  const auto start = start_of(maker.pid);
  return start && *start != maker.start;
}

bool is_stale(const std::string& name, const char* role) {
  const auto parts = parts_of(name, role);
  if (!parts) return false;
  const auto maker = maker_of(parts->behind_role);
  return maker && is_gone(*maker);
}

}  // namespace

fs::path staging_name(const fs::path& path, const char* role) {
  static std::atomic<std::uint64_t> count{0};
  const std::string who = std::string(".") + role + "-" + host() + "-" +
                          (realm().empty() ? std::string(16, '0') : realm()) + "-" + std::to_string(getpid()) + "-" +
                          std::to_string(start_of(getpid()).value_or(0)) + "-" + std::to_string(++count);
  std::string name = path.filename().string();
  if (1 + name.size() + who.size() > kLongestName) name.resize(kLongestName - 1 - who.size());
  return path.parent_path() / ("." + name + who);
}

bool is_stale_staging_name(const std::string& name) {
  return is_stale(name, kPartial);
}

void remove_stale_stagings(const fs::path& folder) {
  std::error_code code;
  std::vector<fs::path> stale;
  for (fs::directory_iterator it(folder.empty() ? "." : folder, code), end; !code && it != end; it.increment(code)) {
    const std::string name = it->path().filename().string();
    if (name.empty() || name[0] != '.') continue;
    if (is_stale(name, kPartial)) stale.push_back(it->path());
    // The only copy of what was about to be replaced is never removed.
    const auto parts = parts_of(name, "replaced");
    std::error_code ignored;
    if (parts && is_stale(name, "replaced") &&
        fs::exists(fs::symlink_status(it->path().parent_path() / parts->name, ignored)))
      stale.push_back(it->path());
  }
  for (const fs::path& path : stale) fs::remove_all(path, code);
}

}  // namespace canyon
