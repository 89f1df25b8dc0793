#include "canyon/report/read/json_node.h"

#include <cmath>
#include <cstddef>
#include <iterator>

#include <nlohmann/json.hpp>

#include "canyon/report/draw/format.h"
#include "canyon/report/read/number_limit.h"

namespace canyon::report {
namespace {

constexpr int kNumberOverflow = 406;    // the library's number of that mistake
constexpr std::size_t kMaxDepth = 100;  // deeper nesting is damage, not data; it would only exhaust the stack

/// Where the parser is: the lexer takes characters one by one, so counting its line feeds gives the line of every
/// event.
struct Place {
  int line = 1;
  bool last_was_line_feed = false;
};

/// An input iterator over the text that counts lines. Copies share the count, since the parser keeps its own copy.
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
    return *this;
  }
  bool operator==(const CountingIterator& o) const { return at_ == o.at_; }
  bool operator!=(const CountingIterator& o) const { return at_ != o.at_; }

 private:
  const char* at_;
  Place* place_;
};

/// Builds the tree out of the parser's events.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(const Place& place, std::size_t size, const std::string& file)
      : place_(place), size_(size), file_(file) {}

  bool null() override { return add({}); }
  bool boolean(bool v) override { return add({v, 0, {}}); }
  bool number_integer(number_integer_t v) override { return add({static_cast<double>(v), 0, std::to_string(v)}, true); }
  bool number_unsigned(number_unsigned_t v) override {
    return add({static_cast<double>(v), 0, std::to_string(v)}, true);
  }
  bool number_float(number_float_t v, const string_t&) override { return add({static_cast<double>(v), 0, {}}, true); }
  bool string(string_t& v) override { return add({std::move(v), 0, {}}); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open({JsonNode::Object{}, 0, {}}); }
  bool start_array(std::size_t) override { return open({JsonNode::Array{}, 0, {}}); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    auto& members = std::get<JsonNode::Object>(open_.back()->value).members;
    for (const JsonNode& member : members) {
      if (member.key == name) {
        error_ = Error{file_, place_.line, name, "key given twice", "each key once"};
        return false;
      }
    }
    members.emplace_back();
    members.back().key = std::move(name);
    return true;
  }
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::json::exception& exception) override {
    if (exception.id == kNumberOverflow) {
      error_ = Error{file_, line_of_scalar(), {}, "number " + token.substr(0, 40), "one of at most 1e15 in size"};
      return false;
    }
    if (position > size_) {  // the lexer asked for more than there is
      error_ = Error{file_, place_.line, {}, "the JSON text ends too early", "a complete JSON value"};
      return false;
    }
    // The token runs from the last good place to the mistake; its end is what to look for.
    constexpr std::size_t kShown = 24;
    const std::string end = token.size() > kShown ? token.substr(token.size() - kShown) : token;
    error_ = Error{file_, line_of_scalar(), {}, "not JSON near '" + end + "'", "a JSON value"};
    return false;
  }

  JsonNode root;
  std::optional<Error> error() const { return error_; }

 private:
  /// A number ends only where the lexer has read one character further.
  int line_of_scalar() const { return place_.line - (place_.last_was_line_feed ? 1 : 0); }

  JsonNode* place_for(JsonNode node) {
    if (open_.empty()) {
      root = std::move(node);
      return &root;
    }
    JsonNode& parent = *open_.back();
    if (auto* list = std::get_if<JsonNode::Array>(&parent.value)) {
      list->push_back(std::move(node));
      return &list->back();
    }
    JsonNode& member = std::get<JsonNode::Object>(parent.value).members.back();
    node.key = std::move(member.key);
    member = std::move(node);
    return &member;
  }
  bool add(JsonNode node, bool number = false) {
    node.line = number ? line_of_scalar() : place_.line;
    place_for(std::move(node));
    return true;
  }
  bool open(JsonNode node) {
    if (open_.size() >= kMaxDepth) {
      error_ = Error{file_, place_.line, {}, "nested more than 100 deep", "a results file of Canyon"};
      return false;
    }
    node.line = place_.line;
    // A parent's list may grow only while no child of it is open, so the pointers on the stack stay valid.
    open_.push_back(place_for(std::move(node)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  const Place& place_;
  std::size_t size_;
  const std::string& file_;
  std::vector<JsonNode*> open_;
  std::optional<Error> error_;
};

constexpr const char* kPlausible = "a number of at most 1e15 in size";
static_assert(kLargestNumber == 1e15);

bool is_plausible(double value) {
  return std::abs(value) <= kLargestNumber;
}

std::string joined(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

}  // namespace

const JsonNode* JsonNode::find(std::string_view name) const {
  if (const Object* object_value = object()) {
    for (const JsonNode& member : object_value->members) {
      if (member.key == name) return &member;
    }
  }
  return nullptr;
}

std::string JsonNode::describe() const {
  if (is_null()) return "null";
  if (const bool* v = std::get_if<bool>(&value)) return *v ? "true" : "false";
  if (const double* v = number()) return "number " + (text.empty() ? show_number(*v, 6) : text);
  if (const std::string* v = string()) return "string \"" + v->substr(0, 40) + "\"";
  if (const Array* v = array()) return "a list of " + std::to_string(v->size());
  return "an object";
}

Result<JsonNode> parse_json(std::string_view text, const std::string& file) {
  Place place;
  TreeBuilder builder(place, text.size(), file);
  const CountingIterator begin(text.data(), &place);
  const CountingIterator end(text.data() + text.size(), &place);
  const bool parsed = nlohmann::json::sax_parse(begin, end, &builder);
  if (auto error = builder.error()) return *error;
  if (!parsed) return Error{file, place.line, {}, "not JSON", "a JSON value"};
  return std::move(builder.root);
}

JsonFields::JsonFields(const JsonNode* node, std::string file, std::string path, std::optional<Error>& error)
    : node_(node), file_(std::move(file)), path_(std::move(path)), error_(error) {
  if (node_ && !node_->is_null() && !node_->object()) fail(node_, {}, node_->describe(), "an object");
}

std::string JsonFields::path_of(std::string_view key) const {
  return key.empty() ? path_ : joined(path_, key);
}

void JsonFields::fail(const JsonNode* at, std::string_view key, std::string what, std::string expected) const {
  if (error_) return;
  const int line = at ? at->line : node_ ? node_->line : 0;
  error_ = Error{file_, line, path_of(key), std::move(what), std::move(expected)};
}

bool JsonFields::has(std::string_view key) const {
  const JsonNode* node = find(key);
  return node && !node->is_null();
}

double JsonFields::number(std::string_view key) const {
  if (!has(key)) return std::nan("");
  const JsonNode* node = find(key);
  const double* v = node->number();
  if (v && is_plausible(*v)) return without_dust(*v);
  fail(node, key, node->describe(), v ? kPlausible : "a number or null");
  return std::nan("");
}

double JsonFields::share(std::string_view key) const {
  const double v = number(key);
  if (v < 0 || v > 1) fail(find(key), key, find(key)->describe(), "a share between 0 and 1");
  return v;
}

bool JsonFields::flag(std::string_view key) const {
  if (!has(key)) return false;
  const JsonNode* node = find(key);
  if (const bool* v = std::get_if<bool>(&node->value)) return *v;
  fail(node, key, node->describe(), "true or false");
  return false;
}

std::string JsonFields::text(std::string_view key) const {
  if (!has(key)) return {};
  const JsonNode* node = find(key);
  if (const std::string* v = node->string()) return *v;
  fail(node, key, node->describe(), "a string or null");
  return {};
}

std::string JsonFields::required_text(std::string_view key) const {
  if (!has(key)) fail(find(key), key, find(key) ? "null" : "missing", "a string");
  return text(key);
}

double JsonFields::required_number(std::string_view key) const {
  if (!has(key)) fail(find(key), key, find(key) ? "null" : "missing", "a number");
  return number(key);
}

std::string JsonFields::digits(std::string_view key) const {
  if (!has(key)) return {};
  const JsonNode* node = find(key);
  if (!node->text.empty()) return node->text;
  fail(node, key, node->describe(), "an integer or null");
  return {};
}

std::vector<std::pair<const JsonNode*, std::string>> JsonFields::list(std::string_view key, bool required) const {
  std::vector<std::pair<const JsonNode*, std::string>> out;
  if (!has(key)) {
    if (required) fail(find(key), key, find(key) ? "null" : "missing", "a list");
    return out;
  }
  const JsonNode* node = find(key);
  const JsonNode::Array* elements = node->array();
  if (!elements) {
    fail(node, key, node->describe(), "a list");
    return out;
  }
  for (std::size_t i = 0; i < elements->size(); ++i) {
    out.emplace_back(&(*elements)[i], path_of(key) + "[" + std::to_string(i) + "]");
  }
  return out;
}

std::vector<double> JsonFields::numbers(std::string_view key, std::size_t size) const {
  if (!has(key)) return {};
  return json_numbers(*find(key), size, file_, path_of(key), error_);
}

JsonFields JsonFields::object(std::string_view key) const {
  return JsonFields(find(key), file_, path_of(key), error_);
}

std::vector<double> json_numbers(const JsonNode& node, std::size_t size, const std::string& file,
                                 const std::string& path, std::optional<Error>& error) {
  const JsonNode::Array* elements = node.array();
  std::vector<double> out;
  if (elements && elements->size() == size) {
    for (const JsonNode& element : *elements) {
      if (element.number()) {
        if (!is_plausible(*element.number())) {
          if (!error) error = Error{file, element.line, path, element.describe(), kPlausible};
          break;
        }
        out.push_back(without_dust(*element.number()));
      } else if (element.is_null()) {
        out.push_back(std::nan(""));
      } else {
        break;
      }
    }
  }
  if (out.size() == size) return out;
  if (!error) error = Error{file, node.line, path, node.describe(), "a list of " + std::to_string(size) + " numbers"};
  return std::vector<double>(size, std::nan(""));
}

}  // namespace canyon::report
