#include "canyon/study/stress/sweep/sweep.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include <unistd.h>

#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/process/staging_litter.h"
#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

namespace fs = std::filesystem;

/// A folder for trials, gone with this, or with an interruption.
class Workshop {
 public:
  explicit Workshop(std::string folder) : folder_(std::move(folder)) { add_litter(folder_, {}); }
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    forget_litter(folder_);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  fs::path place(std::size_t trial) const { return fs::path(folder_) / std::to_string(trial); }

 private:
  std::string folder_;
};

Result<std::string> make_folder() {
  std::error_code code;
  const fs::path temporary = fs::temp_directory_path(code);
  std::string name = (temporary / "canyon-stress-XXXXXX").string();
  if (!code && mkdtemp(name.data()) != nullptr) return name;
  const std::string why = code ? code.message() : std::strerror(errno);
  return Error{.file = name, .what = "cannot be made (" + why + ")", .expected = "TMPDIR to be a writable folder"};
}

/// Trials that run at this moment.
class Running {
 public:
  ~Running() {
    for (const auto& [child, trial] : trials_) end_child(child);
  }
  std::size_t size() const { return trials_.size(); }
  void add(ProcessId child, std::size_t trial) { trials_[child] = trial; }
  std::size_t take(ProcessId child) {
    const std::size_t trial = trials_.at(child);
    trials_.erase(child);
    return trial;
  }

 private:
  std::map<ProcessId, std::size_t> trials_;
};

/// The wall time that is left.
class Budget {
 public:
  explicit Budget(std::optional<double> budget_s) : budget_s_(budget_s) {}
  double left_s() const {
    const double used_s = std::chrono::duration<double>(Clock::now() - started_).count();
    return budget_s_ ? *budget_s_ - used_s : std::numeric_limits<double>::infinity();
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::optional<double> budget_s_;
  Clock::time_point started_ = Clock::now();
};

/// Runs trials, by their numbers; 0 is the mission as it stands.
class Trials {
 public:
  Trials(TrialSetup setup, const std::vector<Settings>& settings, const Budget& budget, std::string folder)
      : setup_(std::move(setup)), settings_(settings), budget_(budget), workshop_(std::move(folder)) {}

  std::size_t running() const { return running_.size(); }
  /// As the mission as it stands has shown what setting up takes.
  void set_up_takes(double cpu_s) { setup_.limits.cpu_s = cpu_s + setup_.cpu_per_simulated_s * setup_.simulated_s; }

  Status start(std::size_t trial) {
    throw_if_cancelled();
    TrialSetup setup = setup_;
    setup.limits.wall_s = std::min(setup.limits.wall_s, std::max(1e-3, budget_.left_s()));
    CANYON_TRY(const ProcessId child, start_trial(setup, settings_[trial], workshop_.place(trial)));
    running_.add(child, trial);
    return Ok{};
  }
  /// Which one has ended, and how; nothing for one that the budget has cut off.
  std::pair<std::size_t, std::optional<TrialEnd>> wait() {
    const auto [child, end] = wait_for_a_child();
    throw_if_cancelled();
    const std::size_t trial = running_.take(child);
    std::optional<TrialEnd> out;
    if (end.signal != SIGALRM || budget_.left_s() > 0.0)
      out = judge_trial(setup_, settings_[trial], end, workshop_.place(trial));
    std::error_code ignored;
    fs::remove_all(workshop_.place(trial), ignored);
    return {trial, out};
  }

 private:
  TrialSetup setup_;
  const std::vector<Settings>& settings_;
  const Budget& budget_;
  Workshop workshop_;
  Running running_;  // ended before their folder goes
};

std::size_t drawn(const RandomStream& stream, std::uint64_t draw, std::size_t count) {
  const double u = stream.uniform(0.0, static_cast<double>(count), 0, draw);
  return std::min(static_cast<std::size_t>(u), count - 1);
}

void add_pairs(const std::vector<SweptKey>& keys, const SweepOptions& options, std::vector<Settings>& out) {
  if (keys.size() < 2) return;
  const RandomStream stream(options.seed, "stress.pairs");
  for (std::int64_t k = 0; k < options.pairs; ++k) {
    const auto draw = 4 * static_cast<std::uint64_t>(k);
    const std::size_t first = drawn(stream, draw, keys.size());
    std::size_t second = drawn(stream, draw + 1, keys.size() - 1);
    if (second >= first) ++second;
    const SweptKey &a = keys[first], &b = keys[second];
    out.push_back({{a.key, a.values[drawn(stream, draw + 2, a.values.size())]},
                   {b.key, b.values[drawn(stream, draw + 3, b.values.size())]}});
  }
}

void shuffle(std::uint64_t seed, std::vector<Settings>& settings) {
  const RandomStream stream(seed, "stress.order");
  for (std::size_t i = settings.size(); i > 1; --i) std::swap(settings[i - 1], settings[drawn(stream, i, i)]);
}

/// Keys that are set by themselves.
std::set<std::string> single_keys(const std::vector<Settings>& settings) {
  std::set<std::string> keys;
  for (const Settings& s : settings)
    if (s.size() == 1) keys.insert(s.front().first);
  return keys;
}

void count(const std::vector<Settings>& tried, const std::vector<Settings>& all, Sweep& sweep) {
  for (const Settings& settings : tried)
    if (!settings.empty()) ++(settings.size() == 1 ? sweep.values_tried : sweep.pairs_tried);
  const std::set<std::string> keys = single_keys(tried), wanted = single_keys(all);
  sweep.keys_tried = static_cast<std::int64_t>(keys.size());
  std::ranges::set_difference(wanted, keys, std::back_inserter(sweep.keys_not_tried));
  sweep.not_tried = static_cast<std::int64_t>(all.size() - tried.size());
}

Sweep summed_up(const std::vector<Settings>& settings, const std::map<std::size_t, TrialEnd>& ends, bool interrupted) {
  Sweep sweep;
  sweep.interrupted = interrupted;
  std::vector<Settings> tried;
  for (const auto& [trial, end] : ends) {
    tried.push_back(settings[trial]);
    sweep.refused += end.refused ? 1 : 0;
    if (!end.what.empty()) sweep.failures.push_back({settings[trial], end.what});
  }
  count(tried, settings, sweep);
  return sweep;
}

std::string text_of(const Settings& settings) {
  std::string text = settings.empty() ? "the mission as it stands" : "";
  for (const auto& [key, value] : settings) text += (text.empty() ? "" : " ") + key + "=" + value;
  return text;
}

/// At once: what has been found must not be lost, however the sweep ends.
void tell(const Settings& settings, const std::string& what) {
  const char* over_the_progress_bar = isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
  std::fprintf(stderr, "%sfailed: %s: %s\n", over_the_progress_bar, text_of(settings).c_str(), what.c_str());
}

}  // namespace

std::vector<Settings> sweep_settings(const std::vector<SweptKey>& keys, const SweepOptions& options) {
  std::vector<Settings> out;
  if (options.singles)
    for (const SweptKey& key : keys)
      for (const std::string& value : key.values) out.push_back({{key.key, value}});
  add_pairs(keys, options, out);
  if (options.budget_s) shuffle(options.seed, out);
  return out;
}

Result<Sweep> sweep_mission(const std::vector<SweptKey>& keys, const SweepOptions& options) {
  const Budget budget(options.budget_s);
  std::vector<Settings> settings = sweep_settings(keys, options);
  settings.insert(settings.begin(), Settings{});  // the mission as it stands
  CANYON_TRY(std::string folder, make_folder());
  Trials trials(options.setup, settings, budget, std::move(folder));
  std::map<std::size_t, TrialEnd> ends;  // in the order of the settings, whatever ends first
  Progress progress("stress", static_cast<double>(settings.size()), options.show_progress);
  const auto wait = [&] {
    if (auto [trial, end] = trials.wait(); end) {
      if (!end->what.empty()) tell(settings[trial], end->what);
      ends[trial] = *end;
    }
    progress.advance(1.0);
  };
  CANYON_TRY_STATUS(trials.start(0));
  wait();
  const bool sound = ends.contains(0) && ends[0].what.empty() && !ends[0].refused;
  if (sound) trials.set_up_takes(ends[0].cpu_s);
  if (ends.contains(0) && ends[0].refused) ends[0].what = "is refused: " + ends[0].said;
  try {
    std::size_t next = sound ? 1 : settings.size();
    while (trials.running() > 0 || (next < settings.size() && budget.left_s() > 0.0)) {
      while (next < settings.size() && budget.left_s() > 0.0 && trials.running() < static_cast<std::size_t>(threads()))
        CANYON_TRY_STATUS(trials.start(next++));
      wait();
    }
  } catch (const Cancelled&) {
    // Of an hour's trials what they have shown so far.
    return summed_up(settings, ends, true);
  }
  return summed_up(settings, ends, false);
}

std::string sweep_table(const Sweep& sweep) {
  std::string text;
  for (const SweepFailure& failure : sweep.failures) text += text_of(failure.settings) + ": " + failure.what + "\n";
  text += std::to_string(sweep.keys_tried) + " keys with " + std::to_string(sweep.values_tried) + " values and " +
          std::to_string(sweep.pairs_tried) + " pairs: " + std::to_string(sweep.refused) + " refused, " +
          std::to_string(sweep.failures.size()) + " failed";
  if (sweep.not_tried > 0)
    text += ", " + std::to_string(sweep.not_tried) + " not tried " +
            (sweep.interrupted ? "before the interruption" : "for lack of time");
  if (!sweep.keys_not_tried.empty()) text += "\nno value of:";
  for (const std::string& key : sweep.keys_not_tried) text += " " + key;
  return text + "\n";
}

}  // namespace canyon::study
