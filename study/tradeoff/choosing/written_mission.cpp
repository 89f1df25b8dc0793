#include <filesystem>
#include <map>

#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/study/tradeoff/choosing/choose.h"
#include "canyon/study/tradeoff/choosing/movable_keys.h"
#include "canyon/study/tradeoff/ladders/rungs.h"

namespace canyon::study {
namespace {

constexpr const char* kWrittenFidelity = "tradeoff";

/// A value as TOML writes it.
std::string toml_value(const std::string& text) {
  const ConfigNode node = setting_node(text);
  return std::holds_alternative<std::string>(node.value_) ? "\"" + text + "\"" : text;
}

Status check_folder(const std::string& mission, const std::string& written_to) {
  namespace fs = std::filesystem;
  std::error_code code;
  const fs::path from = fs::weakly_canonical(fs::absolute(mission).parent_path(), code);
  const fs::path to = fs::weakly_canonical(fs::absolute(written_to).parent_path(), code);
  if (from == to) return Ok{};
  return Error{.file = "--write",
               .what = written_to + " lies in another folder than " + mission + ", where its relative paths begin",
               .expected = "a file in " + from.string()};
}

/// What was written must be what is read.
Status check_read_back(const std::string& text, const Chosen& chosen, const std::string& written_to) {
  CANYON_TRY(const auto file, mission::MissionFile::parse(text, written_to));
  CANYON_TRY(mission::MissionConfig config, file.resolve(kWrittenFidelity));
  CANYON_TRY(mission::MissionConfig asked, with_settings(file, kWrittenFidelity, chosen.settings));
  const auto keys = [](mission::MissionConfig& c) { return fields_as_json([&c](FieldVisitor& f) { visit(f, c); }); };
  if (keys(config) == keys(asked)) return Ok{};
  return Error{.file = written_to, .what = "would not be read back as the settings that were chosen", .exit_code = 1};
}

}  // namespace

Status check_writable(const std::string& path, const mission::MissionFile& file, const std::string& written_to) {
  if (!mission::is_built_in(path)) CANYON_TRY_STATUS(check_folder(path, written_to));
  for (const std::string& name : file.fidelities())
    if (name == kWrittenFidelity)
      return Error{.file = "--write",
                   .what = path + " has a fidelity \"" + name + "\" already",
                   .expected = "a mission file without [fidelity." + name + "]"};
  return Ok{};
}

Result<std::string> mission_with(const Chosen& chosen, const std::string& fidelity, const std::string& path,
                                 const std::string& written_to) {
  std::string text = std::string("base = \"") + mission::kDefaultMission + "\"\n";
  if (!mission::is_built_in(path)) {
    CANYON_TRY(text, read_text_file(path));
  }
  if (!text.empty() && text.back() != '\n') text += '\n';
  text += "\n# The cheapest settings found by canyon tradeoff: canyon run FILE --fidelity tradeoff\n";
  text += "[fidelity.tradeoff]\nbase = \"" + fidelity + "\"\n";
  std::map<std::string, std::string> sections;
  for (const auto& [key, value] : chosen.settings) {
    const auto dot = key.rfind('.');
    sections[key.substr(0, dot)] += key.substr(dot + 1) + " = " + toml_value(value) + "\n";
  }
  for (const auto& [section, keys] : sections) text += "[fidelity.tradeoff." + section + "]\n" + keys;
  CANYON_TRY_STATUS(check_read_back(text, chosen, written_to));
  return text;
}

}  // namespace canyon::study
