#include "canyon/apps/line/usage_errors.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include <CLI/CLI.hpp>

#include "canyon/core/config/config.h"
#include "canyon/core/config/text.h"

namespace canyon::apps {

namespace {

/// The verbs inside one; CLI11 keeps its groups of options among them, which have no name.
std::vector<const CLI::App*> subverbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty(); });
}

std::vector<std::string> verbs_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : subverbs_of(app)) names.push_back(sub->get_name());
  return names;
}

std::vector<const CLI::App*> option_groups_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* sub) { return sub->get_name().empty(); });
}

std::string nearest_hint(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? "" : "; nearest is \"" + nearest + "\"";
}

/// The verb that the words at the front name, as far as they do, and how many they are.
struct Place {
  const CLI::App* app;
  std::size_t words;
};
Place place_of(const CLI::App& app, const std::vector<std::string>& arguments) {
  Place place{&app, 0};
  for (bool found = true; found && place.words < arguments.size();) {
    found = false;
    for (const CLI::App* sub : subverbs_of(*place.app)) {
      if (sub->get_name() != arguments[place.words]) continue;
      place = {sub, place.words + 1};
      found = true;
      break;
    }
  }
  return place;
}

std::string full_name(const CLI::App& app) {
  return (app.get_parent() != nullptr ? full_name(*app.get_parent()) + " " : "") + app.get_name();
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const CLI::App* group : option_groups_of(app))
    for (const std::string& name : options_of(*group)) names.push_back(name);
  return names;
}

/// A group of which exactly one option must be given, and none or several are.
std::optional<Error> not_one_of_a_group(const CLI::App& verb) {
  for (const CLI::App* group : option_groups_of(verb)) {
    if (group->get_require_option_min() != 1 || group->get_require_option_max() != 1) continue;
    std::vector<std::string> known, given;
    for (const CLI::Option* option : group->get_options()) {
      if (option == group->get_help_ptr()) continue;
      known.push_back(option->get_name());
      if (option->count() > 0) given.push_back(option->get_name());
    }
    if (given.size() == 1) continue;
    return Error{.file = full_name(verb),
                 .what = given.empty() ? "no " + group->get_group() + " given" : plain_list(given) + " together",
                 .expected = "one of " + plain_list(known)};
  }
  return std::nullopt;
}

/// "a whole number from 0 to 1024" of CLI11's "INT:INT in [0 - 1024]".
std::string words_of(const std::string& type) {
  const bool whole = type.rfind("INT", 0) == 0 || type.rfind("UINT", 0) == 0;
  const bool number = whole || type.rfind("FLOAT", 0) == 0;
  std::string words = number ? (whole ? "a whole number" : "a number") : "another value";
  const std::size_t open = type.find('['), dash = type.find(" - "), close = type.find(']');
  if (number && open < dash && dash < close)
    words += " from " + type.substr(open + 1, dash - open - 1) + " to " + type.substr(dash + 3, close - dash - 3);
  return words;
}

/// a, b of CLI11's "TEXT:{a,b}"; none of other types.
std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open >= close || close == std::string::npos) return {};
  return split_list(type.substr(open + 1, close - open - 1));
}

/// What such an option takes, in answer to `value`.
std::string expected_of(const CLI::Option& option, const std::string& value) {
  const std::string type = option.get_type_name();
  const std::vector<std::string> choices = choices_of(type);
  return choices.empty() ? words_of(type) : "one of " + plain_list(choices) + nearest_hint(value, choices);
}

/// An option that has one value and was given several: whichever of them is refused, that is what is wrong.
std::optional<Error> given_again(const CLI::App& app, const std::string& verb) {
  for (const CLI::Option* option : app.get_options()) {
    const std::size_t times = option->count();
    if (option->get_items_expected_max() != 1 || times < 2) continue;
    return Error{.file = verb,
                 .what = option->get_name() + " given " + (times == 2 ? "twice" : std::to_string(times) + " times"),
                 .expected = "it once"};
  }
  for (const CLI::App* group : option_groups_of(app))
    if (auto again = given_again(*group, verb)) return again;
  return std::nullopt;
}

/// Whether a message speaks of this option, not of one whose name only begins with it.
bool speaks_of(const std::string& message, const std::string& name) {
  for (std::size_t at = message.find(name); at != std::string::npos; at = message.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if (end == message.size() || (message[end] != '-' && std::isalnum(static_cast<unsigned char>(message[end])) == 0))
      return true;
  }
  return false;
}

/// The option whose value was refused, and that value, by reading the arguments once more.
std::optional<Error> refused_value(const CLI::App& verb, const std::string& message,
                                   const std::vector<std::string>& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    const std::string name = word.substr(0, word.find('='));
    const CLI::Option* option = name.rfind("--", 0) == 0 ? verb.get_option_no_throw(name) : nullptr;
    if (option == nullptr || !speaks_of(message, name)) continue;
    const bool inside = name.size() < word.size();
    if (!inside && i + 1 >= arguments.size()) continue;
    // Of a list it may be a later one.
    const std::string value = message.ends_with(": empty") ? ""
                              : inside                     ? word.substr(name.size() + 1)
                                                           : arguments[i + 1];
    return Error{.file = name, .what = "\"" + value + "\"", .expected = expected_of(*option, value)};
  }
  return std::nullopt;
}

}  // namespace

Error usage_error(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments) {
  const Place place = place_of(app, arguments);
  const std::string verb = full_name(*place.app);
  const std::vector<std::string> verbs = verbs_of(*place.app);
  if (!verbs.empty()) {
    const bool named = place.words < arguments.size() && arguments[place.words].rfind('-', 0) != 0;
    if (!named) return {.file = verb, .what = "no verb given", .expected = "one of " + plain_list(verbs)};
    const std::string& word = arguments[place.words];
    return {.file = verb,
            .what = "\"" + word + "\" is not a verb",
            .expected = "one of " + plain_list(verbs) + nearest_hint(word, verbs)};
  }

  const std::string message = error.what();
  // What nobody knows is told before what is missing: it may be missing because it is misspelt.
  const bool alone = dynamic_cast<const CLI::RequiresError*>(&error) != nullptr;
  const bool missing = alone || dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (missing || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::vector<std::string> extras = app.remaining(true);
    for (const std::string& word : arguments) {
      if (std::find(extras.begin(), extras.end(), word) == extras.end()) continue;
      if (word.rfind('-', 0) != 0) return {.file = verb, .what = "\"" + word + "\" is one argument too many"};
      const std::string name = word.substr(0, word.find('='));
      const std::string nearest = nearest_word(name, options_of(*place.app));
      return {.file = verb,
              .what = "no option \"" + name + "\"",
              .expected = nearest.empty() ? "one that " + verb + " --help names" : "\"" + nearest + "\"?"};
    }
  }
  const bool refused = dynamic_cast<const CLI::ConversionError*>(&error) != nullptr ||
                       dynamic_cast<const CLI::ValidationError*>(&error) != nullptr;
  const bool mismatch = dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr;
  if (refused || mismatch)
    if (const auto again = given_again(*place.app, verb)) return *again;
  if (refused)
    if (const auto value = refused_value(*place.app, message, arguments)) return *value;
  if (mismatch) {
    for (const std::string& name : options_of(*place.app))
      if (message.rfind(name + ":", 0) == 0 || message.rfind(name + " ", 0) == 0)
        return {.file = verb, .what = name + " has no value", .expected = "one"};
  }
  if (alone) {  // "--for requires --plan"
    constexpr std::string_view kBetween = " requires ";
    const std::size_t between = message.find(kBetween);
    return {.file = message.substr(0, between),
            .what = "stands alone",
            .expected = message.substr(between + kBetween.size()) + " beside it"};
  }
  if (missing && message.find('[') != std::string::npos)  // a list of options, one of which it is about
    if (const auto wrong = not_one_of_a_group(*place.app)) return *wrong;
  if (missing)
    return {.file = verb,
            .what = message.substr(0, message.find(' ')) + " is missing; " + verb + " --help shows an example"};
  return {.file = verb, .what = message};
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace canyon::apps
