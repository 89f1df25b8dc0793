#include "canyon/gnss/sensor/receiver_catalogue.h"

#include <algorithm>

#include "canyon/core/config/named_file.h"
#include "canyon/core/config/text.h"
#include "canyon/core/process/embedded.h"
#include "canyon/gnss/sensor/gnss_config.h"

namespace canyon::gnss {
namespace {

constexpr std::string_view kReceiverFolder = "gnss/receivers/";
constexpr std::string_view kTomlSuffix = ".toml";
constexpr std::string_view kSourceSuffix = "_source";

/// What every sheet must say.
constexpr const char* kAlways[] = {
    "systems",
    "mode",
    "mask_deg",
    "receiver_clock",
    "antenna",
    "cn0_zenith_dbhz",
    "correlator",
    "discriminator",
    "correlator_spacing_chips",
    "front_end_mhz",
    "code_loop_hz",
    "code_loop_memory",
    "carrier_loop_hz",
    "integration_ms",
    "tracking_threshold_dbhz",
    "reacquisition_margin_db",
    "reacquisition_s",
    "cn0_averaging_s",
    "cn0_resolution_db",
    "smoothing_s",
    "estimator",
    "solver",
    "weighting",
    "solver_sigma_m",
    "raim",
    "max_gdop",
    "fewest_satellites",
    "accuracy_limit_m",
    "reported_covariance",
};

/// What it must say, and may say only, if one of its words is among these.
struct Conditional {
  const char* key;
  const char* word_of;
  std::vector<std::string> words;
};
const std::vector<Conditional>& conditionals() {
  static const std::vector<Conditional> rows{
      {"second_frequency", "mode", {"dual"}},
      {"ionosphere_correction", "mode", {"single", "dual"}},
      {"baseline_km", "mode", {"dgps"}},
      {"ionosphere_gradient_mm_per_km", "mode", {"dgps", "dgps_base"}},
      {"troposphere_gradient_mm_per_km", "mode", {"dgps", "dgps_base"}},
      {"base_error_scale", "mode", {"dgps", "dgps_base"}},
      {"base_place_m", "mode", {"dgps_base"}},
      {"base_receiver", "mode", {"dgps_base"}},
      {"base_rate_hz", "mode", {"dgps_base"}},
      {"base_latency_s", "mode", {"dgps_base"}},
      {"base_age_s", "mode", {"dgps_base"}},
      {"antenna_horizon_loss_db", "antenna", {"sine"}},
      {"lhcp_rejection_db", "antenna", {"sine"}},
      {"estimator_acceleration_m_s2", "estimator", {"kalman"}},
      {"raim_false_alarm", "raim", {"detect", "greedy", "leave_one_out"}},
      {"error_correlation_s", "reported_covariance", {"residual_inflated", "environment"}},
      {"light_variance_m2", "reported_covariance", {"environment"}},
      {"light_variance_m2_hz", "reported_covariance", {"environment"}},
      {"heavy_variance_m2", "reported_covariance", {"environment"}},
      {"heavy_variance_m2_hz", "reported_covariance", {"environment"}},
  };
  return rows;
}

std::vector<std::string> figure_keys() {
  std::vector<std::string> keys(std::begin(kAlways), std::end(kAlways));
  for (const auto& row : conditionals()) keys.emplace_back(row.key);
  return keys;
}

bool has(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

const std::string* text_at(const ConfigNode& node, const std::string& key) {
  const ConfigNode* found = node.find(key);
  return found == nullptr ? nullptr : std::get_if<std::string>(&found->value_);
}

std::string quoted_word(const std::string& key, const std::string& word) {
  return key + " = \"" + word + "\"";
}

/// Keys that cannot be a receiver's, with the nearest that can.
void unknown_names(const ConfigNode& sheet, std::vector<Error>& out) {
  const std::vector<std::string> keys = figure_keys();
  for (const auto& [key, node] : *sheet.table()) {
    if (key == "name" || key == "description" || has(keys, key)) continue;
    std::string figure = key;
    const bool source = key.size() > kSourceSuffix.size() && key.ends_with(kSourceSuffix);
    if (source) figure.resize(key.size() - kSourceSuffix.size());
    if (source && has(keys, figure)) continue;
    const std::string nearest = nearest_word(figure, keys);
    out.push_back(node.error(key, "is not a figure of a receiver",
                             nearest.empty() ? "one of those that docs/gnss.md lists"
                                             : "\"" + nearest + (source ? std::string(kSourceSuffix) : "") + "\"?"));
  }
}

/// Figures that are not what their keys take; all others are read into `config`.
void wrong_values(const ConfigNode& figures, GnssConfig& config, std::vector<Error>& out) {
  const Status all = read_config(&figures, "", config);
  if (all.ok()) return;
  // Of several mistakes the reader tells the topmost: each figure by itself tells its own.
  const std::size_t before = out.size();
  ConfigNode one = figures;
  for (const auto& [key, node] : *figures.table()) {
    one.value_ = ConfigNode::Table{{key, node}};
    GnssConfig alone;
    if (const Status read = read_config(&one, "", alone); !read.ok()) out.push_back(read.error());
  }
  if (out.size() == before) out.push_back(all.error());
}

void wrong_texts(const ConfigNode& sheet, std::vector<Error>& out) {
  for (const char* key : {"name", "description"})
    if (const ConfigNode* node = sheet.find(key); node != nullptr && text_at(sheet, key) == nullptr)
      out.push_back(node->error(key, "found " + node->describe(), "a text"));
}

/// Figures that are not there though they must, and sources of those that are.
std::vector<std::string> missing_keys(const ConfigNode& sheet) {
  std::vector<std::string> out;
  const auto need = [&](const std::string& key) {
    if (sheet.find(key) == nullptr) out.push_back(key);
  };
  need("name");
  need("description");
  for (const char* key : kAlways) need(key);
  for (const auto& row : conditionals()) {
    const std::string* word = text_at(sheet, row.word_of);
    if (word != nullptr && has(row.words, *word)) need(row.key);
  }
  for (const std::string& key : figure_keys()) {
    const std::string source = key + std::string(kSourceSuffix);
    const std::string* text = text_at(sheet, source);
    if (sheet.find(key) != nullptr && (text == nullptr || text->empty())) out.push_back(source);
  }
  return out;
}

bool is_tracked(const GnssConfig& c, GnssSystem system) {
  return c.satellites.systems.find(system_letter(system)) != std::string::npos;
}

/// What cannot all be true of one receiver.
struct Contradiction {
  std::vector<std::string> of;  ///< keys of the figures
  std::string what;             ///< they in words
};

void figures_without_use(const ConfigNode& sheet, std::vector<Contradiction>& out) {
  for (const auto& row : conditionals()) {
    const std::string* word = text_at(sheet, row.word_of);
    if (sheet.find(row.key) != nullptr && word != nullptr && !has(row.words, *word))
      out.push_back({{row.key, row.word_of}, std::string(row.key) + " with " + quoted_word(row.word_of, *word)});
  }
}

void narrow_front_end(const GnssConfig& c, std::vector<Contradiction>& out) {
  if (c.tracking.front_end_mhz <= 0.0) return;
  for (const GnssSystem system : {GnssSystem::kGps, GnssSystem::kGlonass, GnssSystem::kGalileo, GnssSystem::kBeidou}) {
    if (!is_tracked(c, system)) continue;
    const Modulation m = modulation_of(system, first_band(system));
    const double lobes_mhz = 1e-6 * (m == Modulation::kBoc11 ? 4.0 : 2.0) * chip_rate_hz(m);
    if (c.tracking.front_end_mhz < lobes_mhz)
      out.push_back({{"front_end_mhz", "systems"},
                     "front_end_mhz = " + number_text(c.tracking.front_end_mhz) + " with the main lobes of " +
                         system_letter(system) + ", " + number_text(lobes_mhz) + " MHz"});
  }
}

void impossible_numbers(const GnssConfig& c, std::vector<Contradiction>& out) {
  const auto clash = [&out](const char* key, double value, const char* with, double other) {
    out.push_back(
        {{key, with}, std::string(key) + " = " + number_text(value) + " with " + with + " = " + number_text(other)});
  };
  constexpr double kMostLoop = 0.5;  // B T, beyond which a loop that is updated every T is unstable
  const double T_ms = c.tracking.integration_ms;
  if (c.tracking.carrier_loop_hz * T_ms >= 1e3 * kMostLoop)
    clash("carrier_loop_hz", c.tracking.carrier_loop_hz, "integration_ms", T_ms);
  if (c.tracking.code_loop_hz * T_ms >= 1e3 * kMostLoop)
    clash("code_loop_hz", c.tracking.code_loop_hz, "integration_ms", T_ms);
  if (c.cn0_report.averaging_s > 0.0 && 1e3 * c.cn0_report.averaging_s < T_ms)
    clash("cn0_averaging_s", c.cn0_report.averaging_s, "integration_ms", T_ms);
  const double found_dbhz = c.locks.tracking_threshold_dbhz + c.locks.reacquisition_margin_db;
  if (found_dbhz >= c.link.cn0_zenith_dbhz)
    out.push_back({{"tracking_threshold_dbhz", "reacquisition_margin_db", "cn0_zenith_dbhz"},
                   "tracking_threshold_dbhz + reacquisition_margin_db = " + number_text(found_dbhz) +
                       " with cn0_zenith_dbhz = " + number_text(c.link.cn0_zenith_dbhz)});
}

void clock_without_unknown(const GnssConfig& c, std::vector<Contradiction>& out) {
  if (c.position.solver.name != "trilateration") return;
  const std::string solver = quoted_word("solver", "trilateration") + " with ";
  if (c.receiver_clock.name != "none")
    out.push_back({{"solver", "receiver_clock"}, solver + quoted_word("receiver_clock", c.receiver_clock.name)});
  if (c.position.estimator == Estimator::kKalman)
    out.push_back({{"solver", "estimator"}, solver + quoted_word("estimator", "kalman")});
}

/// Of figures that are there and could be read; for others `config` has a default, which nobody wrote.
std::vector<Contradiction> contradictions_in(const ConfigNode& sheet, const GnssConfig& config,
                                             const std::vector<Error>& wrong) {
  std::vector<Contradiction> out;
  figures_without_use(sheet, out);
  narrow_front_end(config, out);
  impossible_numbers(config, out);
  clock_without_unknown(config, out);
  std::erase_if(out, [&](const Contradiction& c) {
    return std::any_of(c.of.begin(), c.of.end(), [&](const std::string& key) {
      return sheet.find(key) == nullptr ||
             std::any_of(wrong.begin(), wrong.end(), [&](const Error& error) { return error.key == key; });
    });
  });
  return out;
}

/// All that is wrong with a sheet.
struct Mistakes {
  std::vector<Error> wrong;  ///< names and values, in the order of their lines
  std::vector<std::string> missing;
  std::vector<Contradiction> contradictions;

  bool none() const { return wrong.empty() && missing.empty() && contradictions.empty(); }
};

std::string all_in_words(const Mistakes& m) {
  std::string what;
  const auto add = [&what](const std::string& part) { what += (what.empty() ? "" : "; ") + part; };
  for (std::size_t i = 0; i < m.wrong.size(); ++i) {
    const Error& error = m.wrong[i];
    const std::string place = i == 0 ? "" : "line " + std::to_string(error.line) + ": " + error.key + ": ";
    add(place + error.what + " (expected " + error.expected + ")");
  }
  if (!m.missing.empty() && !m.wrong.empty()) add("missing: " + plain_list(m.missing));
  if (!m.missing.empty() && m.wrong.empty())
    add("is missing" + (m.missing.size() == 1
                            ? std::string()
                            : ", and so are " + plain_list({m.missing.begin() + 1, m.missing.end()})));
  for (const Contradiction& c : m.contradictions) add("contradictory: " + c.what);
  return what;
}

/// One line, at the place of the first that is wrong; else of the first figure that contradicts, unless some are
/// missing.
Error told_at_once(const ConfigNode& sheet, const Mistakes& m) {
  if (m.wrong.size() == 1 && m.missing.empty() && m.contradictions.empty()) return m.wrong.front();
  const std::string what = all_in_words(m), expected = m.missing.empty()
                                                           ? "figures of one receiver"
                                                           : "every figure of a receiver, each with its source or "
                                                             "\"assumed\"";
  if (!m.wrong.empty()) {
    Error first = m.wrong.front();
    first.what = what;
    first.expected = expected;
    return first;
  }
  if (!m.missing.empty()) return sheet.error(m.missing.front(), what, expected);
  const std::string& key = m.contradictions.front().of.front();
  return sheet.find(key)->error(key, what, expected);
}

Result<ReceiverSheet> sheet_from(const ConfigNode& sheet) {
  ReceiverSheet out;
  out.figures.value_ = ConfigNode::Table{};
  out.figures.file_ = sheet.file_;
  out.figures.line_ = sheet.line_;
  auto& figures = std::get<ConfigNode::Table>(out.figures.value_);
  for (const std::string& key : figure_keys()) {
    if (const ConfigNode* node = sheet.find(key)) figures.emplace(key, *node);
    if (const std::string* source = text_at(sheet, key + std::string(kSourceSuffix)))
      out.sources.emplace_back(key, *source);
  }
  GnssConfig config;
  Mistakes mistakes;
  unknown_names(sheet, mistakes.wrong);
  wrong_texts(sheet, mistakes.wrong);
  wrong_values(out.figures, config, mistakes.wrong);
  std::stable_sort(mistakes.wrong.begin(), mistakes.wrong.end(),
                   [](const Error& a, const Error& b) { return a.line < b.line; });
  mistakes.missing = missing_keys(sheet);
  mistakes.contradictions = contradictions_in(sheet, config, mistakes.wrong);
  if (!mistakes.none()) return told_at_once(sheet, mistakes);
  out.name = *text_at(sheet, "name");
  out.description = *text_at(sheet, "description");
  return out;
}

}  // namespace

std::vector<std::string> receiver_names() {
  std::vector<std::string> names;
  for (const std::string_view key : embedded_files(kReceiverFolder))
    names.emplace_back(key.substr(kReceiverFolder.size(), key.size() - kReceiverFolder.size() - kTomlSuffix.size()));
  return names;
}

Result<ReceiverSheet> parse_receiver(std::string_view toml, const std::string& file_name) {
  CANYON_TRY(const ConfigNode node, ConfigNode::parse(toml, file_name));
  return sheet_from(node);
}

Result<ReceiverSheet> load_receiver(const std::string& receiver) {
  if (receiver.ends_with(kTomlSuffix)) {
    CANYON_TRY(const ConfigNode node, ConfigNode::load(receiver));
    return sheet_from(node);
  }
  const std::string key = std::string(kReceiverFolder) + receiver + std::string(kTomlSuffix);
  if (const auto text = embedded_file(key)) return parse_receiver(*text, key);
  const std::vector<std::string> known = receiver_names();
  const std::string nearest = nearest_word(receiver, known);
  return Error{
      .file = "",
      .key = "gnss.receiver",
      .what = "no receiver \"" + receiver + "\" in the catalogue",
      .expected = nearest.empty() ? "one of " + plain_list(known) + ", or a .toml file" : "\"" + nearest + "\"?"};
}

Status lay_with_receiver(ConfigNode& tree, const ConfigNode& over) {
  const ConfigNode* named = over.find("gnss.receiver");
  const auto* name = named == nullptr ? nullptr : std::get_if<std::string>(&named->value_);
  if (name != nullptr && !name->empty()) {
    const std::string receiver = name->ends_with(kTomlSuffix) ? path_as_named(*named, *name) : *name;
    const auto sheet = load_receiver(receiver);
    if (!sheet) return error_as_named(*named, "gnss.receiver", receiver, sheet.error());
    ConfigNode below;
    below.value_ = ConfigNode::Table{{"gnss", sheet->figures}};
    tree.overlay(below);
  }
  tree.overlay(over);
  return Ok{};
}

}  // namespace canyon::gnss
