#include "canyon/tests/mutation/format.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "canyon/apps/line/command_line.h"
#include "canyon/core/check.h"
#include "canyon/core/files/files.h"
#include "canyon/core/process/child_process.h"
#include "canyon/tests/report/temporary_directory.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::testing {

const std::vector<Format>& formats() {
  static const std::vector<Format> all = [] {
    std::vector<Format> out;
    for (const auto& rows : {gnss_formats(), inertial_formats(), lidar_formats(), scene_formats(), elevation_formats(),
                             mission_formats(), report_formats()})
      out.insert(out.end(), rows.begin(), rows.end());
    return out;
  }();
  return all;
}

std::vector<Seed> with(std::vector<Seed> seeds, std::vector<Seed> more) {
  seeds.insert(seeds.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  return seeds;
}

std::vector<Seed> written_by(const std::function<int()>& body, const std::vector<std::string>& names,
                             const std::vector<Companion>& beside) {
  const TemporaryDirectory scratch;
  const std::filesystem::path files = scratch.file("files");
  std::filesystem::create_directories(files);
  for (const Companion& file : beside) std::ofstream(files / file.name, std::ios::binary) << file.bytes;
  start_child(body, files, scratch.file("out"), scratch.file("err"), {});
  const ChildEnd end = wait_for_a_child().second;
  const auto text = [](const std::filesystem::path& file) {
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
  };
  CANYON_CHECK(end.exit_status == 0, "files = ", names.front(), " ..., stderr = ", text(scratch.file("err")));
  std::vector<Seed> out;
  for (const std::string& name : names) {
    out.push_back({std::filesystem::path(name).filename().string(), text(files / name)});
    CANYON_CHECK(!out.back().bytes.empty(), "file = ", name);
  }
  return out;
}

std::vector<Seed> written_by_canyon(const std::vector<std::string>& command, const std::vector<std::string>& names,
                                    const std::vector<Companion>& beside) {
  std::vector<std::string> arguments{"canyon"};
  arguments.insert(arguments.end(), command.begin(), command.end());
  arguments.insert(arguments.end(), {"--threads", "1"});
  const auto body = [&] {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    return apps::run_command_line(static_cast<int>(argv.size()), argv.data(), "");
  };
  return written_by(body, names, beside);
}

std::vector<Seed> excerpt(const std::string& recording, const std::string& name, int lines, int from_line) {
  const std::string path = data_file(recording);
  if (path.empty()) return {};
  const auto text = read_text_or_gzip_file(path);
  CANYON_CHECK(text.ok(), "recording = ", recording);
  std::istringstream in(*text);
  std::string out, line;
  for (int k = 1; k < from_line + lines && std::getline(in, line); ++k)
    if (k >= from_line) out += line + "\n";
  return {{name, out, false}};
}

}  // namespace canyon::testing
