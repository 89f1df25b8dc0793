#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

/// The files that canyon reads, one row for each format.
namespace canyon::testing {

/// A small valid file.
struct Seed {
  std::string name;  ///< of the file, which the format's command reads; the ending counts
  std::string bytes;
  bool fits = true;  ///< to its companions, so that the command succeeds; false: of another day or place
};

/// A file that stands beside the damaged one, whole.
using Companion = Seed;

struct Format {
  std::string name;
  /// Canyon's arguments, in the folder of the files; "@" stands for the damaged one. Empty: `read` reads it instead.
  std::vector<std::string> command;
  /// For what no verb reads: 0 = read, 2 = an error, told in one line on stderr. Argument: the damaged file.
  std::function<int(const std::string& path)> read;
  /// Made when the format's turn comes: they may be written by canyon itself, or cut out of a real recording.
  std::function<std::vector<Seed>()> seeds;
  std::function<std::vector<Companion>()> beside = [] { return std::vector<Companion>(); };
};

/// For gtest's messages.
inline void PrintTo(const Format& format, std::ostream* out) {
  *out << format.name;
}

/// All of them: what a reader of a new format must be added to.
const std::vector<Format>& formats();

/// Rows by subject.
std::vector<Format> gnss_formats();
std::vector<Format> inertial_formats();
std::vector<Format> lidar_formats();
std::vector<Format> scene_formats();
std::vector<Format> elevation_formats();
std::vector<Format> mission_formats();
std::vector<Format> report_formats();

/// Both, in this order.
std::vector<Seed> with(std::vector<Seed> seeds, std::vector<Seed> more);

/// Files that `body` writes into its working folder, by their names. It runs in a process of its own, so that this one
/// stays without threads. Throws if it does not return 0.
std::vector<Seed> written_by(const std::function<int()>& body, const std::vector<std::string>& names,
                             const std::vector<Companion>& beside = {});
/// The same of a command of canyon.
std::vector<Seed> written_by_canyon(const std::vector<std::string>& command, const std::vector<std::string>& names,
                                    const std::vector<Companion>& beside = {});

/// Lines of a file of the shared real recordings, unpacked if it is gzip, named `name`; none if the recordings are not
/// there.
std::vector<Seed> excerpt(const std::string& recording, const std::string& name, int lines, int from_line = 1);

}  // namespace canyon::testing
