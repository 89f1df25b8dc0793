#include "canyon/core/files/json_text.h"

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>

#include <nlohmann/json.hpp>

#include "canyon/core/process/progress.h"

namespace canyon {
namespace {

constexpr int kNumberOverflow = 406;    // the library's number of that mistake
constexpr std::size_t kMaxDepth = 100;  // deeper nesting is damage, not data; it would only exhaust the stack

/// Where the parser is: the lexer takes characters one by one, so counting its line feeds gives the line of every
/// event.
struct Place {
  int line = 1;
  bool last_was_line_feed = false;
};

/// The characters of a text; counts lines, and looks now and then whether the user asked to stop. Copies share the
/// count, since the parser keeps its own copy.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, Place* place) : at_(at), place_(place) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    place_->last_was_line_feed = *at_ == '\n';
    if (*at_ == '\n') ++place_->line;
    ++at_;
    if ((reinterpret_cast<std::uintptr_t>(at_) & 0xfffffu) == 0) throw_if_cancelled();
    return *this;
  }
  bool operator==(const CountingIterator& o) const { return at_ == o.at_; }
  bool operator!=(const CountingIterator& o) const { return at_ != o.at_; }

 private:
  const char* at_;
  Place* place_;
};

/// Builds the tree out of the parser's events.
template <class Tree>
class TreeBuilder : public nlohmann::json_sax<Tree> {
 public:
  TreeBuilder(const Place& place, std::size_t size, const std::string& file, const JsonReading& reading)
      : place_(place), size_(size), file_(file), reading_(reading) {}

  bool null() override { return add(nullptr, place_.line); }
  bool boolean(bool v) override { return add(v, place_.line); }
  bool number_integer(std::int64_t v) override { return add(v, line_of_scalar()); }
  bool number_unsigned(std::uint64_t v) override { return add(v, line_of_scalar()); }
  bool number_float(double v, const std::string&) override { return add(v, line_of_scalar()); }
  bool string(std::string& v) override { return add(std::move(v), place_.line); }
  bool binary(typename Tree::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Tree::object()); }
  bool start_array(std::size_t) override { return open(Tree::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    Tree& parent = *open_.back();
    if (!reading_.same_key_twice && parent.contains(name))
      return fail(place_.line, name, "key given twice", "each key once");
    member_ = &parent[name];
    name_ = std::move(name);
    if (open_.size() == 1) outer_ = name_;
    if (open_.size() == 1 && reading_.members && name_ == reading_.key) reading_.members->clear();
    return true;
  }
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::json::exception& exception) override {
    if (exception.id == kNumberOverflow)
      return fail(line_of_scalar(), {}, "number " + token.substr(0, 40), "one that a double can hold");
    if (position > size_)  // the lexer asked for more than there is
      return fail(place_.line, {}, "the JSON text ends too early", "a complete JSON value");
    // The token runs from the last good place to the mistake; its end is what to look for.
    constexpr std::size_t kShown = 24;
    const std::string end = token.size() > kShown ? token.substr(token.size() - kShown) : token;
    return fail(line_of_scalar(), {}, "not JSON near '" + end + "'", "a JSON value");
  }

  Tree root;
  std::optional<Error> error;

 private:
  bool fail(int line, std::string key, std::string what, std::string expected) {
    error = Error{file_, line, std::move(key), std::move(what), std::move(expected)};
    return false;
  }

  /// A number ends only where the lexer has read one character further.
  int line_of_scalar() const { return place_.line - (place_.last_was_line_feed ? 1 : 0); }

  /// Where the value belongs that begins at `line`.
  Tree& place_for(int line) {
    if (reading_.lines) reading_.lines->push_back(line);
    if (reading_.members && open_.size() == 2 && outer_ == reading_.key)
      reading_.members->push_back({open_.back()->is_object() ? name_ : std::string(), line});
    if (open_.empty()) return root;
    Tree& parent = *open_.back();
    if (parent.is_object()) return *member_;
    parent.push_back(nullptr);
    return parent.back();
  }
  bool add(Tree value, int line) {
    place_for(line) = std::move(value);
    return true;
  }
  bool open(Tree value) {
    if (open_.size() >= kMaxDepth) return fail(place_.line, {}, "nested more than 100 deep", "at most 100 levels");
    Tree& place = place_for(place_.line);
    place = std::move(value);
    // A parent's list may grow only while no child of it is open, so the pointers on the stack stay valid.
    open_.push_back(&place);
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  const Place& place_;
  std::size_t size_;
  const std::string& file_;
  const JsonReading& reading_;
  std::vector<Tree*> open_;
  Tree* member_ = nullptr;    // of the innermost open object, whose value comes next
  std::string name_, outer_;  // the last keys: of any object, of the outermost
};

template <class Tree>
Result<Tree> parse(std::string_view text, const std::string& path, const JsonReading& reading) {
  Place place{.line = reading.first_line};
  TreeBuilder<Tree> builder(place, text.size(), path, reading);
  const CountingIterator begin(text.data(), &place), end(text.data() + text.size(), &place);
  const bool parsed = Tree::sax_parse(begin, end, &builder);
  if (builder.error) return *builder.error;
  if (!parsed) return Error{path, place.line, {}, "not JSON", "a JSON value"};
  return std::move(builder.root);
}

}  // namespace

Result<nlohmann::json> parse_json(std::string_view text, const std::string& path, const JsonReading& reading) {
  return parse<nlohmann::json>(text, path, reading);
}

Result<nlohmann::ordered_json> parse_ordered_json(std::string_view text, const std::string& path,
                                                  const JsonReading& reading) {
  return parse<nlohmann::ordered_json>(text, path, reading);
}

std::string json_text(const nlohmann::json& tree, int indent) {
  return tree.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_text(const nlohmann::ordered_json& tree, int indent) {
  return tree.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string json_string(const nlohmann::json& object, const char* key) {
  const auto member = object.is_object() ? object.find(key) : object.end();
  return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

}  // namespace canyon
