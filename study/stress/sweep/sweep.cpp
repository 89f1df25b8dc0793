#include "canyon/study/stress/sweep/sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

namespace fs = std::filesystem;

/// A folder for trials, gone with this.
class Workshop {
 public:
  Workshop() {
    std::string name = (fs::temp_directory_path() / "canyon-stress-XXXXXX").string();
    CANYON_CHECK(mkdtemp(name.data()) != nullptr, "no folder like ", name);
    folder_ = name;
  }
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  fs::path place(std::size_t trial) const { return folder_ / std::to_string(trial); }

 private:
  fs::path folder_;
};

/// Trials that run at this moment.
class Running {
 public:
  ~Running() {
    for (const auto& [child, trial] : trials_) end_child(child);
  }
  std::size_t size() const { return trials_.size(); }
  void add(pid_t child, std::size_t trial) { trials_[child] = trial; }
  std::size_t take(pid_t child) {
    const std::size_t trial = trials_.at(child);
    trials_.erase(child);
    return trial;
  }

 private:
  std::map<pid_t, std::size_t> trials_;
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

void count(const std::vector<Settings>& tried, Sweep& sweep) {
  std::set<std::string> keys;
  for (const Settings& settings : tried) {
    if (settings.size() == 1) keys.insert(settings.front().first);
    ++(settings.size() == 1 ? sweep.values_tried : sweep.pairs_tried);
  }
  sweep.keys_tried = static_cast<std::int64_t>(keys.size());
}

std::string text_of(const Settings& settings) {
  std::string text;
  for (const auto& [key, value] : settings) text += (text.empty() ? "" : " ") + key + "=" + value;
  return text;
}

}  // namespace

std::vector<Settings> sweep_settings(const std::vector<SweptKey>& keys, const SweepOptions& options) {
  std::vector<Settings> out;
  for (const SweptKey& key : keys)
    for (const std::string& value : key.values) out.push_back({{key.key, value}});
  add_pairs(keys, options, out);
  if (options.budget_s) shuffle(options.seed, out);
  return out;
}

Sweep sweep_mission(const std::vector<SweptKey>& keys, const SweepOptions& options) {
  using Clock = std::chrono::steady_clock;
  std::vector<Settings> settings = sweep_settings(keys, options);
  const Workshop workshop;
  Running running;
  Sweep sweep;
  std::map<std::size_t, TrialEnd> ends;  // in the order of the settings, whatever ends first
  Progress progress("stress", static_cast<double>(settings.size()), options.show_progress);
  const auto started = Clock::now();
  const auto in_time = [&] {
    return !options.budget_s || std::chrono::duration<double>(Clock::now() - started).count() < *options.budget_s;
  };
  std::size_t next = 0;
  while (running.size() > 0 || (next < settings.size() && in_time())) {
    while (next < settings.size() && in_time() && running.size() < static_cast<std::size_t>(threads())) {
      running.add(start_trial(options.setup, settings[next], workshop.place(next)), next);
      ++next;
    }
    const auto [child, end] = wait_for_a_child();
    const std::size_t trial = running.take(child);
    ends[trial] = judge_trial(options.setup, end, workshop.place(trial));
    fs::remove_all(workshop.place(trial));
    progress.advance(1.0);
  }
  sweep.not_tried = static_cast<std::int64_t>(settings.size() - next);
  settings.resize(next);
  count(settings, sweep);
  for (const auto& [trial, end] : ends) {
    sweep.refused += end.refused ? 1 : 0;
    if (!end.what.empty()) sweep.failures.push_back({settings[trial], end.what});
  }
  return sweep;
}

std::string sweep_table(const Sweep& sweep) {
  std::string text;
  for (const SweepFailure& failure : sweep.failures) text += text_of(failure.settings) + ": " + failure.what + "\n";
  text += std::to_string(sweep.keys_tried) + " keys with " + std::to_string(sweep.values_tried) + " values and " +
          std::to_string(sweep.pairs_tried) + " pairs: " + std::to_string(sweep.refused) + " refused, " +
          std::to_string(sweep.failures.size()) + " failed";
  if (sweep.not_tried > 0) text += ", " + std::to_string(sweep.not_tried) + " not tried for lack of time";
  return text + "\n";
}

}  // namespace canyon::study
