#include "canyon/report/read/run_story.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "canyon/core/messages.h"

namespace canyon::report {

std::string outcome_label(const std::string& outcome) {
  std::string out = outcome;
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

std::string outcome_class(const std::string& outcome) {
  if (outcome == "success") return "good";
  return outcome == "stopped" ? "neither" : "bad";
}

std::string outcome_mark(const std::string& outcome) {
  if (outcome == "success") return "\xE2\x9C\x93";
  return outcome == "stopped" ? "\xE2\x97\x8B" : "\xE2\x9C\x95";
}

std::optional<std::size_t> row_at(const EpochTable& table, double t_s) {
  if (table.rows == 0 || !std::isfinite(t_s)) return std::nullopt;
  const std::vector<double>& t = table["t_s"];
  const auto after = std::lower_bound(t.begin(), t.end(), t_s);
  if (after == t.end()) return t.size() - 1;
  const auto row = static_cast<std::size_t>(after - t.begin());
  return row > 0 && t_s - t[row - 1] < t[row] - t_s ? row - 1 : row;
}

double error_norm_m(const EpochTable& table, std::size_t row) {
  const double e = table["error_e_m"][row], n = table["error_n_m"][row], u = table["error_u_m"][row];
  return std::sqrt(e * e + n * n + u * u);
}

std::optional<std::size_t> worst_horizontal_row(const EpochTable& nav) {
  std::optional<std::size_t> worst;
  double worst_m = -1;
  for (std::size_t i = 0; i < nav.rows; ++i) {
    const double error_m = std::hypot(nav["error_e_m"][i], nav["error_n_m"][i]);
    if (error_m > worst_m) worst_m = error_m, worst = i;
  }
  return worst;
}

Reception reception(const EpochTable& gnss, double from_s, double to_s) {
  Reception r{.satellites_min = kNaN, .satellites_max = kNaN, .gdop_max = kNaN, .multipath_max_m = kNaN};
  for (std::size_t i = 0; i < gnss.rows; ++i) {
    const double t = gnss["t_s"][i];
    if (t < from_s || t > to_s) continue;
    ++r.epochs;
    // fmin and fmax pass over NaN.
    if (gnss.text("status")[i] == "none") {
      ++r.without_fix;
      r.last_reason = gnss.text("reason")[i];
    } else {
      r.satellites_min = std::fmin(r.satellites_min, gnss["satellites"][i]);
      r.satellites_max = std::fmax(r.satellites_max, gnss["satellites"][i]);
    }
    r.gdop_max = std::fmax(r.gdop_max, gnss["gdop"][i]);
    r.multipath_max_m = std::fmax(r.multipath_max_m, std::abs(gnss["multipath_max_m"][i]));
  }
  return r;
}

double share_within_sigma(const EpochTable& nav, double k) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kAxes{
      {{"error_e_m", "sigma_e_m"}, {"error_n_m", "sigma_n_m"}, {"error_u_m", "sigma_u_m"}}};
  std::size_t defined = 0, within = 0;
  for (const auto& [error, sigma] : kAxes) {
    for (std::size_t i = 0; i < nav.rows; ++i) {
      const double e = nav[error][i], s = nav[sigma][i];
      if (!std::isfinite(e) || !std::isfinite(s)) continue;
      ++defined;
      if (std::abs(e) <= k * s) ++within;
    }
  }
  return defined ? static_cast<double>(within) / static_cast<double>(defined) : kNaN;
}

double last_epoch_s(const Results& results) {
  double last_s = 0;
  for (const Run& run : results.runs) {
    for (const std::optional<EpochTable>* table : {&run.nav, &run.gnss_epochs, &run.keyframes}) {
      if (*table && (*table)->rows > 0) last_s = std::max(last_s, (**table)["t_s"].back());
    }
  }
  return last_s;
}

}  // namespace canyon::report
