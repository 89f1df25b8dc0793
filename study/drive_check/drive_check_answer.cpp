#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/study/drive_check/drive_check.h"
#include "canyon/study/drive_check/drive_distributions.h"
#include "canyon/study/drive_check/drive_satellites.h"

namespace canyon::study {
namespace {

/// A figure of a drive: one number, or quantiles that belong together.
struct DriveRow {
  const char* key;
  const char* label;
  int decimals;
  std::vector<double> (*get)(const DriveFigures& f);
  bool list = false;
};

template <std::size_t N>
std::vector<double> listed(const std::array<double, N>& values) {
  return {values.begin(), values.end()};
}

using Of = const DriveFigures&;
const DriveRow kRows[] = {
    {"tracked_in_sight", "tracked per epoch, in sight", 1, [](Of f) { return std::vector{f.tracked_in_sight}; }},
    {"tracked_hidden", "tracked per epoch, hidden", 1, [](Of f) { return std::vector{f.tracked_hidden}; }},
    {"cn0_in_sight_dbhz", "C/N0 in sight, 10/50/90 %, dB-Hz", 1, [](Of f) { return listed(f.cn0_in_sight_dbhz); },
     true},
    {"cn0_hidden_dbhz", "C/N0 hidden, 10/50/90 %, dB-Hz", 1, [](Of f) { return listed(f.cn0_hidden_dbhz); }, true},
    {"cn0_auc", "AUC of C/N0, in sight against hidden", 3, [](Of f) { return std::vector{f.cn0_auc}; }},
    {"hidden_error_m", "|range error| hidden, 50/95 %, m", 1, [](Of f) { return listed(f.hidden_error_m); }, true},
    {"hidden_signed_error_m", "range error hidden, 5/50/95 %, m", 1, [](Of f) { return listed(f.hidden_signed_m); },
     true},
    {"hidden_positive_share", "share of hidden with range too long", 2,
     [](Of f) { return std::vector{f.hidden_positive_share}; }},
    {"in_sight_error_p95_m", "|range error| in sight, 95 %, m", 1,
     [](Of f) { return std::vector{f.in_sight_error_p95_m}; }},
    {"in_sight_signed_error_m", "range error in sight, 5/50/95 %, m", 1,
     [](Of f) { return listed(f.in_sight_signed_m); }, true},
    {"hidden_autocorrelation", "its autocorrelation hidden, 1/5/10 s", 2,
     [](Of f) { return listed(f.hidden_autocorrelation); }, true},
    {"in_sight_autocorrelation", "the same in sight", 2, [](Of f) { return listed(f.in_sight_autocorrelation); }, true},
    {"hidden_rate_error_m_s", "|range-rate error| hidden, 50/95 %, m/s", 2,
     [](Of f) { return listed(f.hidden_rate_m_s); }, true},
    {"fix_h50_m", "fix, horizontal, 50 %, m", 1, [](Of f) { return std::vector{f.fix_h50_m}; }},
    {"fix_h95_m", "fix, horizontal, 95 %, m", 1, [](Of f) { return std::vector{f.fix_h95_m}; }},
    {"fixes", "fixes", 0, [](Of f) { return std::vector{static_cast<double>(f.fixes)}; }},
    {"beyond_3_sigma", "share of fixes beyond 3 sigma", 2, [](Of f) { return std::vector{f.beyond_3_sigma}; }},
};

Json side_json(const DriveFigures& figures) {
  Json out = Json::object();
  for (const DriveRow& row : kRows) {
    const auto values = row.get(figures);
    if (!row.list) {
      out[row.key] = or_null(values.front());
      continue;
    }
    out[row.key] = Json::array();
    for (const double value : values) out[row.key].push_back(or_null(value));
  }
  return out;
}

/// 5 and 95 % over several of a drive; of a list one pair for each.
Json spread_json(const std::vector<DriveFigures>& spread) {
  Json out = Json::object();
  for (const DriveRow& row : kRows) {
    Json pairs = Json::array();
    for (std::size_t i = 0; i < row.get(spread.front()).size(); ++i) {
      std::vector<double> values;
      for (const DriveFigures& f : spread)
        if (const double v = row.get(f)[i]; !std::isnan(v)) values.push_back(v);
      pairs.push_back(Json::array({or_null(drive_quantile(values, 0.05)), or_null(drive_quantile(values, 0.95))}));
    }
    out[row.key] = row.list ? pairs : pairs.front();
  }
  return out;
}

Json score_json(const DriveScore& score) {
  const auto pair = [](const std::array<double, 2>& v) { return Json::array({or_null(v[0]), or_null(v[1])}); };
  return Json{{"draws", score.draws},
              {"signals", score.signals},
              {"foretold_share", or_null(score.foretold_share)},
              {"crps_simulation_m", or_null(score.simulation_m)},
              {"crps_blind_m", or_null(score.blind_m)},
              {"crps_elevation_m", or_null(score.elevation_m)},
              {"against_blind_m", pair(score.against_blind_m)},
              {"against_elevation_m", pair(score.against_elevation_m)}};
}

std::string score_text(const DriveScore& s) {
  return printed(
      "CRPS of range errors over %d signals, %d draws, m: simulation %.2f, measured errors of other times %.2f,\n"
      "  those of like elevation %.2f; simulation less these %.2f to %.2f and %.2f to %.2f (95 %%)\n",
      s.signals, s.draws, s.simulation_m, s.blind_m, s.elevation_m, s.against_blind_m[0], s.against_blind_m[1],
      s.against_elevation_m[0], s.against_elevation_m[1]);
}

std::string words(const DriveRow& row, const DriveFigures& figures) {
  std::string out;
  for (const double value : row.get(figures))
    out +=
        (out.empty() ? "" : " / ") + (std::isfinite(value) ? printed("%.*f", row.decimals, value) : std::string("-"));
  return out;
}

}  // namespace

Json drive_check_json(const DriveCheck& check) {
  Json out{{"epochs", check.measured.epochs.size()},
           {"reference_instants", check.measured.figures.instants},
           {"simulated", side_json(check.simulated.figures)},
           {"measured", side_json(check.measured.figures)},
           {"figures", Json::array()}};
  for (const DriveRow& row : kRows) out["figures"].push_back(Json{{"key", row.key}, {"label", row.label}});
  out["distributions"] = drive_distributions_json(drive_distributions(check.simulated.epochs, check.simulated.fixes),
                                                  drive_distributions(check.measured.epochs, check.measured.fixes));
  out["satellites"] = drive_satellites_json(check.simulated.epochs, check.measured.epochs);
  if (!check.measured.spread.empty()) out["measured_interval"] = spread_json(check.measured.spread);
  if (!check.simulated.spread.empty()) {
    out["simulated_draws"] = spread_json(check.simulated.spread);
    out["score"] = score_json(check.score);
  }
  return out;
}

std::string drive_check_text(const DriveCheck& check) {
  std::string out = printed("%zu epochs of the log, %d instants of the reference\n", check.measured.epochs.size(),
                            check.measured.figures.instants);
  out += printed("%-42s%-26s%s\n", "", "simulated", "measured");
  for (const DriveRow& row : kRows)
    out += printed("%-42s%-26s%s\n", row.label, words(row, check.simulated.figures).c_str(),
                   words(row, check.measured.figures).c_str());
  if (check.score.draws > 0) out += score_text(check.score);
  return out;
}

std::string drive_signals_csv(const DriveCheck& check) {
  std::string out = "side,gps_week,sow,satellite,elevation_deg,azimuth_deg,in_sight,cn0_dbhz,error_m,rate_error_m_s\n";
  const auto number = [](double v) { return std::isfinite(v) ? printed("%.3f", v) : std::string(); };
  for (const auto& [name, side] : {std::pair{"simulated", &check.simulated}, std::pair{"measured", &check.measured}}) {
    for (const DriveEpoch& epoch : side->epochs) {
      throw_if_cancelled();
      for (const DriveSignal& s : epoch.signals)
        out += printed("%s,%d,%.3f,%s,%.3f,%.3f,%d,%s,%s,%s\n", name, epoch.t.week(), epoch.t.sow_s(),
                       s.sv.str().c_str(), s.elevation_rad / kDegree, s.azimuth_rad / kDegree, s.in_sight ? 1 : 0,
                       number(s.cn0_dbhz).c_str(), number(s.error_m).c_str(), number(s.rate_error_m_s).c_str());
    }
  }
  return out;
}

}  // namespace canyon::study
