#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "canyon/report/read/results.h"

/// Pieces of the page that every section uses. Arguments named `html` are markup already; all others are plain text.
namespace canyon::report {

std::string section(std::string_view id, std::string_view title, const std::string& intro_html,
                    const std::string& body_html);

/// A drawing with its caption beneath.
std::string figure(const std::string& body_html, const std::string& caption_html);

/// What is missing, and why.
std::string note(std::string_view text);

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& names);

/// A legend of runs: swatch and name.
std::string run_legend(const std::vector<Run>& runs, const std::vector<std::size_t>& which);

/// The run's name in its colour's tag.
std::string run_tag(const std::vector<Run>& runs, std::size_t i);

/// The runs that are not mixed ones.
std::vector<std::size_t> pure_runs(const Results& results);

}  // namespace canyon::report
