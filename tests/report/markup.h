#pragma once

#include <string>
#include <vector>

/// Plain searches in markup; regular expressions of the standard library recurse once per character of a match.
namespace canyon::testing {

/// The text without what stands between the marks, and without them.
std::string without(std::string text, const std::string& from, const std::string& to);

/// Every `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Values of all attributes of that name, in order.
std::vector<std::string> attributes(const std::string& html, const std::string& name);

/// Whether the word stands anywhere with no letter or digit beside it.
bool has_word(const std::string& text, const std::string& word);

/// What follows each `mark`, up to `length` characters.
std::vector<std::string> after(const std::string& text, const std::string& mark, std::size_t length);

}  // namespace canyon::testing
