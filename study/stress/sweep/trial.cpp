#include "canyon/study/stress/sweep/trial.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include <unistd.h>

#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"

namespace canyon::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResults = "results";

std::vector<std::string> command_line(const TrialSetup& setup, const Settings& settings) {
  std::vector<std::string> words{setup.program, "run"};
  if (!setup.mission.empty()) words.push_back(setup.mission);
  words.insert(words.end(), {"--fidelity", setup.fidelity, "--out", kResults, "--json", "--threads", "1"});
  bool limited = false;
  for (const auto& [key, value] : settings) {
    words.insert(words.end(), {"--set", key + "=" + value});
    limited = limited || key == "time.limit_s";
  }
  if (!limited) words.insert(words.end(), {"--set", "time.limit_s=" + number_text(setup.simulated_s)});
  return words;
}

int execute(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  return 4;
}

/// The lines of stderr that are no warnings.
std::vector<std::string> error_lines(const std::string& err) {
  std::vector<std::string> lines;
  std::istringstream in(err);
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with("warning: ") && !line.starts_with("note: ")) lines.push_back(line);
  return lines;
}

std::string quoted(const std::string& text) {
  return "\"" + text.substr(0, 300) + (text.size() > 300 ? "...\"" : "\"");
}

/// Whether a file of results holds nan or inf as a word of its own.
bool holds_no_number(const std::string& text) {
  for (const std::string word : {"nan", "inf", "NaN", "Infinity"}) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      const auto apart = [&text](std::size_t i) {
        return i >= text.size() || (std::isalnum(static_cast<unsigned char>(text[i])) == 0 && text[i] != '_');
      };
      if ((at == 0 || apart(at - 1)) && apart(at + word.size())) return true;
    }
  }
  return false;
}

/// Estimates and truth are numbers in every row: a field that is empty there stands for one that is not finite.
bool has_holes(const std::string& nav_csv) {
  return nav_csv.find(",,") != std::string::npos;
}

std::string wrong_results(const fs::path& folder, const std::string& fidelity) {
  const fs::path results = folder / kResults;
  for (const auto& entry : fs::recursive_directory_iterator(results)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".csv" && extension != ".json") continue;
    const auto text = read_text_file(entry.path().string());
    if (!text) return "cannot be read: " + text.error().str();
    if (holds_no_number(*text)) return "a number that is not finite in " + entry.path().filename().string();
  }
  const auto nav = read_text_file((results / "epochs" / (fidelity + "_nav.csv")).string());
  if (!nav) return "no estimates: " + nav.error().str();
  if (has_holes(*nav)) return "an estimate that is not finite in " + fidelity + "_nav.csv";
  return "";
}

/// What lies in the folder beside the results and what was printed.
std::string left_behind(const fs::path& folder, bool with_results) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != "out" && name != "err" && !(with_results && name == kResults)) return "left behind: " + name;
  }
  return "";
}

std::string wrong_refusal(const std::string& err) {
  const auto lines = error_lines(err);
  if (lines.size() != 1) return "an error of " + std::to_string(lines.size()) + " lines: " + quoted(err);
  for (const char* words : {"check failed", "internal error", "terminate called"})
    if (lines[0].find(words) != std::string::npos) return "an internal error: " + quoted(lines[0]);
  if (lines[0].find("expected") == std::string::npos) return "does not say what was expected: " + quoted(lines[0]);
  return "";
}

}  // namespace

pid_t start_trial(const TrialSetup& setup, const Settings& settings, const fs::path& folder) {
  fs::create_directories(folder);
  const auto words = command_line(setup, settings);
  return start_child([&words] { return execute(words); }, folder, folder / "out", folder / "err", setup.limits);
}

TrialEnd judge_trial(const TrialSetup& setup, const ChildEnd& end, const fs::path& folder) {
  const auto printed = read_text_file((folder / "err").string());
  const std::string err = printed ? *printed : "";
  TrialEnd out{.refused = end.exit_status == 2, .what = breach(end, setup.limits)};
  if (!out.what.empty()) return out;
  if (end.exit_status != 0 && end.exit_status != 2)
    out.what = "exit status " + std::to_string(end.exit_status) + ": " + quoted(err);
  else if (end.exit_status == 2)
    out.what = wrong_refusal(err);
  else
    out.what = wrong_results(folder, setup.fidelity);
  if (out.what.empty()) out.what = left_behind(folder, end.exit_status == 0);
  return out;
}

}  // namespace canyon::study
