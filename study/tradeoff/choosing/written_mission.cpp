#include <filesystem>
#include <map>

#include "canyon/core/files/files.h"
#include "canyon/study/tradeoff/choosing/choose.h"
#include "canyon/study/tradeoff/ladders/rungs.h"

namespace canyon::study {
namespace {

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

}  // namespace

Result<std::string> mission_with(const Chosen& chosen, const std::string& fidelity, const std::string& path,
                                 const std::string& written_to) {
  std::string text = std::string("base = \"") + mission::kDefaultMission + "\"\n";
  if (!path.empty()) {
    CANYON_TRY_STATUS(check_folder(path, written_to));
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
  return text;
}

}  // namespace canyon::study
