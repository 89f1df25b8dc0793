#include <cmath>

#include "canyon/core/config/config.h"
#include "canyon/core/config/text.h"

namespace canyon {
namespace {

struct UnitRow {
  std::string_view suffix;
  const char* unit;
};
/// How key names end; an ending stands before any that is part of it.
constexpr UnitRow kUnits[] = {
    {"_deg_per_m_s2", "deg s²/m"},
    {"_percent_per_m_s2", "% s²/m"},
    {"_deg_per_sqrt_hr", "deg/√h"},
    {"_m_s_per_sqrt_hr", "m/s/√h"},
    {"_m_s_per_sqrt_s", "m/s/√s"},
    {"_m_per_sqrt_s", "m/√s"},
    {"_px_per_rad", "px/rad"},
    {"_per_deg", "1/deg"},
    {"_m2_hz", "m² Hz"},
    {"_1_m2", "1/m²"},
    {"_m2", "m²"},
    {"_pa_per_sqrt_hz", "Pa/√Hz"},
    {"_ut_per_sqrt_hz", "µT/√Hz"},
    {"_hpa", "hPa"},
    {"_pa", "Pa"},
    {"_ut", "µT"},
    {"_m_s2", "m/s²"},
    {"_deg_s", "deg/s"},
    {"_deg", "deg"},
    {"_m_s", "m/s"},
    {"_1_m", "1/m"},
    {"_mm_per_km", "mm/km"},
    {"_km", "km"},
    {"_db_per_m", "dB/m"},
    {"_dbhz", "dB-Hz"},
    {"_db", "dB"},
    {"_mhz", "MHz"},
    {"_hz", "Hz"},
    {"_c", "°C"},
    {"_tecu", "TECU"},
    {"_chips", "chips"},
    {"_ppm", "ppm"},
    {"_mrad", "mrad"},
    {"_ns", "ns"},
    {"_ms", "ms"},
    {"_s", "s"},
    {"_m", "m"},
};

const char* unit_of(std::string_view key) {
  for (const UnitRow& row : kUnits)
    if (key.ends_with(row.suffix)) return row.unit;
  return "";
}

class Documenter final : public FieldVisitor {
 public:
  Documenter(std::string prefix, std::vector<FieldDoc>& out) : prefix_(std::move(prefix)), out_(out) {}

  void number(const char* key, double& value, Range range, const char* doc) override {
    row(key, unit_of(key), std::isnan(value) ? "required" : number_text(value), range_text(range, false), doc);
  }
  void integer(const char* key, std::int64_t& value, Range range, const char* doc) override {
    row(key, unit_of(key), std::to_string(value), range_text(range, true), doc);
  }
  void flag(const char* key, bool& value, const char* doc) override {
    row(key, "", value ? "true" : "false", "true or false", doc);
  }
  void text(const char* key, std::string& value, const char* doc) override {
    row(key, "", "\"" + value + "\"", "a string", doc);
  }
  void file(const char* key, std::string& value, std::string_view suffix, const char* doc) override {
    row(key, "", "\"" + value + "\"",
        suffix.empty() ? "a path" : "a name, or a path that ends in " + std::string(suffix), doc);
  }
  void files(const char* key, std::vector<std::string>& value, const char* doc) override {
    row(key, "", "[" + quoted_list(value) + "]", "a list of paths", doc);
  }
  void choice(const char* key, std::string& value, const std::vector<std::string>& allowed, const char* doc) override {
    row(key, "", "\"" + value + "\"", "one of " + quoted_list(allowed), doc);
  }
  void choices(const char* key, std::vector<std::string>& value, const std::vector<std::string>& allowed,
               const char* doc) override {
    row(key, "", "[" + quoted_list(value) + "]", "a list out of " + quoted_list(allowed), doc);
  }
  void numbers(const char* key, std::vector<double>& value, std::size_t size, Range range, const char* doc) override {
    std::string list;
    bool required = false;
    for (const double v : value) {
      list += (list.empty() ? "" : ", ") + number_text(v);
      required = required || std::isnan(v);
    }
    const std::string count = size > 0 ? std::to_string(size) + " numbers" : "numbers";
    row(key, unit_of(key), required ? "required" : "[" + list + "]",
        "a list of " + count + ", each " + range_text(range, false), doc);
  }
  void texts(const char* key, std::vector<std::string>& value, const char* doc) override {
    row(key, "", "[" + quoted_list(value) + "]", "a list of strings", doc);
  }

 protected:
  void group_impl(const char* key, const char*, const std::function<void(FieldVisitor&)>& body) override {
    Documenter inner(path(key), out_);
    body(inner);
  }

  void list_impl(const char* key, const char* doc, std::size_t size, const std::function<void(std::size_t)>& resize,
                 const std::function<void(std::size_t, FieldVisitor&)>& item) override {
    row(key, "", std::to_string(size) + (size == 1 ? " item" : " items"), "a list of tables", doc);
    // The keys of an item are shown once; an empty list lends its type's defaults for that.
    if (size == 0) resize(1);
    Documenter inner(path(key) + "[]", out_);
    item(0, inner);
    if (size == 0) resize(0);
  }

 private:
  std::string path(const std::string& key) const { return prefix_.empty() ? key : prefix_ + "." + key; }

  void row(const char* key, std::string unit, std::string value, std::string range, const char* doc) {
    out_.push_back({path(key), std::move(unit), std::move(value), std::move(range), doc});
  }

  std::string prefix_;
  std::vector<FieldDoc>& out_;
};

}  // namespace

std::vector<FieldDoc> documented_fields(const std::string& prefix, const VisitFunction& visit_fields) {
  std::vector<FieldDoc> rows;
  Documenter documenter(prefix, rows);
  visit_fields(documenter);
  return rows;
}

}  // namespace canyon
