#include "canyon/study/tradeoff/ladders/config_keys.h"

#include "canyon/core/config/text.h"

namespace canyon::study {
namespace {

class KeyList final : public FieldVisitor {
 public:
  KeyList(std::string prefix, std::vector<ConfigKey>& out) : prefix_(std::move(prefix)), out_(out) {}

  void number(const char* key, double& value, Range, const char*) override { add(key, number_text(value)); }
  void integer(const char* key, std::int64_t& value, Range, const char*) override { add(key, std::to_string(value)); }
  void flag(const char* key, bool& value, const char*) override { add(key, value ? "true" : "false"); }
  void text(const char* key, std::string& value, const char*) override { add(key, value); }
  void file(const char* key, std::string& value, std::string_view, const char*) override { add(key, value); }
  void files(const char* key, std::vector<std::string>&, const char*) override { add(key, ""); }
  void choice(const char* key, std::string& value, const std::vector<std::string>& allowed, const char*) override {
    add(key, value);
    out_.back().choices = allowed;
  }
  void choices(const char* key, std::vector<std::string>& value, const std::vector<std::string>& allowed,
               const char*) override {
    std::string together;
    for (const std::string& name : value) together += (together.empty() ? "" : "+") + name;
    add(key, together);
    out_.back().choices = allowed;
  }
  void numbers(const char* key, std::vector<double>&, std::size_t, Range, const char*) override { add(key, ""); }
  void texts(const char* key, std::vector<std::string>&, const char*) override { add(key, ""); }

 protected:
  void group_impl(const char* key, const char*, const std::function<void(FieldVisitor&)>& body) override {
    KeyList inner(path(key) + ".", out_);
    body(inner);
  }
  void list_impl(const char* key, const char*, std::size_t size, const std::function<void(std::size_t)>& resize,
                 const std::function<void(std::size_t, FieldVisitor&)>& item) override {
    if (size == 0) resize(1);
    KeyList inner(path(key) + "[].", out_);
    item(0, inner);
    if (size == 0) resize(0);
  }

 private:
  std::string path(const char* key) const { return prefix_ + key; }
  void add(const char* key, std::string value) { out_.push_back({path(key), std::move(value), {}}); }

  std::string prefix_;
  std::vector<ConfigKey>& out_;
};

}  // namespace

std::vector<ConfigKey> config_keys(const VisitFunction& visit_fields) {
  std::vector<ConfigKey> keys;
  KeyList list("", keys);
  visit_fields(list);
  return keys;
}

const ConfigKey* find_key(const std::vector<ConfigKey>& keys, const std::string& key) {
  for (const ConfigKey& one : keys)
    if (one.key == key) return &one;
  return nullptr;
}

}  // namespace canyon::study
