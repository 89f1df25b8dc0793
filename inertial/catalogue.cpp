#include "inertial/catalogue.h"

#include <cmath>
#include <limits>

#include "core/check.h"
#include "core/embedded.h"
#include "core/files.h"
#include "core/units.h"
#include "inertial/imu_model.h"

namespace canyon::inertial {
namespace {

constexpr std::string_view kFolder = "inertial/catalogue/";
constexpr std::string_view kSuffix = ".toml";

/// One figure of a sheet: its keys, what it may be, and where it goes in SI.
template <class Sheet, class Figures>
struct SheetRow {
  const char* key;
  const char* source_key;
  Figure Sheet::*figure;
  Range range;
  double unit;                                           ///< one of the sheet's units in SI
  double Figures::*si;                                   ///< null: no link takes it
  enum Need { kRequired, kOptional, kHasDefault } need;  ///< what is missing is: an error; zero; the default
  const char* doc;
};
using GyroRow = SheetRow<GyroSheet, TriadFigures>;
using AccelRow = SheetRow<AccelSheet, TriadFigures>;
using UnitRow = SheetRow<UnitSheet, UnitFigures>;

constexpr double kDegPerHour = kDegree / kHour;
constexpr double kSqrtHour = 60.0;  // sqrt(s)
constexpr double kG = kStandardGravity;

constexpr GyroRow kGyroRows[] = {
    {"arw_deg_per_sqrt_hr",
     "arw_source",
     &GyroSheet::arw_deg_per_sqrt_hr,
     {0, 1e3},
     kDegree / kSqrtHour,
     &TriadFigures::white_per_sqrt_hz,
     GyroRow::kRequired,
     "angular random walk"},
    {"neighbour_correlation",
     "neighbour_correlation_source",
     &GyroSheet::neighbour_correlation,
     {0, 0.5},
     1.0,
     &TriadFigures::neighbour_correlation,
     GyroRow::kOptional,
     "of the white noise, by a low-pass of the sensor that reaches beyond one sample"},
    {"turn_on_bias_deg_per_hr",
     "turn_on_bias_source",
     &GyroSheet::turn_on_bias_deg_per_hr,
     {0, 1e6},
     kDegPerHour,
     &TriadFigures::turn_on_bias,
     GyroRow::kRequired,
     "bias constant over a run, 1-sigma"},
    {"in_run_bias_deg_per_hr",
     "in_run_bias_source",
     &GyroSheet::in_run_bias_deg_per_hr,
     {0, 1e6},
     kDegPerHour,
     &TriadFigures::in_run_bias,
     GyroRow::kRequired,
     "stationary 1-sigma of the Gauss-Markov bias"},
    {"in_run_bias_tau_s",
     "in_run_bias_tau_source",
     &GyroSheet::in_run_bias_tau_s,
     {1e-3, 1e9},
     1.0,
     &TriadFigures::in_run_bias_tau_s,
     GyroRow::kHasDefault,
     "its correlation time"},
    {"scale_ppm",
     "scale_source",
     &GyroSheet::scale_ppm,
     {0, 1e5},
     1e-6,
     &TriadFigures::scale,
     GyroRow::kRequired,
     "scale-factor error, 1-sigma"},
    {"misalignment_mrad",
     "misalignment_source",
     &GyroSheet::misalignment_mrad,
     {0, 100},
     1e-3,
     &TriadFigures::misalignment_rad,
     GyroRow::kRequired,
     "each off-diagonal term, 1-sigma"},
    {"bias_instability_deg_per_hr",
     "bias_instability_source",
     &GyroSheet::bias_instability_deg_per_hr,
     {0, 1e6},
     kDegPerHour,
     &TriadFigures::bias_instability,
     GyroRow::kOptional,
     "floor of the Allan deviation (flicker noise)"},
    {"flicker_low_hz",
     "flicker_low_source",
     &GyroSheet::flicker_low_hz,
     {1e-9, 1e3},
     1.0,
     &TriadFigures::flicker_low_hz,
     GyroRow::kHasDefault,
     "lower corner of the flicker noise"},
    {"flicker_high_hz",
     "flicker_high_source",
     &GyroSheet::flicker_high_hz,
     {1e-9, 1e3},
     1.0,
     &TriadFigures::flicker_high_hz,
     GyroRow::kHasDefault,
     "upper corner of the flicker noise"},
    {"rate_random_walk_deg_per_hr_per_sqrt_hr",
     "rate_random_walk_source",
     &GyroSheet::rate_random_walk_deg_per_hr_per_sqrt_hr,
     {0, 1e6},
     kDegPerHour / kSqrtHour,
     &TriadFigures::rate_random_walk,
     GyroRow::kOptional,
     "rate random walk K"},
    {"ramp_deg_per_hr_per_hr",
     "ramp_source",
     &GyroSheet::ramp_deg_per_hr_per_hr,
     {0, 1e6},
     kDegPerHour / kHour,
     &TriadFigures::ramp,
     GyroRow::kOptional,
     "slope R of the bias; sign drawn"},
    {"quantization_noise_deg",
     "quantization_noise_source",
     &GyroSheet::quantization_noise_deg,
     {0, 90},
     kDegree,
     &TriadFigures::quantization_noise,
     GyroRow::kOptional,
     "quantization coefficient Q of the Allan deviation"},
    {"scale_asymmetry_ppm",
     "scale_asymmetry_source",
     &GyroSheet::scale_asymmetry_ppm,
     {0, 1e5},
     1e-6,
     &TriadFigures::scale_asymmetry,
     GyroRow::kOptional,
     "half the difference of the gains of the two signs, 1-sigma"},
    {"nonlinearity_percent",
     "nonlinearity_source",
     &GyroSheet::nonlinearity_percent,
     {0, 50},
     1e-2,
     &TriadFigures::nonlinearity,
     GyroRow::kOptional,
     "from the best straight line, of the range; needs the range"},
    {"package_misalignment_mrad",
     "package_misalignment_source",
     &GyroSheet::package_misalignment_mrad,
     {0, 200},
     1e-3,
     &TriadFigures::package_rad,
     GyroRow::kOptional,
     "triad against the housing, each rotation, 1-sigma"},
    {"cross_talk_percent",
     "cross_talk_source",
     &GyroSheet::cross_talk_percent,
     {0, 50},
     1e-2,
     &TriadFigures::cross_talk,
     GyroRow::kOptional,
     "cross-axis sensitivity of the channels, 1-sigma"},
    {"g_sensitivity_deg_per_hr_per_g",
     "g_sensitivity_source",
     &GyroSheet::g_sensitivity_deg_per_hr_per_g,
     {0, 1e6},
     kDegPerHour / kG,
     &TriadFigures::g_sensitivity,
     GyroRow::kOptional,
     "bias by specific force, each term, 1-sigma"},
    {"bias_temperature_deg_per_hr_per_k",
     "bias_temperature_source",
     &GyroSheet::bias_temperature_deg_per_hr_per_k,
     {0, 1e6},
     kDegPerHour,
     &TriadFigures::bias_temperature,
     GyroRow::kOptional,
     "bias by temperature, 1-sigma"},
    {"scale_temperature_ppm_per_k",
     "scale_temperature_source",
     &GyroSheet::scale_temperature_ppm_per_k,
     {0, 1e5},
     1e-6,
     &TriadFigures::scale_temperature,
     GyroRow::kOptional,
     "gain by temperature, 1-sigma"},
    {"vibration_rectification_deg_per_hr_per_g2",
     "vibration_rectification_source",
     &GyroSheet::vibration_rectification_deg_per_hr_per_g2,
     {0, 1e6},
     kDegPerHour / (kG * kG),
     &TriadFigures::vibration_rectification,
     GyroRow::kOptional,
     "bias by the mean square of vibration; sign drawn"},
    {"dead_band_deg_per_s",
     "dead_band_source",
     &GyroSheet::dead_band_deg_per_s,
     {0, 1e3},
     kDegree,
     &TriadFigures::dead_band,
     GyroRow::kOptional,
     "smaller outputs are zero"},
    {"range_deg_per_s",
     "range_source",
     &GyroSheet::range_deg_per_s,
     {0, 1e5},
     kDegree,
     &TriadFigures::range,
     GyroRow::kOptional,
     "largest output, either sign; 0 = no limit"},
    {"resolution_deg_per_s",
     "resolution_source",
     &GyroSheet::resolution_deg_per_s,
     {0, 1e3},
     kDegree,
     &TriadFigures::resolution,
     GyroRow::kOptional,
     "step of the output"},
    {"bandwidth_hz",
     "bandwidth_source",
     &GyroSheet::bandwidth_hz,
     {0, 1e6},
     1.0,
     nullptr,
     GyroRow::kOptional,
     "of the output, -3 dB"},
};

constexpr AccelRow kAccelRows[] = {
    {"vrw_m_s_per_sqrt_hr",
     "vrw_source",
     &AccelSheet::vrw_m_s_per_sqrt_hr,
     {0, 1e3},
     1.0 / kSqrtHour,
     &TriadFigures::white_per_sqrt_hz,
     AccelRow::kRequired,
     "velocity random walk"},
    {"neighbour_correlation",
     "neighbour_correlation_source",
     &AccelSheet::neighbour_correlation,
     {0, 0.5},
     1.0,
     &TriadFigures::neighbour_correlation,
     AccelRow::kOptional,
     "of the white noise, by a low-pass of the sensor that reaches beyond one sample"},
    {"turn_on_bias_mg",
     "turn_on_bias_source",
     &AccelSheet::turn_on_bias_mg,
     {0, 1e4},
     kMilliG,
     &TriadFigures::turn_on_bias,
     AccelRow::kRequired,
     "bias constant over a run, 1-sigma"},
    {"in_run_bias_mg",
     "in_run_bias_source",
     &AccelSheet::in_run_bias_mg,
     {0, 1e4},
     kMilliG,
     &TriadFigures::in_run_bias,
     AccelRow::kRequired,
     "stationary 1-sigma of the Gauss-Markov bias"},
    {"in_run_bias_tau_s",
     "in_run_bias_tau_source",
     &AccelSheet::in_run_bias_tau_s,
     {1e-3, 1e9},
     1.0,
     &TriadFigures::in_run_bias_tau_s,
     AccelRow::kHasDefault,
     "its correlation time"},
    {"scale_ppm",
     "scale_source",
     &AccelSheet::scale_ppm,
     {0, 1e5},
     1e-6,
     &TriadFigures::scale,
     AccelRow::kRequired,
     "scale-factor error, 1-sigma"},
    {"misalignment_mrad",
     "misalignment_source",
     &AccelSheet::misalignment_mrad,
     {0, 100},
     1e-3,
     &TriadFigures::misalignment_rad,
     AccelRow::kRequired,
     "each off-diagonal term, 1-sigma"},
    {"bias_instability_mg",
     "bias_instability_source",
     &AccelSheet::bias_instability_mg,
     {0, 1e4},
     kMilliG,
     &TriadFigures::bias_instability,
     AccelRow::kOptional,
     "floor of the Allan deviation (flicker noise)"},
    {"flicker_low_hz",
     "flicker_low_source",
     &AccelSheet::flicker_low_hz,
     {1e-9, 1e3},
     1.0,
     &TriadFigures::flicker_low_hz,
     AccelRow::kHasDefault,
     "lower corner of the flicker noise"},
    {"flicker_high_hz",
     "flicker_high_source",
     &AccelSheet::flicker_high_hz,
     {1e-9, 1e3},
     1.0,
     &TriadFigures::flicker_high_hz,
     AccelRow::kHasDefault,
     "upper corner of the flicker noise"},
    {"rate_random_walk_mg_per_sqrt_hr",
     "rate_random_walk_source",
     &AccelSheet::rate_random_walk_mg_per_sqrt_hr,
     {0, 1e6},
     kMilliG / kSqrtHour,
     &TriadFigures::rate_random_walk,
     AccelRow::kOptional,
     "rate random walk K"},
    {"ramp_mg_per_hr",
     "ramp_source",
     &AccelSheet::ramp_mg_per_hr,
     {0, 1e6},
     kMilliG / kHour,
     &TriadFigures::ramp,
     AccelRow::kOptional,
     "slope R of the bias; sign drawn"},
    {"quantization_noise_m_s",
     "quantization_noise_source",
     &AccelSheet::quantization_noise_m_s,
     {0, 100},
     1.0,
     &TriadFigures::quantization_noise,
     AccelRow::kOptional,
     "quantization coefficient Q of the Allan deviation"},
    {"scale_asymmetry_ppm",
     "scale_asymmetry_source",
     &AccelSheet::scale_asymmetry_ppm,
     {0, 1e5},
     1e-6,
     &TriadFigures::scale_asymmetry,
     AccelRow::kOptional,
     "half the difference of the gains of the two signs, 1-sigma"},
    {"nonlinearity_percent",
     "nonlinearity_source",
     &AccelSheet::nonlinearity_percent,
     {0, 50},
     1e-2,
     &TriadFigures::nonlinearity,
     AccelRow::kOptional,
     "from the best straight line, of the range; needs the range"},
    {"package_misalignment_mrad",
     "package_misalignment_source",
     &AccelSheet::package_misalignment_mrad,
     {0, 200},
     1e-3,
     &TriadFigures::package_rad,
     AccelRow::kOptional,
     "triad against the housing, each rotation, 1-sigma"},
    {"cross_talk_percent",
     "cross_talk_source",
     &AccelSheet::cross_talk_percent,
     {0, 50},
     1e-2,
     &TriadFigures::cross_talk,
     AccelRow::kOptional,
     "cross-axis sensitivity of the channels, 1-sigma"},
    {"bias_temperature_mg_per_k",
     "bias_temperature_source",
     &AccelSheet::bias_temperature_mg_per_k,
     {0, 1e4},
     kMilliG,
     &TriadFigures::bias_temperature,
     AccelRow::kOptional,
     "bias by temperature, 1-sigma"},
    {"scale_temperature_ppm_per_k",
     "scale_temperature_source",
     &AccelSheet::scale_temperature_ppm_per_k,
     {0, 1e5},
     1e-6,
     &TriadFigures::scale_temperature,
     AccelRow::kOptional,
     "gain by temperature, 1-sigma"},
    {"vibration_rectification_mg_per_g2",
     "vibration_rectification_source",
     &AccelSheet::vibration_rectification_mg_per_g2,
     {0, 1e4},
     kMilliG / (kG * kG),
     &TriadFigures::vibration_rectification,
     AccelRow::kOptional,
     "bias by the mean square of vibration; sign drawn"},
    {"dead_band_mg",
     "dead_band_source",
     &AccelSheet::dead_band_mg,
     {0, 1e4},
     kMilliG,
     &TriadFigures::dead_band,
     AccelRow::kOptional,
     "smaller outputs are zero"},
    {"range_g",
     "range_source",
     &AccelSheet::range_g,
     {0, 1e5},
     kG,
     &TriadFigures::range,
     AccelRow::kOptional,
     "largest output, either sign; 0 = no limit"},
    {"resolution_mg",
     "resolution_source",
     &AccelSheet::resolution_mg,
     {0, 1e4},
     kMilliG,
     &TriadFigures::resolution,
     AccelRow::kOptional,
     "step of the output"},
    {"bandwidth_hz",
     "bandwidth_source",
     &AccelSheet::bandwidth_hz,
     {0, 1e6},
     1.0,
     nullptr,
     AccelRow::kOptional,
     "of the output, -3 dB"},
};

constexpr UnitRow kUnitRows[] = {
    {"reference_temperature_c",
     "reference_temperature_source",
     &UnitSheet::reference_temperature_c,
     {-100, 200},
     1.0,
     &UnitFigures::reference_temperature_c,
     UnitRow::kHasDefault,
     "where the other figures hold"},
    {"latency_ms",
     "latency_source",
     &UnitSheet::latency_ms,
     {0, 1e3},
     1e-3,
     &UnitFigures::latency_s,
     UnitRow::kOptional,
     "from the motion to the stamp of the sample"},
    {"clock_skew_ppm",
     "clock_skew_source",
     &UnitSheet::clock_skew_ppm,
     {0, 5e4},
     1e-6,
     &UnitFigures::clock_skew,
     UnitRow::kOptional,
     "error of the unit's clock, 1-sigma"},
    {"clock_jitter_us",
     "clock_jitter_source",
     &UnitSheet::clock_jitter_us,
     {0, 1e5},
     1e-6,
     &UnitFigures::clock_jitter_s,
     UnitRow::kOptional,
     "of each stamp, 1-sigma"},
    {"loss_percent",
     "loss_source",
     &UnitSheet::loss_percent,
     {0, 24},
     1e-2,
     &UnitFigures::loss_share,
     UnitRow::kOptional,
     "samples that do not arrive"},
    {"loss_length",
     "loss_length_source",
     &UnitSheet::loss_length,
     {1, 1000},
     1.0,
     &UnitFigures::loss_length,
     UnitRow::kHasDefault,
     "samples lost together"},
};

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
  visit_sheet<GyroSheet>(f, c, kGyroRows);
}

void visit(FieldVisitor& f, AccelSheet& c) {
  visit_sheet<AccelSheet>(f, c, kAccelRows);
}

void visit(FieldVisitor& f, UnitSheet& c) {
  visit_sheet<UnitSheet>(f, c, kUnitRows);
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
  to_si(gyro, kGyroRows, f.gyro);
  to_si(accel, kAccelRows, f.accel);
  to_si(unit, kUnitRows, f);
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

/// A number that nobody can trace is worse than none: every figure that acts must say where it was read.
template <class Sheet, class Rows>
Status check_sources(const char* table, const Sheet& sheet, const Rows& rows, const ConfigNode& node) {
  for (const auto& row : rows) {
    const Figure& figure = sheet.*row.figure;
    if (row.need == row.kHasDefault || figure.value == 0.0 || !figure.source.empty()) continue;
    const ConfigNode* place = node.find(table);
    return (place ? *place : node)
        .error(std::string(table) + "." + row.source_key, "is missing", "the source of a figure that is not zero");
  }
  return Ok{};
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
    require(entry.gyro, kGyroRows);
  } else if (const ConfigNode* gyro = node.find("gyro")) {
    return gyro->error("gyro", "has_gyroscope = false, but there is a [gyro] table", "one of the two");
  }
  require(entry.accel, kAccelRows);
  CANYON_TRY_STATUS(read_config(&node, "", entry));
  CANYON_TRY_STATUS(check_sources("gyro", entry.gyro, kGyroRows, node));
  CANYON_TRY_STATUS(check_sources("accel", entry.accel, kAccelRows, node));
  CANYON_TRY_STATUS(check_sources("unit", entry.unit, kUnitRows, node));
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
