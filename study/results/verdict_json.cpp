#include "canyon/study/results/verdict_json.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"

namespace canyon::study {
namespace {

/// A mean of squares under its name, and the band that a right filter's lies in.
void write(const char* name, const fusion::SquareMean& mean, Json& out) {
  out[name] = or_null(mean.value);
  out["low"] = or_null(mean.band.low);
  out["high"] = or_null(mean.band.high);
  out["independent"] = or_null(mean.effective);
}

void write(const fusion::Whiteness& white, Json& out) {
  out["lag_one"] = or_null(white.at_lag_one);
  out["correlation_s"] = or_null(white.correlation_s);
  out["white"] = white.threshold > 0.0 ? Json(white.statistic <= white.threshold) : Json(nullptr);
}

template <class Rows, class Row>
Json rows_json(const Rows& rows, const Row& row) {
  Json out = Json::array();
  for (const auto& of : rows) out.push_back(row(of));
  return out;
}

Json measurement_json(const fusion::MeasurementNumbers& m) {
  Json out{{"name", m.name}, {"count", m.count}, {"refused", m.refused}};
  write("nis", m.nis, out);
  out["nis_median_ratio"] = or_null(m.nis_median_ratio);
  write(m.white, out);
  return out;
}

Json axis_json(const fusion::AxisNumbers& axis) {
  Json out{{"name", axis.name}, {"unit", axis.unit}, {"rms", or_null(axis.rms)}, {"claimed", or_null(axis.claimed)}};
  write("ratio", axis.ratio, out);
  return out;
}

Json block_json(const fusion::BlockNumbers& block) {
  Json out{{"name", block.name}};
  write("nees", block.nees, out);
  out["within_50"] = or_null(block.coverage[0]);
  out["within_95"] = or_null(block.coverage[1]);
  out["within_997"] = or_null(block.coverage[2]);
  out["correlation_s"] = or_null(block.correlation_s);
  return out;
}

Json process_json(const fusion::ProcessNumbers& process) {
  Json out{{"name", process.name}};
  write("ratio", process.ratio, out);
  return out;
}

Json fixes_json(const fusion::FixNumbers& fixes) {
  Json out{{"rms_m", or_null(fixes.rms_m)}, {"claimed_m", or_null(fixes.claimed_m)}};
  write("ratio", fixes.ratio, out);
  write(fixes.white, out);
  out["lasting_is_modelled"] = fixes.lasting_is_modelled;
  return out;
}

Json state_json(const fusion::StateNumbers& state) {
  return {{"block", state.block},
          {"name", state.name},
          {"share", or_null(state.share)},
          {"least_share", or_null(state.least_share)},
          {"halved_after_s", state.halved_after_s ? Json(*state.halved_after_s) : Json(nullptr)}};
}

/// Four decimals are enough of a share, and of a time that is looked at once a second.
Json shortened(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(or_null(std::round(1e4 * value) / 1e4));
  return out;
}

Json observability_json(const fusion::VerdictNumbers& n) {
  Json states = Json::object();
  for (const fusion::StateNumbers& state : n.states) states[state.name] = shortened(state.shares);
  return {{"t_s", shortened(n.looked_s)}, {"states", std::move(states)}};
}

}  // namespace

Json evidence_json(const fusion::VerdictNumbers& n) {
  return {{"tests", n.tests},
          {"false_alarm_each", or_null(n.false_alarm)},
          {"measurements", rows_json(n.measurements, measurement_json)},
          {"errors", rows_json(n.axes, axis_json)},
          {"blocks", rows_json(n.blocks, block_json)},
          {"fixes", n.fixes ? fixes_json(*n.fixes) : Json(nullptr)},
          {"processes", rows_json(n.processes, process_json)},
          {"states", rows_json(n.states, state_json)},
          {"observability", observability_json(n)}};
}

std::string verdict_in_short(const std::vector<std::string>& verdict) {
  constexpr std::size_t kMost = 3;
  const auto is_fault = [](const std::string& line) { return !line.ends_with("not observed"); };
  const auto faults = static_cast<std::size_t>(std::count_if(verdict.begin(), verdict.end(), is_fault));
  std::string out;
  for (std::size_t i = 0; i < std::min(faults, kMost); ++i) out += (i == 0 ? "" : "; ") + verdict[i];
  return faults > kMost ? out + "; and " + std::to_string(faults - kMost) + " more" : out;
}

}  // namespace canyon::study
