#include <algorithm>
#include <cmath>

#include "canyon/report/draw/html.h"
#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/read/run_story.h"
#include "canyon/report/sections/figures.h"
#include "canyon/report/sections/sections.h"
#include "canyon/report/sections/why_details.h"

namespace canyon::report {
namespace {

std::string scrolled(const std::string& name, const std::string& css_class, const std::string& table) {
  return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" + name + "\"><table class=\"" +
         css_class + "\">\n" + table + "</table></div>\n";
}

/// The run's tag in its colour; its name where its epochs are not in the results.
std::string tag_of(const Results& results, const std::string& fidelity) {
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    if (results.runs[i].fidelity == fidelity) return run_tag(results.runs, i);
  }
  return escape_html(fidelity);
}

/// A share between 0 and 1 and its interval, as a dot on a line.
std::string share_bar(const Results& results, const SuccessShare& share) {
  const auto found = std::find_if(results.runs.begin(), results.runs.end(),
                                  [&](const Run& run) { return run.fidelity == share.fidelity; });
  const double p = share.success / share.n;
  if (found == results.runs.end() || !std::isfinite(p + share.interval.low + share.interval.high)) return {};
  const auto at = [](double v) { return fixed(100 * std::clamp(v, 0.0, 1.0), 2); };
  return "<svg class=\"bar\" viewBox=\"-1 0 102 8\" preserveAspectRatio=\"none\" aria-hidden=\"true\"><path "
         "class=\"fill " +
         run_class(static_cast<std::size_t>(found - results.runs.begin())) + " keep\" d=\"M" + at(share.interval.low) +
         " 3.5H" + at(share.interval.high) + "V4.5H" + at(share.interval.low) + "ZM" +
         fixed(100 * std::clamp(p, 0.0, 1.0) - 0.5, 2) + " 1h1v6h-1Z\"/></svg>";
}

std::string shares(const Results& results) {
  std::string body =
      "<thead><tr><th scope=\"col\" class=\"text\">run</th><th scope=\"col\">succeeded</th><th "
      "scope=\"col\">share</th><th scope=\"col\">95 % interval</th><th scope=\"col\" class=\"text\">0 to "
      "1</th><th scope=\"col\" class=\"text\">outcomes</th></tr></thead>\n<tbody>";
  for (const SuccessShare& share : results.over_seeds->shares) {
    std::vector<std::string> outcomes;
    for (const auto& [kind, count] : share.outcomes) outcomes.push_back(outcome_label(kind) + " " + show_count(count));
    body += "<tr><th scope=\"row\">" + tag_of(results, share.fidelity) + "</th><td>" +
            (share.n > 0 ? show_count(share.success) + " of " + show_count(share.n) : "all stopped") + "</td><td>" +
            show_share(share.success / share.n) + "</td><td>" +
            (share.n > 0 ? show_share(share.interval.low) + " to " : "") + show_share(share.interval.high) +
            "</td><td class=\"share-cell\">" + share_bar(results, share) + "</td><td class=\"text\">" +
            escape_html(listed(outcomes)) + "</td></tr>\n";
  }
  return "<h3>Share of success</h3>\n" + scrolled("Share of success over seeds", "shares", body + "</tbody>");
}

/// p as it is read: not more than two digits, and not smaller than anybody believes.
std::string show_p(double p) {
  return p < 1e-4 ? "&lt;\xC2\xA0"
                    "0.0001"
                  : show_number(p, 2);
}

std::string differences(const Results& results) {
  std::string body =
      "<thead><tr><th scope=\"col\" class=\"text\">runs</th><th scope=\"col\" class=\"text\">of</th><th "
      "scope=\"col\">difference</th><th scope=\"col\">95 % interval</th><th scope=\"col\">p</th><th "
      "scope=\"col\">pairs</th></tr></thead>\n<tbody>";
  for (const PairedSeeds& pair : results.over_seeds->paired) {
    const Figure* figure = results.figure(pair.figure);
    const Figure share{.key = "success", .label = "share of success", .unit = "%", .kind = Figure::Kind::kShare};
    const Figure& shown = figure != nullptr ? *figure : share;
    const std::string unit = shown.unit.empty() ? "" : "\xC2\xA0" + escape_html(shown.unit);
    body += "<tr><th scope=\"row\">" + tag_of(results, pair.b) + " minus " + tag_of(results, pair.a) +
            "</th><td class=\"text\">" + escape_html(shown.label) + "</td>" +
            figure_cell(show_figure(shown, pair.difference) + unit, !std::isfinite(pair.difference)) +
            figure_cell(show_interval(shown, pair.interval), !std::isfinite(pair.interval.low)) +
            figure_cell(show_p(pair.p), !std::isfinite(pair.p)) + "<td>" + show_count(pair.n) + "</td></tr>\n";
  }
  return "<h3>Seed by seed</h3>\n" + scrolled("Paired differences over seeds", "shares", body + "</tbody>");
}

std::string medians(const Results& results) {
  const auto& runs = results.over_seeds->medians;
  std::string body = "<thead><tr><td></td>";
  for (const auto& [fidelity, of_run] : runs) body += "<th scope=\"col\">" + tag_of(results, fidelity) + "</th>";
  body += "<th scope=\"col\">unit</th><th scope=\"col\">better</th></tr></thead>\n<tbody>";
  for (const Figure* figure : shown_figures(results)) {
    body += "<tr><th scope=\"row\">" + escape_html(figure->label) + "</th>";
    for (const auto& [fidelity, of_run] : runs) {
      const auto found = of_run.find(figure->key);
      const Median median = found != of_run.end() ? found->second : Median{};
      std::string spread = show_interval(*figure, median.interval);
      if (spread.empty())
        spread = show_figure(*figure, median.lowest) + " \xE2\x80\xA6 " + show_figure(*figure, median.highest);
      body += figure_cell(show_figure(*figure, median.value) + "<span class=\"def\">" + spread + "</span>",
                          !std::isfinite(median.value));
    }
    body += unit_cell(*figure) + "</tr>\n";
  }
  return "<h3>Medians</h3>\n<p>Beneath each median its 95 % interval by order statistics; of fewer than six seeds, "
         "which "
         "have none, the smallest and the largest value.</p>\n" +
         scrolled("Medians over seeds", "figures", body + "</tbody>");
}

/// What failures over seeds come from; of each that the verdict above does not speak of its own account.
std::string causes(const Results& results) {
  std::string body =
      "<thead><tr><th scope=\"col\" class=\"text\">run</th><th scope=\"col\" class=\"text\">verdict</th><th "
      "scope=\"col\">failures</th><th scope=\"col\">share</th><th scope=\"col\">95 % "
      "interval</th></tr></thead>\n<tbody>";
  std::vector<std::string> explained;
  for (const CauseTally& tally : results.cause_tally) {
    explained.push_back(show_count(tally.explained) + " of " + count_of(tally.failed, "failure", "failures") +
                        " of run " + tally.run);
    for (const CauseTally::Count& count : tally.counts)
      body += "<tr><th scope=\"row\">" + tag_of(results, tally.run) + "</th><td class=\"text\">" +
              escape_html(count.words) +
              (count.note.empty() ? "" : "<span class=\"def\">" + escape_html(count.note) + "</span>") + "</td><td>" +
              show_count(count.n) + " of " + show_count(tally.explained) + "</td><td>" +
              show_share(count.n / tally.explained) + "</td><td>" + show_share(count.interval.low) + " to " +
              show_share(count.interval.high) + "</td></tr>\n";
  }
  std::string out = "<h3>What failures come from</h3>\n<p>Explained by replays: " + escape_html(listed(explained)) +
                    ", the first ones by seed. What is said of seed " + escape_html(results.over_seeds->first) +
                    " stands with its verdict, of the others beneath.</p>\n" +
                    scrolled("What failures come from", "shares", body + "</tbody>");
  for (const SeedWhy& further : results.further_why)
    out += why_details(further.why, further.run + ", seed " + further.seed + ": " + further.why.verdict + ".");
  return out;
}

}  // namespace

std::string seeds_section(const Results& results) {
  if (!results.over_seeds) return {};
  const OverSeeds& over = *results.over_seeds;
  std::string intro = "The same runs with the seeds " + escape_html(over.first) + " to " + escape_html(over.last) +
                      ", all else equal. All other sections show seed " + escape_html(over.first) + ". ";
  intro += results.open_loop ? "Every seed is driven on the same true motion; differences are means over seeds with "
                               "Student\xE2\x80\x99s interval, p is that of the exact sign test."
                             : "Intervals of a share are Wilson\xE2\x80\x99s, of a difference of paired shares "
                               "Newcombe\xE2\x80\x99s; p is McNemar\xE2\x80\x99s, exact.";
  std::string body;
  if (!over.shares.empty()) body += shares(results);
  if (!results.cause_tally.empty()) body += causes(results);
  if (!over.paired.empty()) body += differences(results);
  if (!over.medians.empty()) body += medians(results);
  return section("seeds", "Over " + show_count(over.count) + " seeds", intro, body);
}

}  // namespace canyon::report
