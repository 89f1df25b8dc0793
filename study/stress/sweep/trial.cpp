#include "canyon/study/stress/sweep/trial.h"

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>
#include <string_view>

#include <unistd.h>

#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/study/stress/sweep/finite_results.h"

namespace canyon::study {
namespace {

namespace fs = std::filesystem;

constexpr const char *kResults = "results", *kTemporary = "tmp";

/// The simulated time, or a swept limit that is shorter.
double shortest(const TrialSetup& setup, const Settings& settings) {
  double limit_s = setup.simulated_s;
  for (const auto& [key, value] : settings)
    if (const double swept_s = std::strtod(value.c_str(), nullptr); key == "time.limit_s" && swept_s > 0.0)
      limit_s = std::min(limit_s, swept_s);
  return limit_s;
}

std::vector<std::string> command_line(const TrialSetup& setup, const Settings& settings) {
  std::vector<std::string> words{setup.program, "run", setup.mission};
  words.insert(words.end(), {"--fidelity", setup.fidelity, "--out", kResults, "--json", "--threads", "1"});
  for (const auto& [key, value] : settings) words.insert(words.end(), {"--set", key + "=" + value});
  // The last one counts: a limit that is tried is read, but no trial is longer than the others.
  words.insert(words.end(), {"--set", "time.limit_s=" + number_text(shortest(setup, settings))});
  return words;
}

/// The variables of this process, but for the folder of temporary files.
std::vector<std::string> environment(const fs::path& temporary) {
  std::vector<std::string> variables{"TMPDIR=" + temporary.string()};
  for (char** at = environ; *at != nullptr; ++at)
    if (!std::string_view(*at).starts_with("TMPDIR=")) variables.emplace_back(*at);
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> out;
  for (std::string& word : words) out.push_back(word.data());
  out.push_back(nullptr);
  return out;
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

/// What is wrong with results and what was printed of them.
std::string wrong_results(const fs::path& folder) {
  const auto wrong = not_finite_in_results(folder / kResults);
  if (!wrong.empty()) return wrong;
  const auto printed = read_text_file((folder / "out").string());
  if (!printed) return printed.error().str();
  const auto wrong_print = not_finite_in_json(*printed, "summary.json");
  return wrong_print.empty() ? "" : "printed: " + wrong_print;
}

/// The first entry of the folder that is none of these; "" if there is none.
std::string other_than(const fs::path& folder, const std::vector<std::string>& expected) {
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code))
    if (std::ranges::find(expected, at->path().filename().string()) == expected.end())
      return at->path().filename().string();
  return code ? "a folder that cannot be read (" + code.message() + ")" : "";
}

/// What lies in the folder beside the results and what was printed, and among the temporary files.
std::string left_behind(const fs::path& folder, bool with_results) {
  const std::string beside =
      other_than(folder, with_results ? std::vector<std::string>{"out", "err", kTemporary, kResults}
                                      : std::vector<std::string>{"out", "err", kTemporary});
  if (!beside.empty()) return "left behind: " + beside;
  const std::string temporary = other_than(folder / kTemporary, {});
  return temporary.empty() ? "" : "left behind in TMPDIR: " + temporary;
}

/// Whether a line begins with "FILE:LINE: ", or has a key of the settings in it.
bool names_the_place(const std::string& line, const Settings& settings) {
  static const std::regex file_and_line("^[^ ]+:[0-9]+: ");
  const bool of_a_file = std::regex_search(line, file_and_line) && !line.starts_with("--set:");
  return of_a_file || std::ranges::any_of(settings, [&](const auto& one) { return line.find(one.first) != line.npos; });
}

std::string wrong_refusal(const std::string& err, const Settings& settings) {
  const auto lines = error_lines(err);
  if (lines.size() != 1) return "an error of " + std::to_string(lines.size()) + " lines: " + quoted(err);
  for (const char* words : {"check failed", "internal error", "terminate called"})
    if (lines[0].find(words) != std::string::npos) return "an internal error: " + quoted(lines[0]);
  if (lines[0].find("expected") == std::string::npos) return "does not say what was expected: " + quoted(lines[0]);
  if (!names_the_place(lines[0], settings)) return "names neither a key that was set nor a line: " + quoted(lines[0]);
  return "";
}

}  // namespace

Result<ProcessId> start_trial(const TrialSetup& setup, const Settings& settings, const fs::path& folder) {
  for (const fs::path& made : {folder, folder / kTemporary}) {
    std::error_code code;  // not its parents: an interruption may just have taken them away
    if (!fs::create_directory(made, code))
      return Error{.file = made.string(), .what = "cannot be made (" + code.message() + ")", .expected = "a folder"};
  }
  auto words = command_line(setup, settings), variables = environment(folder / kTemporary);
  const auto arguments = pointers(words), with = pointers(variables);
  const auto execute = [&] {
    execve(arguments[0], arguments.data(), with.data());
    return 4;
  };
  return start_child(execute, folder, folder / "out", folder / "err", setup.limits);
}

TrialEnd judge_trial(const TrialSetup& setup, const Settings& settings, const ChildEnd& end, const fs::path& folder) {
  const auto printed = read_text_file((folder / "err").string());
  const std::string err = printed ? *printed : "";
  TrialEnd out{.refused = false, .what = breach(end, setup.limits), .said = err, .cpu_s = end.cpu_s};
  if (!out.what.empty()) return out;
  if (end.exit_status != 0 && end.exit_status != 2)
    out.what = "exit status " + std::to_string(end.exit_status) + ": " + quoted(err);
  else if (end.exit_status == 2)
    out.what = wrong_refusal(err, settings);
  else
    out.what = wrong_results(folder);
  if (out.what.empty()) out.what = left_behind(folder, end.exit_status == 0);
  out.refused = end.exit_status == 2 && out.what.empty();
  return out;
}

}  // namespace canyon::study
