#include "canyon/apps/line/arguments.h"

#include <cmath>

#include <CLI/CLI.hpp>

namespace canyon::apps {

Argument Argument::required() const {
  option_->required();
  return *this;
}

Argument Argument::default_shown() const {
  option_->capture_default_str();
  return *this;
}

Argument Argument::type(const char* name) const {
  option_->type_name(name);
  return *this;
}

Argument Argument::value_optional(const std::string& value) const {
  option_->expected(0, 1)->default_str(value);
  return *this;
}

Argument Argument::excludes(Argument other) const {
  option_->excludes(other.option_);
  return *this;
}

Argument Argument::needs(Argument other) const {
  option_->needs(other.option_);
  return *this;
}

Argument Argument::among(const std::vector<std::string>& words) const {
  option_->check(CLI::IsMember(words));
  return *this;
}

Argument Argument::whole_within(std::int64_t lowest, std::int64_t highest) const {
  option_->check(CLI::Range(lowest, highest));
  return *this;
}

Argument Argument::number_within(double lowest, double highest) const {
  option_->check(CLI::Range(lowest, highest));
  // For that a NaN is neither too low nor too high.
  option_->check([](const std::string& value) {
    double number = 0.0;
    const bool none = CLI::detail::lexical_cast(value, number) && std::isnan(number);
    return none ? std::string("not a number") : std::string();
  });
  return *this;
}

template <class T>
Argument Arguments::option(const char* name, T& variable, const std::string& help) {
  CLI::Option* option = app_->add_option(name, variable, help);
  // A script whose variable is empty would otherwise get what it gets without the option.
  option->check([](const std::string& value) { return value.empty() ? std::string("empty") : std::string(); });
  return Argument(option);
}
template Argument Arguments::option(const char*, std::string&, const std::string&);
template Argument Arguments::option(const char*, std::vector<std::string>&, const std::string&);
template Argument Arguments::option(const char*, int&, const std::string&);
template Argument Arguments::option(const char*, std::int64_t&, const std::string&);
template Argument Arguments::option(const char*, double&, const std::string&);
template Argument Arguments::option(const char*, std::optional<std::int64_t>&, const std::string&);
template Argument Arguments::option(const char*, std::optional<double>&, const std::string&);

Argument Arguments::flag(const char* name, bool& variable, const std::string& help) {
  return Argument(app_->add_flag(name, variable, help));
}

Arguments Arguments::one_of(const char* name) {
  CLI::App* group = app_->add_option_group(name, "one of");
  group->require_option(1);
  return Arguments(*group);
}

}  // namespace canyon::apps
