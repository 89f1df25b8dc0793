#include "core/config.h"
#include "core/config_text.h"

namespace canyon {
namespace {

/// In a Markdown table a bar would end the cell.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : c == '\n' ? std::string(" ") : std::string(1, c);
  return out;
}

class MarkdownWriter final : public FieldVisitor {
 public:
  MarkdownWriter(std::string prefix, std::string& out) : prefix_(std::move(prefix)), out_(out) {}

  void number(const char* key, double& value, Range range, const char* doc) override {
    row(key, number_text(value), range_text(range, false), doc);
  }
  void integer(const char* key, std::int64_t& value, Range range, const char* doc) override {
    row(key, std::to_string(value), range_text(range, true), doc);
  }
  void flag(const char* key, bool& value, const char* doc) override {
    row(key, value ? "true" : "false", "true or false", doc);
  }
  void text(const char* key, std::string& value, const char* doc) override {
    row(key, "\"" + value + "\"", "a string", doc);
  }
  void choice(const char* key, std::string& value, const std::vector<std::string>& allowed, const char* doc) override {
    row(key, "\"" + value + "\"", "one of " + quoted_list(allowed), doc);
  }
  void numbers(const char* key, std::vector<double>& value, std::size_t size, Range range, const char* doc) override {
    std::string list;
    for (const double v : value) list += (list.empty() ? "" : ", ") + number_text(v);
    const std::string count = size > 0 ? std::to_string(size) + " numbers" : "numbers";
    row(key, "[" + list + "]", "a list of " + count + ", each " + range_text(range, false), doc);
  }
  void texts(const char* key, std::vector<std::string>& value, const char* doc) override {
    row(key, "[" + quoted_list(value) + "]", "a list of strings", doc);
  }

 protected:
  void group_impl(const char* key, const char*, const std::function<void(FieldVisitor&)>& body) override {
    MarkdownWriter inner(path(key), out_);
    body(inner);
  }

  void list_impl(const char* key, const char* doc, std::size_t size, const std::function<void(std::size_t)>& resize,
                 const std::function<void(std::size_t, FieldVisitor&)>& item) override {
    row(key, std::to_string(size) + (size == 1 ? " item" : " items"), "a list of tables", doc);
    // The keys of an item are shown once; an empty list lends its type's defaults for that.
    if (size == 0) resize(1);
    MarkdownWriter inner(path(key) + "[]", out_);
    item(0, inner);
    if (size == 0) resize(0);
  }

 private:
  std::string path(const std::string& key) const { return prefix_.empty() ? key : prefix_ + "." + key; }

  void row(const std::string& key, const std::string& value, const std::string& range, const char* doc) {
    out_ += "| `" + cell(path(key)) + "` | " + cell(value) + " | " + cell(range) + " | " + cell(doc) + " |\n";
  }

  std::string prefix_;
  std::string& out_;
};

}  // namespace

std::string fields_as_markdown(const std::string& prefix, const VisitFunction& visit_fields) {
  std::string rows;
  MarkdownWriter writer(prefix, rows);
  visit_fields(writer);
  return rows;
}

}  // namespace canyon
