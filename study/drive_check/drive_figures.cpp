#include "canyon/study/drive_check/drive_figures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "canyon/core/math/chi_square.h"

namespace canyon::study {
namespace {

/// Values of one kind of signal over the drive.
struct Kind {
  std::vector<double> cn0_dbhz, error_m, rate_m_s;
  double count = 0.0;
};

Kind gather(const std::vector<DriveEpoch>& epochs, bool in_sight) {
  Kind out;
  for (const DriveEpoch& epoch : epochs) {
    for (const DriveSignal& s : epoch.signals) {
      if (s.in_sight != in_sight) continue;
      ++out.count;
      if (std::isfinite(s.cn0_dbhz)) out.cn0_dbhz.push_back(s.cn0_dbhz);
      if (std::isfinite(s.error_m)) out.error_m.push_back(s.error_m);
      if (std::isfinite(s.rate_error_m_s)) out.rate_m_s.push_back(s.rate_error_m_s);
    }
  }
  return out;
}

std::vector<double> sizes(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  return values;
}

template <std::size_t N>
std::array<double, N> quantiles(const std::vector<double>& values, const std::array<double, N>& p) {
  std::array<double, N> out{};
  for (std::size_t i = 0; i < N; ++i) out[i] = drive_quantile(values, p[i]);
  return out;
}

double area_under_curve(const std::vector<double>& high, std::vector<double> low) {
  if (high.empty() || low.empty()) return kNaN;
  std::sort(low.begin(), low.end());
  double sum = 0.0;
  for (const double x : high) {
    const auto [first, last] = std::equal_range(low.begin(), low.end(), x);
    sum += 0.5 * static_cast<double>((first - low.begin()) + (last - low.begin()));
  }
  return sum / (static_cast<double>(high.size()) * static_cast<double>(low.size()));
}

/// Pairs of one satellite `lag_s` apart, to 0.06 s.
double autocorrelation(const std::vector<DriveEpoch>& epochs, bool in_sight, double lag_s) {
  constexpr double kNear_s = 0.06;
  std::map<SatelliteId, std::vector<std::pair<GpsTime, double>>> series;
  double sum = 0.0, n = 0.0;
  for (const DriveEpoch& epoch : epochs) {
    for (const DriveSignal& s : epoch.signals) {
      if (s.in_sight != in_sight || !std::isfinite(s.error_m)) continue;
      series[s.sv].emplace_back(epoch.t, s.error_m);
      sum += s.error_m;
      ++n;
    }
  }
  const double mean = sum / n;
  double product = 0.0, first2 = 0.0, second2 = 0.0;
  for (const auto& [sv, values] : series) {
    std::size_t j = 0;
    for (const auto& [t, value] : values) {
      while (j < values.size() && values[j].first - t < lag_s - kNear_s) ++j;
      if (j == values.size() || values[j].first - t > lag_s + kNear_s) continue;
      const double a = value - mean, b = values[j].second - mean;
      product += a * b;
      first2 += a * a;
      second2 += b * b;
    }
  }
  return product / std::sqrt(first2 * second2);
}

void add_fixes(const std::vector<DriveFix>& fixes, DriveFigures& out) {
  std::vector<double> horizontal_m;
  double beyond = 0.0;
  const double limit = chi_square_threshold(0.0026997960632601866, 2.0);  // two-sided 3 sigma of a normal
  for (const DriveFix& fix : fixes) {
    const bool solved = std::isfinite(fix.horizontal_m);
    horizontal_m.push_back(solved ? fix.horizontal_m : std::numeric_limits<double>::infinity());
    out.fixes += solved ? 1 : 0;
    beyond += solved && fix.normalised2 > limit ? 1.0 : 0.0;
  }
  out.instants = static_cast<int>(fixes.size());
  out.fix_h50_m = drive_quantile(horizontal_m, 0.5);
  out.fix_h95_m = drive_quantile(horizontal_m, 0.95);
  if (out.fixes > 0) out.beyond_3_sigma = beyond / out.fixes;
}

}  // namespace

double drive_quantile(std::vector<double> values, double p) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  const double rank = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const double part = rank - static_cast<double>(below);
  if (part == 0.0) return values[below];
  return std::isinf(values[below + 1]) ? values[below + 1] : values[below] + part * (values[below + 1] - values[below]);
}

DriveFigures drive_figures(const std::vector<DriveEpoch>& epochs, const std::vector<DriveFix>& fixes) {
  const Kind seen = gather(epochs, true), hidden = gather(epochs, false);
  const auto n = static_cast<double>(epochs.size());
  DriveFigures out;
  out.tracked_in_sight = n > 0.0 ? seen.count / n : kNaN;
  out.tracked_hidden = n > 0.0 ? hidden.count / n : kNaN;
  constexpr std::array kStrengths{0.1, 0.5, 0.9}, kSigned{0.05, 0.5, 0.95};
  constexpr std::array kSizes{0.5, 0.95};
  out.cn0_in_sight_dbhz = quantiles(seen.cn0_dbhz, kStrengths);
  out.cn0_hidden_dbhz = quantiles(hidden.cn0_dbhz, kStrengths);
  out.cn0_auc = area_under_curve(seen.cn0_dbhz, hidden.cn0_dbhz);
  out.hidden_error_m = quantiles(sizes(hidden.error_m), kSizes);
  out.hidden_signed_m = quantiles(hidden.error_m, kSigned);
  out.in_sight_signed_m = quantiles(seen.error_m, kSigned);
  out.in_sight_error_p95_m = drive_quantile(sizes(seen.error_m), 0.95);
  const auto positive = std::count_if(hidden.error_m.begin(), hidden.error_m.end(), [](double e) { return e > 0.0; });
  if (!hidden.error_m.empty())
    out.hidden_positive_share = static_cast<double>(positive) / static_cast<double>(hidden.error_m.size());
  constexpr std::array kLags_s{1.0, 5.0, 10.0};
  for (std::size_t i = 0; i < kLags_s.size(); ++i) {
    out.hidden_autocorrelation[i] = autocorrelation(epochs, false, kLags_s[i]);
    out.in_sight_autocorrelation[i] = autocorrelation(epochs, true, kLags_s[i]);
  }
  out.hidden_rate_m_s = quantiles(sizes(hidden.rate_m_s), kSizes);
  add_fixes(fixes, out);
  return out;
}

}  // namespace canyon::study
