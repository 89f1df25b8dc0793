#pragma once

#include <string>
#include <vector>

#include "canyon/core/result.h"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace canyon::apps {

/// What is wrong with a command line, in our own words: names the argument as it was typed and the nearest thing that
/// exists. `arguments` are those after the program's name.
Error usage_error(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments);

/// "a,b,c" without the commas; an empty name stays, to be refused by whoever looks it up.
std::vector<std::string> split_list(const std::string& text);

}  // namespace canyon::apps
