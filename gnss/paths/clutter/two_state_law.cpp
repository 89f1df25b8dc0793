#include "canyon/gnss/paths/clutter/two_state_law.h"

#include <algorithm>
#include <cmath>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/csv_table.h"

namespace canyon::gnss {
namespace {

constexpr const char* kTwoStateTable = "gnss/tables/p681_two_state.csv";

double below(double z) {
  return 0.5 * std::erfc(-z * std::sqrt(0.5));
}

/// Of a lognormal duration, those shorter than `least` left out.
double mean_duration(double mu, double sigma, double least_m) {
  const double cut = (std::log(least_m) - mu) / sigma;
  return std::exp(mu + 0.5 * sigma * sigma) * below(sigma - cut) / below(-cut);
}

SignalState read_state(const std::vector<std::string_view>& row, std::size_t first) {
  const auto number = [&](std::size_t i) { return table_number(row[first + i]); };
  return {
      mean_duration(number(0), number(1), number(2)), number(3), number(4), number(5), number(6), number(7), number(8)};
}

/// Share of what is weaker than `level_db`.
double weaker(const TwoStateLaw::Elevation& e, double level_db) {
  return (1.0 - e.shaded_share) * below((level_db - e.good.ma_db) / e.good.ma_sigma_db) +
         e.shaded_share * below((level_db - e.bad.ma_db) / e.bad.ma_sigma_db);
}

}  // namespace

std::vector<std::string> TwoStateLaw::environments() {
  std::vector<std::string> names;
  for (const auto& row : table_rows(kTwoStateTable))
    if (names.empty() || names.back() != row[0]) names.emplace_back(row[0]);
  return names;
}

TwoStateLaw::TwoStateLaw(const std::string& environment, double shaded_scale) {
  for (const auto& row : table_rows(kTwoStateTable)) {
    if (row[0] != environment) continue;
    Elevation e{table_number(row[1]) * kDegree, read_state(row, 2), read_state(row, 11), 0.0};
    e.shaded_share =
        std::min(shaded_scale * e.bad.mean_duration_m / (e.good.mean_duration_m + e.bad.mean_duration_m), 1.0);
    table_.push_back(e);
    add_quantiles(e);
  }
  CANYON_CHECK(table_.size() > 1, "no environment ", environment);
}

/// By halving: 60 times narrows 200 dB to below rounding.
void TwoStateLaw::add_quantiles(const Elevation& e) {
  std::array<double, kNodes> levels_db;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double share = below(static_cast<double>(i) * kStep - kEnd);
    double low_db = -100.0, high_db = 100.0;
    for (int k = 0; k < 60; ++k) {
      const double middle_db = 0.5 * (low_db + high_db);
      (weaker(e, middle_db) < share ? low_db : high_db) = middle_db;
    }
    levels_db[i] = 0.5 * (low_db + high_db);
  }
  quantiles_.push_back(levels_db);
}

TwoStateLaw::Between TwoStateLaw::between(double elevation_rad) const {
  std::size_t low = 0;
  while (low + 2 < table_.size() && elevation_rad > table_[low + 1].elevation_rad) ++low;
  const double from_rad = table_[low].elevation_rad, to_rad = table_[low + 1].elevation_rad;
  return {low, std::clamp((elevation_rad - from_rad) / (to_rad - from_rad), 0.0, 1.0)};
}

double TwoStateLaw::quantile(std::size_t elevation, double z) const {
  const double place = std::clamp((z + kEnd) / kStep, 0.0, static_cast<double>(kNodes - 1));
  const auto low = std::min(static_cast<std::size_t>(place), kNodes - 2);
  const std::array<double, kNodes>& levels_db = quantiles_[elevation];
  return levels_db[low] + (place - static_cast<double>(low)) * (levels_db[low + 1] - levels_db[low]);
}

double TwoStateLaw::mean_level_db(double z, double elevation_rad) const {
  const auto [low, part] = between(elevation_rad);
  return (1.0 - part) * quantile(low, z) + part * quantile(low + 1, z);
}

double TwoStateLaw::spread_db(double mean_level_db, double elevation_rad) const {
  const auto [low, part] = between(elevation_rad);
  // Which state a level is of changes evenly over the gap between the two, so that nothing jumps with it.
  const auto of = [&](const Elevation& e) {
    const double bad = std::clamp((e.good.ma_db - mean_level_db) / (e.good.ma_db - e.bad.ma_db), 0.0, 1.0);
    const double good_db = std::max(e.good.g1 * mean_level_db + e.good.g2_db, 0.0);
    const double bad_db = std::max(e.bad.g1 * mean_level_db + e.bad.g2_db, 0.0);
    return (1.0 - bad) * good_db + bad * bad_db;
  };
  return (1.0 - part) * of(table_[low]) + part * of(table_[low + 1]);
}

double TwoStateLaw::multipath_power(bool shaded, double elevation_rad) const {
  const auto [low, part] = between(elevation_rad);
  const auto of = [&](const Elevation& e) {
    const SignalState& state = shaded ? e.bad : e.good;
    return state.h1 * state.ma_db + state.h2_db;
  };
  return std::pow(10.0, 0.1 * ((1.0 - part) * of(table_[low]) + part * of(table_[low + 1])));
}

}  // namespace canyon::gnss
