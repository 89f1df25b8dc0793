#include "canyon/study/fuse/config.h"

#include "canyon/core/files/files.h"
#include "canyon/core/units.h"
#include "canyon/fusion/alignment/alignment.h"
#include "canyon/fusion/smoothing/smoother.h"
#include "canyon/inertial/imu_model.h"

namespace canyon::study {
namespace {

constexpr double kUnset = -1.0;
constexpr double kPerHour = kDegree / kHour;
constexpr auto kGyro = &ImuNoise::gyro;
constexpr auto kAccel = &ImuNoise::accel;

constexpr std::array<NoiseFigure, kNoiseFigures> kFigures = {{
    {"arw_deg_per_sqrt_hr", kGyro, &TriadNoise::white_per_sqrt_hz, kDegree / 60.0, "angle random walk"},
    {"gyro_turn_on_bias_deg_per_hr", kGyro, &TriadNoise::turn_on_bias_sigma, kPerHour,
     "1-sigma, constant over the log"},
    {"gyro_in_run_bias_deg_per_hr", kGyro, &TriadNoise::in_run_bias_sigma, kPerHour, "1-sigma of what wanders"},
    {"gyro_in_run_bias_tau_s", kGyro, &TriadNoise::in_run_bias_tau_s, 1.0, "its correlation time"},
    {"gyro_scale_ppm", kGyro, &TriadNoise::scale_sigma, 1e-6, "1-sigma of the scale factors"},
    {"gyro_misalignment_mrad", kGyro, &TriadNoise::misalignment_sigma_rad, 1e-3, "1-sigma of the axes' angles"},
    {"vrw_m_s_per_sqrt_hr", kAccel, &TriadNoise::white_per_sqrt_hz, 1.0 / 60.0, "velocity random walk"},
    {"accel_turn_on_bias_mg", kAccel, &TriadNoise::turn_on_bias_sigma, kMilliG, "1-sigma, constant over the log"},
    {"accel_in_run_bias_mg", kAccel, &TriadNoise::in_run_bias_sigma, kMilliG, "1-sigma of what wanders"},
    {"accel_in_run_bias_tau_s", kAccel, &TriadNoise::in_run_bias_tau_s, 1.0, "its correlation time"},
    {"accel_scale_ppm", kAccel, &TriadNoise::scale_sigma, 1e-6, "1-sigma of the scale factors"},
    {"accel_misalignment_mrad", kAccel, &TriadNoise::misalignment_sigma_rad, 1e-3, "1-sigma of the axes' angles"},
}};

constexpr ModelRow<LogAxes> kAxes[] = {
    {"flu", LogAxes::kForwardLeftUp, "forward, left, up"},
    {"frd", LogAxes::kForwardRightDown, "forward, right, down"},
};
constexpr ModelRow<TruthPoint> kPoints[] = {
    {"imu", TruthPoint::kImu, "the IMU"},
    {"antenna", TruthPoint::kAntenna, "the antenna"},
    {"body", TruthPoint::kBody, "the vehicle's origin"},
};

std::vector<std::string> starts() {
  std::vector<std::string> out = {"auto", "truth"};
  for (const auto& row : fusion::alignments()) out.emplace_back(row.name);
  return out;
}

}  // namespace

const std::array<NoiseFigure, kNoiseFigures>& noise_figures() {
  return kFigures;
}

FuseStartConfig::FuseStartConfig() {
  for (const auto& row : fusion::alignments())
    if (row.parameters != nullptr) row.parameters(own);
}

FuseSmootherConfig::FuseSmootherConfig() {
  for (const auto& row : fusion::smoothers())
    if (row.parameters != nullptr) row.parameters(own);
}
void visit(FieldVisitor& f, FuseSmootherConfig& c) {
  c.own.visit_all(f);
}

void visit(FieldVisitor& f, FuseImuConfig& c) {
  f.file("sensor", c.sensor, ".toml", "unit of the catalogue, or a file like one, whose noise the filter is told");
  for (std::size_t i = 0; i < kFigures.size(); ++i)
    f.optional_number(kFigures[i].key, c.figures[i], kUnset, {0, 1e9}, kFigures[i].doc);
  f.text("columns", c.columns, "names of the log's columns, or a layout, as for imu allan; empty: its header");
  f.choice("axes", c.axes, std::span<const ModelRow<LogAxes>>(kAxes), "axes of the log, once turned by turn_deg");
  f.vector3("turn_deg", c.turn_deg, {-360, 360},
            "roll, pitch, yaw (ZYX) from the log's axes to `axes` of the vehicle: v_vehicle = (Rz Ry Rx)' v_log");
  f.flag("instantaneous", c.instantaneous, "rates are those at the stamp, not means over the interval that ends there");
  f.number("clock_offset_s", c.clock_offset_s, {-1e6, 1e6}, "added to the log's stamps to make GPS time of them");
  f.vector3("lever_m", c.lever_m, {-100, 100}, "the IMU in B");
  f.number("bridge_s", c.bridge_s, {0, 1e5},
           "gaps up to this are bridged, as [timeline] says; after longer ones navigation starts anew in motion");
}

void visit(FieldVisitor& f, FuseGnssConfig& c) {
  f.text("columns", c.columns, "names of the columns of fixes; empty: the header's, or KF-GINS text");
  f.vector3("lever_m", c.lever_m, {-100, 100}, "the antenna in B");
  f.number("clock_offset_s", c.clock_offset_s, {-1e6, 1e6}, "added to the fixes' stamps to make GPS time of them");
  f.vector3("sigma_enu_m", c.sigma_enu_m, {0, 1e6}, "1-sigma east, north, up of fixes that state none");
  f.vector3("velocity_sigma_enu_m_s", c.velocity_sigma_enu_m_s, {0, 1e4},
            "the same of their velocities; 0: a velocity without a sigma is not used");
  f.file("solve", c.solve, ".toml", "options of the solution of RINEX, as gnss solve --config");
}

void visit(FieldVisitor& f, FuseOdometerConfig& c) {
  f.text("columns", c.columns, "names of the columns: t_s with speed_m_s, or with ticks; empty: the header's");
  f.number("tick_m", c.tick_m, {1e-6, 10}, "metres per tick, for a log of ticks");
}

void visit(FieldVisitor& f, FuseHeadingConfig& c) {
  f.text("columns", c.columns, "names of the columns: t_s, heading_deg, sigma_deg; empty: the header's");
  f.number("offset_deg", c.offset_deg, {-360, 360},
           "added to the log's headings: the vehicle's nose clockwise from the line of the antennas");
  f.number("sigma_deg", c.sigma_deg, {0, 180}, "1-sigma of headings that state none");
}

void visit(FieldVisitor& f, FusePosesConfig& c) {
  f.text("columns", c.columns, "names of the columns of poses in a map; empty: the header's, KF-GINS text or TUM");
  f.numbers("origin_deg_deg_m", c.origin_deg_deg_m, 0, {-1e6, 1e6},
            "latitude, longitude, height of the origin of a map in local coordinates");
  f.vector3("sigma_enu_m", c.sigma_enu_m, {0, 1e6}, "1-sigma east, north, up of places that state none");
  f.vector3("attitude_sigma_deg", c.attitude_sigma_deg, {0, 180},
            "1-sigma about forward, left, up of attitudes that state none");
}

void visit(FieldVisitor& f, FuseTruthConfig& c) {
  f.text("columns", c.columns, "names of the reference's columns; empty: the header's, KF-GINS text or TUM");
  f.choice("of", c.of, std::span<const ModelRow<TruthPoint>>(kPoints), "what the reference is the place of");
  f.numbers("origin_deg_deg_m", c.origin_deg_deg_m, 0, {-1e6, 1e6},
            "latitude, longitude, height of the origin of a reference in local coordinates");
}

void visit(FieldVisitor& f, FuseStartConfig& c) {
  f.choice("from", c.from, starts(),
           "where navigation starts: the reference's first state (truth), or an alignment; auto: truth if it has "
           "attitudes, else in_motion");
  c.own.visit_all(f);
}

void visit(FieldVisitor& f, FuseScoreConfig& c) {
  f.number("skip_s", c.skip_s, {0, 1e6}, "seconds after the start that are not scored");
}
void visit(FieldVisitor& f, FuseOutputConfig& c) {
  f.number("rate_hz", c.rate_hz, {1e-3, 1e4}, "states written per second, at samples");
}

void visit(FieldVisitor& f, FuseConfig& c) {
  f.group("fusion", c.fusion, "the filter, as in a mission file");
  f.group("imu", c.imu, "the IMU and its log");
  f.group("gnss", c.gnss, "the antenna and the log of fixes");
  f.group("odometer", c.odometer, "the log of the wheel");
  f.group("heading", c.heading, "the log of headings");
  f.group("poses", c.poses, "the log of poses in a map");
  f.group("truth", c.truth, "the reference");
  f.group("start", c.start, "the first state");
  f.group("timeline", c.timeline, "what is late, missing or wrong");
  f.group("smoother", c.smoother, "what --smoother makes of the whole run");
  f.group("score", c.score, "what is scored");
  f.group("output", c.output, "what is written");
}

namespace {

Result<FuseConfig> config_from(ConfigNode node) {
  FuseConfig config;
  CANYON_TRY_STATUS(read_config(&node, "", config));
  config.imu.sensor_given = node.find("imu.sensor") != nullptr || node.find("fusion.imu") != nullptr;
  for (const auto& figure : config.imu.figures) config.imu.sensor_given |= figure.has_value();
  config.file = std::move(node);
  for (const NamedFile& named : named_files([&config](FieldVisitor& f) { visit(f, config); }))
    if (const auto text = read_text_file(named.path); !text)
      return at_key(config, named.key, "\"" + named.path + "\" " + text.error().what, text.error().expected);
  for (const auto& [key, origin] : {std::pair{"truth.origin_deg_deg_m", &config.truth.origin_deg_deg_m},
                                    std::pair{"poses.origin_deg_deg_m", &config.poses.origin_deg_deg_m}})
    if (!origin->empty() && origin->size() != 3)
      return at_key(config, key, std::to_string(origin->size()) + " numbers", "latitude, longitude, height");
  CANYON_TRY_STATUS(fuse_noise(config));
  return config;
}

}  // namespace

Result<FuseConfig> read_fuse_config(const std::string& path) {
  if (path.empty()) return FuseConfig{};
  CANYON_TRY(ConfigNode node, ConfigNode::load(path));
  return config_from(std::move(node));
}

Result<FuseConfig> parse_fuse_config(std::string_view toml, const std::string& name) {
  CANYON_TRY(ConfigNode node, ConfigNode::parse(toml, name));
  return config_from(std::move(node));
}

Result<ImuNoise> fuse_noise(const FuseConfig& config) {
  const bool of_fusion = !config.fusion.imu.empty();
  auto noise = inertial::catalogue_noise(of_fusion ? config.fusion.imu : config.imu.sensor);
  if (!noise) {
    Error error = noise.error();
    if (error.file.empty() && error.line == 0)
      return at_key(config, of_fusion ? "fusion.imu" : "imu.sensor", error.what, error.expected);
    return error;
  }
  for (std::size_t i = 0; i < kFigures.size(); ++i)
    if (config.imu.figures[i])
      ((*noise).*kFigures[i].triad).*kFigures[i].figure = *config.imu.figures[i] * kFigures[i].si;
  for (const TriadNoise* triad : {&noise->gyro, &noise->accel})
    if (!(triad->in_run_bias_tau_s > 0.0))
      return at_key(config, "imu.gyro_in_run_bias_tau_s", "a correlation time of 0 s", "a positive time");
  return noise;
}

std::string fuse_key_reference() {
  FuseConfig config;
  std::string out = "| key | unit | default | range | meaning |\n|---|---|---|---|---|\n";
  const auto cell = [](std::string text) {
    for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) text.insert(i, 1, '\\');
    return text;
  };
  for (const FieldDoc& row : documented_fields("", [&config](FieldVisitor& f) { visit(f, config); })) {
    if (row.key.starts_with("fusion.")) continue;  // docs/mission.md has them
    out += "| `" + row.key + "` | " + row.unit + " | " + cell(row.default_value) + " | " + cell(row.range) + " | " +
           cell(row.meaning) + " |\n";
  }
  return out;
}

Error at_key(const FuseConfig& config, const std::string& key, std::string what, std::string expected) {
  const ConfigNode* node = config.file.find(key);
  if (node != nullptr) return node->error(key, std::move(what), std::move(expected));
  return Error{"", 0, key, std::move(what), std::move(expected)};
}

}  // namespace canyon::study
