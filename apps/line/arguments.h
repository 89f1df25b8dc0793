#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace canyon::apps {

/// One declared argument, to be told more about: each call returns the argument itself.
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  Argument required() const;
  Argument default_shown() const;  ///< the variable's present value, in --help
  Argument type(const char* name) const;
  /// The value may be left away, and is then this one. It stands last, or after "=": what follows is taken for it.
  Argument value_optional(const std::string& value) const;
  Argument excludes(Argument other) const;
  Argument needs(Argument other) const;  ///< means nothing without it, and is refused where it is not given
  Argument among(const std::vector<std::string>& words) const;

  template <class T>
  Argument within(T lowest, T highest) const {
    if constexpr (std::is_integral_v<T>)
      return whole_within(lowest, highest);
    else
      return number_within(lowest, highest);
  }

 private:
  Argument whole_within(std::int64_t lowest, std::int64_t highest) const;
  Argument number_within(double lowest, double highest) const;

  CLI::Option* option_;
};

/// The arguments of one verb. Variables must live until the verb has run. The library that parses them is included by
/// arguments.cpp, command_line.cpp and usage_errors.cpp alone: it takes the compiler longer than a verb.
class Arguments {
 public:
  explicit Arguments(CLI::App& app) : app_(&app) {}

  /// "--name" with a value, or "name" by position. T: std::string, a vector of them, double, int, std::int64_t,
  /// std::optional of a number.
  template <class T>
  Argument option(const char* name, T& variable, const std::string& help);
  Argument flag(const char* name, bool& variable, const std::string& help);

  /// Arguments of which exactly one must be given.
  Arguments one_of(const char* name);

 private:
  CLI::App* app_;
};

}  // namespace canyon::apps
