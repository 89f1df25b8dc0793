#include "canyon/core/process/library_part.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace canyon {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInstalled =
#include "embedded/part_folder.inc"
    ;
constexpr const char* kBuilt = "../lib/canyon";

std::vector<fs::path> folders() {
  if (const char* named = std::getenv("CANYON_PART_DIR"); named != nullptr && *named != '\0') return {named};
  std::error_code unreadable;
  const fs::path programs = fs::read_symlink("/proc/self/exe", unreadable).parent_path();
  std::vector<fs::path> out{(programs / kInstalled).lexically_normal()};
  if (const fs::path built = (programs / kBuilt).lexically_normal(); built != out.front()) out.push_back(built);
  return out;
}

}  // namespace

const void* open_library_part(const std::string& name) {
  const std::string file = "libcanyon_" + name + ".so";
  std::string looked_at;
  for (const fs::path& folder : folders()) {
    const fs::path path = folder / file;
    if (!fs::exists(path)) {
      looked_at += (looked_at.empty() ? "" : ", ") + folder.string();
      continue;
    }
    void* const opened = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (opened == nullptr) throw std::runtime_error(std::string("cannot open ") + dlerror());
    const std::string table = "canyon_" + name + "_part";
    if (const void* part = dlsym(opened, table.c_str())) return part;
    throw std::runtime_error(path.string() + " is no part of Canyon: it has no " + table);
  }
  throw std::runtime_error(file + " is missing; it is looked for in " + looked_at + " (or in CANYON_PART_DIR)");
}

}  // namespace canyon
