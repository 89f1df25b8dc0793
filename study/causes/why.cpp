#include <algorithm>
#include <cstdio>
#include <string_view>

#include <nlohmann/json.hpp>

#include "canyon/core/files/json_text.h"
#include "canyon/mission/scoring/told_failure.h"
#include "canyon/study/causes/causes.h"

// Causes in words and as JSON.
namespace canyon::study {
namespace {

std::string seconds(double t_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", t_s);
  return text;
}

std::string out_of(int count, int draws) {
  return std::to_string(count) + " of " + std::to_string(draws);
}

std::string satellites(int count) {
  return std::to_string(count) + (count == 1 ? " satellite" : " satellites");
}

std::string words(const Event& event) {
  char size[32];
  std::snprintf(size, sizeof size, "%.1f", event.size);
  switch (event.kind) {
    case EventKind::kDilutionJump:
      return std::string("range errors suddenly weigh more or less in the fix (GDOP jumps by up to ") + size + ")";
    case EventKind::kHiddenSignals:
      return "fixes use signals that come by detours, at most of " + satellites(static_cast<int>(event.size)) +
             " hidden from the antenna (NLOS)";
    case EventKind::kFixLost:
      return "satellites give no position (no fix)";
    case EventKind::kUnlikelyFix:
      return std::string("the filter believes fixes far from where it expected them (NIS up to ") + size +
             " times its 99.9 % bound)";
    case EventKind::kOverconfident:
      return std::string("the position is off by up to ") + size + " times what the filter thinks possible (3 sigma)";
    case EventKind::kMapDoubled:
      return std::string("the map has the same surfaces twice, up to ") + size + " m apart";
    case EventKind::kPhantom:
      return "the autonomy sees no way on, though there is one (phantom)";
    case EventKind::kStopped:
      return "the autonomy stands: something is in its way, or it sees nothing";
  }
  return {};
}

/// Whether `size` says how bad an event was; of others that is how long they lasted.
bool has_size(EventKind kind) {
  return kind != EventKind::kFixLost && kind != EventKind::kPhantom && kind != EventKind::kStopped;
}

std::string span(const Event& event) {
  return seconds(event.from_s) + (event.to_s > event.from_s ? " to " + seconds(event.to_s) : std::string());
}

/// Several events of a kind, by time, as one line.
std::string joined(const std::vector<Event>& group) {
  if (group.size() == 1) return span(group.front()) + ": " + words(group.front());
  const auto badness = [](const Event& e) { return has_size(e.kind) ? e.size : e.to_s - e.from_s; };
  const auto worst = std::max_element(group.begin(), group.end(),
                                      [&](const Event& a, const Event& b) { return badness(a) < badness(b); });
  double to_s = 0.0;
  for (const Event& event : group) to_s = std::max(to_s, event.to_s);
  return std::to_string(group.size()) + " times from " + seconds(group.front().from_s) + " to " + seconds(to_s) +
         (has_size(worst->kind) ? ", the largest" : ", the longest") +
         (worst->to_s > worst->from_s ? " from " : " at ") + span(*worst) + ": " + words(*worst);
}

/// Whether it is of the chain that is told.
bool in_chain(const Explanation& e, const Event& event) {
  return event.to_s >= e.from_s && event.from_s <= e.failure.t_s;
}

/// What else rescues alike, each by itself: removals as narrow as the cause.
std::string alike_words(const Explanation& e) {
  std::string words;
  for (const RemovalOutcome* outcome : alike(e))
    words += std::string(words.empty() ? "" : ", ") + outcome->removal->make.cause + " (" +
             out_of(outcome->successes, e.draws) + ")";
  return words.empty() ? words : "; each of these is enough to take away as well: " + words;
}

bool contains(const Removal& removal, const ModelRow<Removal>& other) {
  return removal.contains != nullptr && std::string_view(removal.contains) == other.name;
}

}  // namespace

std::vector<const RemovalOutcome*> alike(const Explanation& e) {
  std::vector<const RemovalOutcome*> others;
  if (e.cause == nullptr) return others;
  for (const RemovalOutcome& outcome : e.outcomes)
    if (outcome.rescues && outcome.removal != e.cause && outcome.removal->make.breadth == e.cause->make.breadth &&
        !contains(outcome.removal->make, *e.cause))
      others.push_back(&outcome);
  return others;
}

VerdictKind verdict_kind(const Explanation& e) {
  if (e.cause != nullptr) return VerdictKind::kCause;
  const RemovalOutcome& navigation = e.outcomes.back();  // the widest is the last row
  return navigation.successes == 0 ? VerdictKind::kNotNavigation : VerdictKind::kUndetermined;
}

std::string replays_bound(int draws) {
  char most[32];
  std::snprintf(most, sizeof most, "%.2g %%", 100.0 * wilson_interval(0, draws).high);
  return out_of(0, draws) + " repeats, so in at most " + most + " of such drives (95 %)";
}

std::string verdict(const Explanation& e) {
  const std::string as_it_was = "with nothing but the noise changed from " + seconds(e.from_s) + " on, in " +
                                out_of(e.successes_as_it_was, e.draws);
  if (e.cause != nullptr) {
    for (const RemovalOutcome& outcome : e.outcomes) {
      if (outcome.removal != e.cause) continue;
      return std::string("because of ") + e.cause->make.cause + ". Driven again without that (" + e.cause->doc +
             ") it succeeds in " + out_of(outcome.successes, e.draws) + " repeats, " + as_it_was + alike_words(e);
    }
  }
  if (verdict_kind(e) == VerdictKind::kNotNavigation)
    return "navigation is not to blame. Told its true position it succeeds in " + replays_bound(e.draws) + "; " +
           as_it_was;
  return "undetermined. Nothing that was taken away helps more often than other noise does; it succeeds, " + as_it_was;
}

std::vector<std::string> chain(const Explanation& e) {
  std::vector<std::vector<Event>> groups;
  std::size_t events = 0;
  for (const Event& event : e.events) events += in_chain(e, event) ? 1 : 0;
  for (const Event& event : e.events) {
    if (!in_chain(e, event)) continue;
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group.front().kind == event.kind; });
    if (events <= kMostChainLines || same == groups.end())
      groups.push_back({event});
    else
      same->push_back(event);
  }
  std::vector<std::string> lines;
  for (const auto& group : groups) lines.push_back(joined(group));
  lines.push_back(seconds(e.failure.t_s) + ": it " + failure_line(told_failure(e.failure)));
  return lines;
}

nlohmann::ordered_json why_json(const std::vector<Explanation>& explanations) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Explanation& e : explanations) {
    nlohmann::ordered_json events = nlohmann::ordered_json::array(), removed = nlohmann::ordered_json::array();
    nlohmann::ordered_json others = nlohmann::ordered_json::array();
    for (const RemovalOutcome* outcome : alike(e)) others.push_back(outcome->removal->name);
    for (const Event& event : e.events)
      events.push_back({{"kind", row_of(event_kinds(), event.kind).name},
                        {"from_s", event.from_s},
                        {"to_s", event.to_s},
                        {"size", event.size}});
    for (const RemovalOutcome& outcome : e.outcomes)
      removed.push_back({{"removal", outcome.removal->name},
                         {"success", outcome.successes},
                         {"rescued", outcome.pairs.only_b},
                         {"harmed", outcome.pairs.only_a},
                         {"difference", outcome.pairs.difference()},
                         {"low", outcome.difference.low},
                         {"high", outcome.difference.high},
                         {"p", outcome.p},
                         {"rescues", outcome.rescues}});
    all.push_back({{"run", e.run},
                   {"seed", e.seed},
                   {"outcome", name(e.failure.kind)},
                   {"failed_s", e.failure.t_s},
                   {"detail", e.failure.detail},
                   {"from_s", e.from_s},
                   {"draws", e.draws},
                   {"success_as_it_was", e.successes_as_it_was},
                   {"cause", e.cause != nullptr ? nlohmann::ordered_json(e.cause->name) : nlohmann::ordered_json()},
                   {"alike", std::move(others)},
                   {"verdict", verdict(e)},
                   {"chain", chain(e)},
                   {"events", std::move(events)},
                   {"removals", std::move(removed)}});
  }
  return {{"failures", std::move(all)}};
}

}  // namespace canyon::study
