#include <nlohmann/json.hpp>

#include "canyon/core/config/config.h"
#include "canyon/core/files/json_text.h"

namespace canyon {
namespace {

using Json = nlohmann::ordered_json;

/// Collects fields in the order they are declared.
class JsonWriter final : public FieldVisitor {
 public:
  explicit JsonWriter(Json& object) : object_(object) { object_ = Json::object(); }

  void number(const char* key, double& value, Range, const char*) override { object_[key] = value; }
  void integer(const char* key, std::int64_t& value, Range, const char*) override { object_[key] = value; }
  void flag(const char* key, bool& value, const char*) override { object_[key] = value; }
  void text(const char* key, std::string& value, const char*) override { object_[key] = value; }
  void file(const char* key, std::string& value, std::string_view, const char*) override { object_[key] = value; }
  void files(const char* key, std::vector<std::string>& value, const char*) override { object_[key] = value; }
  void choice(const char* key, std::string& value, const std::vector<std::string>&, const char*) override {
    object_[key] = value;
  }
  void choices(const char* key, std::vector<std::string>& value, const std::vector<std::string>&,
               const char*) override {
    object_[key] = value;
  }
  void numbers(const char* key, std::vector<double>& value, std::size_t, Range, const char*) override {
    object_[key] = value;
  }
  void texts(const char* key, std::vector<std::string>& value, const char*) override { object_[key] = value; }

 protected:
  void group_impl(const char* key, const char*, const std::function<void(FieldVisitor&)>& body) override {
    JsonWriter inner(object_[key]);
    body(inner);
  }

  void list_impl(const char* key, const char*, std::size_t size, const std::function<void(std::size_t)>&,
                 const std::function<void(std::size_t, FieldVisitor&)>& item) override {
    Json list = Json::array();
    for (std::size_t i = 0; i < size; ++i) {
      Json element;
      JsonWriter inner(element);
      item(i, inner);
      list.push_back(std::move(element));
    }
    object_[key] = std::move(list);
  }

 private:
  Json& object_;
};

}  // namespace

std::string fields_as_json(const VisitFunction& visit_fields) {
  Json object;
  JsonWriter writer(object);
  visit_fields(writer);
  // Numbers come out in the shortest form that reads back to the same bits: at most 17 significant digits.
  return json_text(object);
}

}  // namespace canyon
