#include "canyon/study/stress/sweep/key_values.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/config/text.h"

namespace canyon::study {
namespace {

constexpr int kDecades = 12;

/// Both ends, the decades between, and what stands for none; in rising order, each once.
std::vector<double> values_of(Range range) {
  std::vector<double> values{range.min, range.max};
  const auto add = [&](double value) {
    if (value > range.min && value < range.max) values.push_back(value);
  };
  add(0.0);
  for (int power = -kDecades; power <= kDecades; ++power) {
    add(std::pow(10.0, power));
    add(-std::pow(10.0, power));
  }
  if (!std::isnan(range.unset)) values.push_back(range.unset);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

class ValueList final : public FieldVisitor {
 public:
  ValueList(std::string prefix, std::vector<SweptKey>& out) : prefix_(std::move(prefix)), out_(out) {}

  void number(const char* key, double&, Range range, const char*) override {
    std::vector<std::string> values;
    for (const double value : values_of(range)) values.push_back(number_text(value));
    add(key, true, std::move(values));
  }
  void integer(const char* key, std::int64_t&, Range range, const char*) override {
    std::vector<std::string> values;
    for (const double value : values_of(range))
      if (value == std::round(value) && std::abs(value) < 9e18)
        values.push_back(std::to_string(static_cast<std::int64_t>(value)));
    add(key, true, std::move(values));
  }
  void flag(const char* key, bool&, const char*) override { add(key, false, {"false", "true"}); }
  void text(const char*, std::string&, const char*) override {}
  void file(const char*, std::string&, std::string_view, const char*) override {}
  void files(const char*, std::vector<std::string>&, const char*) override {}
  void choice(const char* key, std::string&, const std::vector<std::string>& allowed, const char*) override {
    std::vector<std::string> values;
    for (const std::string& name : allowed) values.push_back("\"" + name + "\"");
    add(key, false, std::move(values));
  }
  void choices(const char* key, std::vector<std::string>&, const std::vector<std::string>& allowed,
               const char*) override {
    std::vector<std::string> values{"[]"};
    std::string all;
    for (const std::string& name : allowed) {
      values.push_back("[\"" + name + "\"]");
      all += (all.empty() ? "\"" : ",\"") + name + "\"";
    }
    values.push_back("[" + all + "]");
    add(key, false, std::move(values));
  }
  void numbers(const char* key, std::vector<double>&, std::size_t size, Range range, const char*) override {
    if (size == 0) return;
    std::vector<std::string> values;
    for (const double value : values_of(range)) {
      std::string list;
      for (std::size_t i = 0; i < size; ++i) list += (i > 0 ? "," : "") + number_text(value);
      values.push_back("[" + list + "]");
    }
    add(key, true, std::move(values));
  }
  void texts(const char*, std::vector<std::string>&, const char*) override {}

 protected:
  void group_impl(const char* key, const char*, const std::function<void(FieldVisitor&)>& body) override {
    ValueList inner(prefix_ + key + ".", out_);
    body(inner);
  }
  void list_impl(const char*, const char*, std::size_t, const std::function<void(std::size_t)>&,
                 const std::function<void(std::size_t, FieldVisitor&)>&) override {}

 private:
  void add(const char* key, bool numeric, std::vector<std::string> values) {
    out_.push_back({prefix_ + key, numeric, std::move(values)});
  }

  std::string prefix_;
  std::vector<SweptKey>& out_;
};

}  // namespace

std::vector<SweptKey> swept_keys(const VisitFunction& visit_fields) {
  std::vector<SweptKey> keys;
  ValueList list("", keys);
  visit_fields(list);
  return keys;
}

}  // namespace canyon::study
