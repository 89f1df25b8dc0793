#include <cmath>

#include <nlohmann/json.hpp>

#include "canyon/core/output/json.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/study/drive_check/drive_check.h"

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

std::string words(const DriveRow& row, const DriveFigures& figures) {
  std::string out;
  for (const double value : row.get(figures))
    out +=
        (out.empty() ? "" : " / ") + (std::isfinite(value) ? printed("%.*f", row.decimals, value) : std::string("-"));
  return out;
}

}  // namespace

Json drive_check_json(const DriveCheck& check) {
  return Json{{"epochs", check.measured.epochs.size()},
              {"reference_instants", check.measured.figures.instants},
              {"simulated", side_json(check.simulated.figures)},
              {"measured", side_json(check.measured.figures)}};
}

std::string drive_check_text(const DriveCheck& check) {
  std::string out = printed("%zu epochs of the log, %d instants of the reference\n", check.measured.epochs.size(),
                            check.measured.figures.instants);
  out += printed("%-42s%-26s%s\n", "", "simulated", "measured");
  for (const DriveRow& row : kRows)
    out += printed("%-42s%-26s%s\n", row.label, words(row, check.simulated.figures).c_str(),
                   words(row, check.measured.figures).c_str());
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
