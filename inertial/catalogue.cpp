#include "canyon/inertial/catalogue.h"

#include <cmath>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/config/text.h"
#include "canyon/core/files/files.h"
#include "canyon/core/process/embedded.h"
#include "canyon/core/units.h"
#include "canyon/inertial/catalogue/sheet_rows.h"
#include "canyon/inertial/imu_model.h"

namespace canyon::inertial {
namespace {

constexpr std::string_view kFolder = "inertial/catalogue/";
constexpr std::string_view kSuffix = ".toml";

template <class Sheet, class Rows>
void visit_sheet(FieldVisitor& f, Sheet& sheet, const Rows& rows) {
  for (const auto& row : rows) {
    f.number(row.key, (sheet.*row.figure).value, row.range, row.doc);
    f.text(row.source_key, (sheet.*row.figure).source, "where that figure was read");
  }
}

template <class Sheet, class Rows, class Figures>
void to_si(const Sheet& sheet, const Rows& rows, Figures& figures) {
  for (const auto& row : rows) {
    if (row.si) figures.*row.si = (sheet.*row.figure).value * row.unit;
  }
}

bool ends_with(std::string_view text, std::string_view suffix) {
  return text.size() > suffix.size() && text.substr(text.size() - suffix.size()) == suffix;
}

}  // namespace

void visit(FieldVisitor& f, GyroSheet& c) {
  visit_sheet<GyroSheet>(f, c, gyro_rows());
}

void visit(FieldVisitor& f, AccelSheet& c) {
  visit_sheet<AccelSheet>(f, c, accel_rows());
}

void visit(FieldVisitor& f, UnitSheet& c) {
  visit_sheet<UnitSheet>(f, c, unit_rows());
}

void visit(FieldVisitor& f, PaperTriad& c) {
  f.number("quality_factor", c.quality_factor, {1e-3, 1e7},
           "Q of the resonator; as printed also in the quantization term");
  f.number("mass_kg", c.mass_kg, {1e-15, 1e-3}, "proof mass");
  f.number("resonance_hz", c.resonance_hz, {1, 1e7}, "fundamental frequency of the spring-mass system");
  f.number("drive_amplitude_m", c.drive_amplitude_m, {0, 1e-3}, "drive amplitude (gyroscope only)");
  f.number("bandwidth_hz", c.bandwidth_hz, {1e-3, 1e6}, "noise bandwidth B (gyroscope, as printed)");
  f.number("white_process", c.white_process, {0, 1e3}, "white noise process coefficient, deg/s or m/s^2");
  f.number("zero_offset", c.zero_offset, {-1e3, 1e3}, "mean offset from zero, deg/s or m/s^2");
  f.number("quantization", c.quantization, {0, 1e3},
           "quantization coefficient of IEEE Std 952 (corrected), deg or m/s");
}

void visit(FieldVisitor& f, PaperParameters& c) {
  f.flag("given", c.given, "this entry can be used with the paper's error chain");
  f.number("temperature_k", c.temperature_k, {1, 1000}, "sensor temperature");
  f.number("correlation_time_s", c.correlation_time_s, {1e-3, 1e9}, "tau of the recursion");
  f.number("run_time_hr", c.run_time_hr, {1e-6, 1e6}, "total run time in the quantization term as printed");
  f.group("gyro", c.gyro, "gyroscope");
  f.group("accel", c.accel, "accelerometer");
  f.text("source", c.source, "where these figures come from");
}

void visit(FieldVisitor& f, CatalogueEntry& c) {
  f.text("name", c.name, "name of the unit");
  f.text("description", c.description, "one line");
  f.flag("has_gyroscope", c.has_gyroscope, "false: an accelerometer alone; there is no [gyro] table then");
  f.flag("in_run_bias_is_instability", c.in_run_bias_is_instability,
         "the Gauss-Markov bias and bias_instability are the same measured floor: not both at once");
  f.group("gyro", c.gyro, "gyroscope triad");
  f.group("accel", c.accel, "accelerometer triad");
  f.group("unit", c.unit, "the unit as a whole");
  f.group("paper", c.paper, "parameters of the error chain of Durst & Goodin 2012");
  f.group("mems", c.mems, "proof masses, pick-offs and electronics");
}

namespace {

TriadNoise noise_of(const TriadFigures& f) {
  return {.white_per_sqrt_hz = f.white_per_sqrt_hz,
          .turn_on_bias_sigma = f.turn_on_bias,
          .in_run_bias_sigma = f.in_run_bias,
          .in_run_bias_tau_s = f.in_run_bias_tau_s,
          .scale_sigma = f.scale,
          .misalignment_sigma_rad = f.misalignment_rad};
}

}  // namespace

ImuNoise CatalogueEntry::noise() const {
  const UnitFigures f = figures();
  return {.gyro = noise_of(f.gyro), .accel = noise_of(f.accel)};
}

UnitFigures CatalogueEntry::figures() const {
  UnitFigures f;
  to_si(gyro, gyro_rows(), f.gyro);
  to_si(accel, accel_rows(), f.accel);
  to_si(unit, unit_rows(), f);
  return f;
}

std::vector<std::string> catalogue_names() {
  std::vector<std::string> names;
  for (std::string_view key : embedded_files(kFolder)) {
    if (!ends_with(key, kSuffix)) continue;
    names.emplace_back(key.substr(kFolder.size(), key.size() - kFolder.size() - kSuffix.size()));
  }
  return names;
}

namespace {

/// A number that nobody can trace is worse than none: every figure that acts must say where it was read. `lacking`:
/// the keys of sources that are not there, and `place` the table of the first of them.
struct Sources {
  std::vector<std::string> lacking;
  const ConfigNode* place = nullptr;
};
template <class Sheet, class Rows>
void check_sources(const char* table, const Sheet& sheet, const Rows& rows, const ConfigNode& node, Sources& sources) {
  for (const auto& row : rows) {
    const Figure& figure = sheet.*row.figure;
    if (row.need == row.kHasDefault || !(std::abs(figure.value) > 0.0) || !figure.source.empty()) continue;
    if (sources.place == nullptr) sources.place = node.find(table) ? node.find(table) : &node;
    sources.lacking.push_back(std::string(table) + "." + row.source_key);
  }
}

Sources check_sources(const CatalogueEntry& entry, const ConfigNode& node) {
  Sources sources;
  check_sources("gyro", entry.gyro, gyro_rows(), node, sources);
  check_sources("accel", entry.accel, accel_rows(), node, sources);
  check_sources("unit", entry.unit, unit_rows(), node, sources);
  return sources;
}

std::string and_so_are(const std::vector<std::string>& keys, std::size_t from) {
  if (from >= keys.size()) return "";
  return ", and so are " + plain_list({keys.begin() + static_cast<std::ptrdiff_t>(from), keys.end()});
}

/// Noise that is not there must be said to be zero: a forgotten line would make a perfect sensor.
template <class Sheet, class Rows>
void require(Sheet& sheet, const Rows& rows) {
  for (const auto& row : rows) {
    if (row.need == row.kRequired) (sheet.*row.figure).value = std::numeric_limits<double>::quiet_NaN();
  }
}

Status check_corners(const char* table, double low_hz, double high_hz, const ConfigNode& node) {
  if (low_hz < high_hz) return Ok{};
  const ConfigNode* place = node.find(table);
  return (place ? *place : node)
      .error(std::string(table) + ".flicker_low_hz", join_values(low_hz, " Hz is not below the upper corner"),
             join_values("less than flicker_high_hz = ", high_hz));
}

Result<CatalogueEntry> entry_from(const ConfigNode& node) {
  CatalogueEntry entry;
  const ConfigNode* has_gyroscope = node.find("has_gyroscope");
  const bool* given = has_gyroscope ? std::get_if<bool>(&has_gyroscope->value_) : nullptr;
  if (!given || *given) {
    require(entry.gyro, gyro_rows());
  } else if (const ConfigNode* gyro = node.find("gyro")) {
    return gyro->error("gyro", "has_gyroscope = false, but there is a [gyro] table", "one of the two");
  }
  require(entry.accel, accel_rows());
  const Status read = read_config(&node, "", entry);
  const Sources sources = check_sources(entry, node);
  if (!read.ok()) {
    Error error = read.error();  // what is missing, all of it in one line; another mistake comes alone
    const bool missing = error.what.rfind("is missing", 0) == 0;
    if (missing && !sources.lacking.empty())
      error.what += (error.what == "is missing" ? ", and so are " : ", ") + plain_list(sources.lacking);
    return error;
  }
  if (!sources.lacking.empty())
    return sources.place->error(sources.lacking.front(), "is missing" + and_so_are(sources.lacking, 1),
                                "the source of a figure that is not zero");
  CANYON_TRY_STATUS(check_corners("gyro", entry.gyro.flicker_low_hz.value, entry.gyro.flicker_high_hz.value, node));
  CANYON_TRY_STATUS(check_corners("accel", entry.accel.flicker_low_hz.value, entry.accel.flicker_high_hz.value, node));
  return entry;
}

}  // namespace

Result<CatalogueEntry> parse_catalogue_entry(std::string_view toml, const std::string& file_name) {
  CANYON_TRY(ConfigNode node, ConfigNode::parse(toml, file_name));
  return entry_from(node);
}

Result<CatalogueEntry> load_catalogue_entry(const std::string& sensor) {
  if (ends_with(sensor, kSuffix)) {
    CANYON_TRY(ConfigNode node, ConfigNode::load(sensor));
    return entry_from(node);
  }
  const std::string key = std::string(kFolder) + sensor + std::string(kSuffix);
  if (const auto text = embedded_file(key)) return parse_catalogue_entry(*text, key);

  const std::vector<std::string> known = catalogue_names();
  std::string expected = nearest_word(sensor, known);
  if (expected.empty()) {
    for (const std::string& name : known) expected += (expected.empty() ? "one of " : ", ") + name;
    expected += ", or a .toml file";
  } else {
    expected = "\"" + expected + "\"?";
  }
  return Error{
      .file = "", .key = "imu.sensor", .what = "no sensor \"" + sensor + "\" in the catalogue", .expected = expected};
}

Result<ImuNoise> catalogue_noise(const std::string& sensor) {
  CANYON_TRY(const CatalogueEntry entry, load_catalogue_entry(sensor));
  return entry.noise();
}

}  // namespace canyon::inertial
