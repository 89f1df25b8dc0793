#include "inertial/catalogue.h"

#include <cmath>
#include <limits>

#include "core/embedded.h"
#include "core/files.h"
#include "core/units.h"
#include "inertial/imu_model.h"

namespace canyon::inertial {
namespace {

constexpr std::string_view kFolder = "inertial/catalogue/";
constexpr std::string_view kSuffix = ".toml";

void figure(FieldVisitor& f, const char* key, const char* source_key, Figure& figure, Range range, const char* doc) {
  f.number(key, figure.value, range, doc);
  f.text(source_key, figure.source, "where that figure was read");
}

bool ends_with(std::string_view text, std::string_view suffix) {
  return text.size() > suffix.size() && text.substr(text.size() - suffix.size()) == suffix;
}

}  // namespace

void visit(FieldVisitor& f, GyroSheet& c) {
  figure(f, "arw_deg_per_sqrt_hr", "arw_source", c.arw_deg_per_sqrt_hr, {0, 1e3}, "angular random walk");
  figure(f, "turn_on_bias_deg_per_hr", "turn_on_bias_source", c.turn_on_bias_deg_per_hr, {0, 1e6},
         "bias constant over a run, 1-sigma");
  figure(f, "in_run_bias_deg_per_hr", "in_run_bias_source", c.in_run_bias_deg_per_hr, {0, 1e6},
         "stationary 1-sigma of the Gauss-Markov bias");
  figure(f, "in_run_bias_tau_s", "in_run_bias_tau_source", c.in_run_bias_tau_s, {1e-3, 1e9}, "its correlation time");
  figure(f, "scale_ppm", "scale_source", c.scale_ppm, {0, 1e5}, "scale-factor error, 1-sigma");
  figure(f, "misalignment_mrad", "misalignment_source", c.misalignment_mrad, {0, 100},
         "each off-diagonal term, 1-sigma");
}

void visit(FieldVisitor& f, AccelSheet& c) {
  figure(f, "vrw_m_s_per_sqrt_hr", "vrw_source", c.vrw_m_s_per_sqrt_hr, {0, 1e3}, "velocity random walk");
  figure(f, "turn_on_bias_mg", "turn_on_bias_source", c.turn_on_bias_mg, {0, 1e4}, "bias constant over a run, 1-sigma");
  figure(f, "in_run_bias_mg", "in_run_bias_source", c.in_run_bias_mg, {0, 1e4},
         "stationary 1-sigma of the Gauss-Markov bias");
  figure(f, "in_run_bias_tau_s", "in_run_bias_tau_source", c.in_run_bias_tau_s, {1e-3, 1e9}, "its correlation time");
  figure(f, "scale_ppm", "scale_source", c.scale_ppm, {0, 1e5}, "scale-factor error, 1-sigma");
  figure(f, "misalignment_mrad", "misalignment_source", c.misalignment_mrad, {0, 100},
         "each off-diagonal term, 1-sigma");
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
  f.group("gyro", c.gyro, "gyroscope triad");
  f.group("accel", c.accel, "accelerometer triad");
  f.group("paper", c.paper, "parameters of the error chain of Durst & Goodin 2012");
}

ImuNoise CatalogueEntry::noise() const {
  const double deg_per_hr = kDegree / kHour;
  const double per_sqrt_hr = 1.0 / std::sqrt(kHour);
  ImuNoise n;
  n.gyro.white_per_sqrt_hz = gyro.arw_deg_per_sqrt_hr.value * kDegree * per_sqrt_hr;
  n.gyro.turn_on_bias_sigma = gyro.turn_on_bias_deg_per_hr.value * deg_per_hr;
  n.gyro.in_run_bias_sigma = gyro.in_run_bias_deg_per_hr.value * deg_per_hr;
  n.gyro.in_run_bias_tau_s = gyro.in_run_bias_tau_s.value;
  n.gyro.scale_sigma = gyro.scale_ppm.value * 1e-6;
  n.gyro.misalignment_sigma_rad = gyro.misalignment_mrad.value * 1e-3;
  n.accel.white_per_sqrt_hz = accel.vrw_m_s_per_sqrt_hr.value * per_sqrt_hr;
  n.accel.turn_on_bias_sigma = accel.turn_on_bias_mg.value * kMilliG;
  n.accel.in_run_bias_sigma = accel.in_run_bias_mg.value * kMilliG;
  n.accel.in_run_bias_tau_s = accel.in_run_bias_tau_s.value;
  n.accel.scale_sigma = accel.scale_ppm.value * 1e-6;
  n.accel.misalignment_sigma_rad = accel.misalignment_mrad.value * 1e-3;
  return n;
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

/// A number that nobody can trace is worse than none: every figure that acts must say where it was read.
Status check_sources(const CatalogueEntry& e, const ConfigNode& node) {
  struct Row {
    const char* table;
    const char* key;
    const Figure& figure;
  };
  const Row rows[] = {
      {"gyro", "arw_source", e.gyro.arw_deg_per_sqrt_hr},
      {"gyro", "turn_on_bias_source", e.gyro.turn_on_bias_deg_per_hr},
      {"gyro", "in_run_bias_source", e.gyro.in_run_bias_deg_per_hr},
      {"gyro", "scale_source", e.gyro.scale_ppm},
      {"gyro", "misalignment_source", e.gyro.misalignment_mrad},
      {"accel", "vrw_source", e.accel.vrw_m_s_per_sqrt_hr},
      {"accel", "turn_on_bias_source", e.accel.turn_on_bias_mg},
      {"accel", "in_run_bias_source", e.accel.in_run_bias_mg},
      {"accel", "scale_source", e.accel.scale_ppm},
      {"accel", "misalignment_source", e.accel.misalignment_mrad},
  };
  for (const Row& row : rows) {
    if (row.figure.value == 0.0 || !row.figure.source.empty()) continue;
    const ConfigNode* table = node.find(row.table);
    return (table ? *table : node)
        .error(std::string(row.table) + "." + row.key, "is missing", "the source of a figure that is not zero");
  }
  return Ok{};
}

Result<CatalogueEntry> entry_from(const ConfigNode& node) {
  CatalogueEntry entry;
  // Noise that is not there must be said to be zero: a forgotten line would make a perfect sensor.
  for (Figure* figure : {&entry.gyro.arw_deg_per_sqrt_hr, &entry.gyro.turn_on_bias_deg_per_hr,
                         &entry.gyro.in_run_bias_deg_per_hr, &entry.gyro.scale_ppm, &entry.gyro.misalignment_mrad,
                         &entry.accel.vrw_m_s_per_sqrt_hr, &entry.accel.turn_on_bias_mg, &entry.accel.in_run_bias_mg,
                         &entry.accel.scale_ppm, &entry.accel.misalignment_mrad})
    figure->value = std::numeric_limits<double>::quiet_NaN();
  CANYON_TRY_STATUS(read_config(&node, "", entry));
  CANYON_TRY_STATUS(check_sources(entry, node));
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
