#include <algorithm>
#include <cmath>

#include "canyon/report/draw/chart.h"
#include "canyon/report/draw/html.h"
#include "canyon/report/sections/filter_verdict.h"

namespace canyon::report {
namespace {

/// Lines that fit beside one another with their names.
constexpr std::size_t kNamed = 3;

/// "antenna lever", of "antenna_lever".
std::string in_words(std::string block) {
  std::replace(block.begin(), block.end(), '_', ' ');
  return block;
}

/// "east", of "east position" in "position"; "x", of "mounting x".
std::string within(const std::string& block, std::string name) {
  if (const std::size_t at = name.find(block); at != std::string::npos) name.erase(at, block.size());
  const std::size_t first = name.find_first_not_of(' '), last = name.find_last_not_of(' ');
  return first == std::string::npos ? block : name.substr(first, last + 1 - first);
}

Panel panel_of(const std::string& block, const std::vector<const ObservedState*>& states,
               const std::vector<double>& looked_s, std::size_t run) {
  Panel panel{.title = in_words(block)};
  panel.y = Axis::linear(0.0, 1.0, 2);
  panel.height_px = 70;
  panel.limit = 0.5;
  for (const ObservedState* state : states) {
    panel.lines.push_back({.run = run,
                           .name = state->name,
                           .x = looked_s,
                           .y = state->shares,
                           .style = states.size() > kNamed ? Line::Style::kThin : Line::Style::kNormal});
    if (states.size() > 1 && states.size() <= kNamed)
      panel.labels.push_back({run, looked_s.back(), state->shares.back(), within(block, state->name)});
  }
  return panel;
}

}  // namespace

std::string observability_chart(const FilterVerdict& verdict, std::size_t run) {
  if (verdict.looked_s.size() < 2) return {};
  Chart chart;
  chart.id = "observed-" + std::to_string(run);
  chart.x = Axis::seconds(verdict.looked_s.front(), verdict.looked_s.back());
  chart.x_label = "time since the filter\xE2\x80\x99s start, s";
  chart.solid = true;
  chart.title = "What the measurements tell of each state, over time";
  chart.description =
      "1-sigma of each state over what it would be by prediction alone: 1 where the measurements have "
      "told nothing of it; from a half on, the level line, it counts as observed.";
  std::string block;
  std::vector<const ObservedState*> states;
  const auto close = [&] {
    if (!states.empty()) chart.panels.push_back(panel_of(block, states, verdict.looked_s, run));
    states.clear();
  };
  for (const ObservedState& state : verdict.states) {
    if (state.block != block) close();
    block = state.block;
    if (state.shares.size() == verdict.looked_s.size()) states.push_back(&state);
  }
  close();
  if (chart.panels.empty()) return {};
  return "<h3>What the measurements tell of each state, over time</h3>\n<p>" + chart.description + "</p>\n" +
         figure(draw(chart), {});
}

}  // namespace canyon::report
