#include "canyon/inertial/calibration/fitted_entry.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::inertial {
namespace {

/// A text as a TOML string.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

/// Six significant digits.
std::string figure_text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  std::string text = buffer;
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// One triad's keys: units of the sheet in SI, and how its keys are called.
struct TriadKeys {
  const char* table;
  const char* white;
  const char* white_source;
  const char* turn_on;
  const char* in_run;
  const char* instability;
  const char* random_walk;
  const char* ramp;
  const char* quantization;
  double white_unit, bias_unit, walk_unit, ramp_unit, quantization_unit;
};
constexpr double kSqrtHour = 60.0;
const TriadKeys kGyroKeys = {"gyro",
                             "arw_deg_per_sqrt_hr",
                             "arw_source",
                             "turn_on_bias_deg_per_hr",
                             "in_run_bias_deg_per_hr",
                             "bias_instability_deg_per_hr",
                             "rate_random_walk_deg_per_hr_per_sqrt_hr",
                             "ramp_deg_per_hr_per_hr",
                             "quantization_noise_deg",
                             kDegree / kSqrtHour,
                             kDegree / kHour,
                             kDegree / kHour / kSqrtHour,
                             kDegree / kHour / kHour,
                             kDegree};
const TriadKeys kAccelKeys = {"accel",
                              "vrw_m_s_per_sqrt_hr",
                              "vrw_source",
                              "turn_on_bias_mg",
                              "in_run_bias_mg",
                              "bias_instability_mg",
                              "rate_random_walk_mg_per_sqrt_hr",
                              "ramp_mg_per_hr",
                              "quantization_noise_m_s",
                              1.0 / kSqrtHour,
                              kMilliG,
                              kMilliG / kSqrtHour,
                              kMilliG / kHour,
                              1.0};

/// Writes one triad's table.
class TriadWriter {
 public:
  TriadWriter(const FittedUnit& unit, std::size_t triad, const TriadKeys& keys, const NoiseFit& fit)
      : unit_(unit), triad_(triad), keys_(keys), fit_(fit) {}

  std::string write() {
    out_ = std::string("\n[") + keys_.table + "]\n";
    process("white", keys_.white, keys_.white_source, keys_.white_unit, true);
    const double correlation = fit_.term("white").second;
    if (correlation > 0.0) figure("neighbour_correlation", "neighbour_correlation_source", correlation, of_log());
    figure(keys_.turn_on, "turn_on_bias_source", unit_.bias[triad_] / keys_.bias_unit, unit_.bias_source[triad_]);
    in_run();
    constant("scale_ppm", "scale_source", true, 1e-6);
    constant("misalignment_mrad", "misalignment_source", false, 1e-3);
    instability();
    process("rate_random_walk", keys_.random_walk, "rate_random_walk_source", keys_.walk_unit, false);
    process("ramp", keys_.ramp, "ramp_source", keys_.ramp_unit, false);
    process("quantization", keys_.quantization, "quantization_noise_source", keys_.quantization_unit, false);
    return out_;
  }

 private:
  double coefficient(const char* name) const { return fit_.term(name).value; }

  std::string of_log() const {
    char buffer[80];
    std::snprintf(buffer, sizeof buffer, ", %.0f s at %.6g Hz", unit_.duration_s, unit_.rate_hz);
    return "fitted to the Allan deviation of " + unit_.log + buffer + ", root mean square of the axes";
  }

  void figure(const char* key, const char* source_key, double value, const std::string& source) {
    out_ += std::string(key) + " = " + figure_text(value) + "\n";
    out_ += std::string(source_key) + " = " + quoted(source) + "\n";
  }
  void process(const char* name, const char* key, const char* source_key, double si, bool required) {
    const double value = coefficient(name);
    if (value > 0.0)
      figure(key, source_key, value / si, of_log());
    else if (required)
      figure(key, source_key, 0.0, "not determined by " + unit_.log);
  }

  void in_run() {
    const double sigma = coefficient("gauss_markov");
    if (!(sigma > 0.0)) return figure(keys_.in_run, "in_run_bias_source", 0.0, "no such process in " + unit_.log);
    figure(keys_.in_run, "in_run_bias_source", sigma / keys_.bias_unit, of_log());
    figure("in_run_bias_tau_s", "in_run_bias_tau_source", fit_.term("gauss_markov").second, of_log());
  }

  /// The floor is 0.664 B. Flicker noise acts from a tenth of what the log could show up to a hundred times the
  /// frequency at which white noise covers it, where it is a hundredth of it: the fit counts it at every averaging
  /// time.
  void instability() {
    const double b = coefficient("bias_instability"), n = coefficient("white");
    if (!(b > 0.0)) return;
    figure(keys_.instability, "bias_instability_source", std::sqrt(2.0 * std::log(2.0) / kPi) * b / keys_.bias_unit,
           of_log() + "; the floor, 0.664 B");
    const double low_hz = 0.1 / unit_.duration_s;
    const double covered_hz = n > 0.0 ? b * b / (2.0 * kPi * n * n) : unit_.rate_hz;
    figure("flicker_low_hz", "flicker_low_source", low_hz, "a tenth of 1 / duration of the log");
    figure("flicker_high_hz", "flicker_high_source", std::clamp(100.0 * covered_hz, 10.0 * low_hz, 0.4 * unit_.rate_hz),
           "a hundred times the frequency where white noise covers it");
  }

  void constant(const char* key, const char* source_key, bool diagonal, double si) {
    const auto& found = unit_.calibration[triad_];
    if (!found) return figure(key, source_key, 0.0, "a resting log does not show it");
    double sum = 0.0;
    int count = 0;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) {
        if ((row == column) != diagonal || found->gain_sigma(row, column) == 0.0) continue;
        sum += found->gain(row, column) * found->gain(row, column);
        ++count;
      }
    if (count == 0) return figure(key, source_key, 0.0, "the log does not show it");
    figure(key, source_key, std::sqrt(sum / count) / si,
           unit_.calibration_source[triad_] + ", root mean square of the " + (diagonal ? "axes" : "terms"));
  }

  const FittedUnit& unit_;
  std::size_t triad_;
  const TriadKeys& keys_;
  const NoiseFit& fit_;
  std::string out_;
};

/// Root mean square of a triad's curves.
std::vector<DeviationPoint> root_mean_square(const FittedUnit& unit, std::size_t triad) {
  std::vector<DeviationPoint> out;
  double axes = 0.0;
  for (const ChannelNoise& n : unit.noise) {
    if ((n.channel < 3) != (triad == 0)) continue;
    if (out.empty()) out.resize(n.points.size());
    CANYON_CHECK(out.size() == n.points.size(), "curves of ", out.size(), " and ", n.points.size(), " points");
    axes += 1.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double sum = out[i].deviation + n.points[i].deviation * n.points[i].deviation;
      const double edf = out[i].edf + n.points[i].edf;
      out[i] = n.points[i];
      out[i].deviation = sum;
      out[i].edf = edf;
    }
  }
  for (DeviationPoint& p : out) p.deviation = std::sqrt(p.deviation / axes);
  return out;
}

Eigen::Vector3d mean_of_triad(const ImuLog& log, std::size_t first) {
  Eigen::Vector3d out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& x = log.channels[first + axis];
    out[static_cast<Eigen::Index>(axis)] = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  }
  return out;
}

}  // namespace

Result<NoiseFit> fit_triad(const FittedUnit& unit, std::size_t triad) {
  return fit_noise(root_mean_square(unit, triad), unit.per_octave);
}

void take_calibration(FittedUnit& unit, std::size_t triad, const TriadCalibration& found, const std::string& source) {
  unit.calibration[triad] = found;
  unit.calibration_source[triad] = source;
  unit.bias[triad] = found.bias.norm() / std::sqrt(3.0);
  unit.bias_source[triad] = source + ", root mean square of the axes";
}

Result<std::string> catalogue_toml(const FittedUnit& unit) {
  const bool has_gyroscope =
      std::any_of(unit.noise.begin(), unit.noise.end(), [](const auto& n) { return n.channel < 3; });
  std::string out = "name = " + quoted(unit.name) + "\ndescription = " + quoted("Fitted to " + unit.log + ".") + "\n";
  if (!has_gyroscope) out += "has_gyroscope = false\n";
  out += "in_run_bias_is_instability = false\n";
  for (const std::size_t triad : {std::size_t{0}, std::size_t{1}}) {
    if (triad == 0 && !has_gyroscope) continue;
    CANYON_TRY(const NoiseFit fit, fit_triad(unit, triad));
    out += TriadWriter(unit, triad, triad == 0 ? kGyroKeys : kAccelKeys, fit).write();
  }
  return out;
}

double resting_rate(const ImuLog& log) {
  return mean_of_triad(log, 0).norm();
}

double resting_force_error(const ImuLog& log, double gravity_m_s2) {
  return std::abs(mean_of_triad(log, 3).norm() - gravity_m_s2);
}

}  // namespace canyon::inertial
