#include "canyon/core/tables/column_names.h"

#include <charconv>
#include <cmath>
#include <set>

#include "canyon/core/files/line_reader.h"
#include "canyon/core/lower_case.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

using enum Quantity;
constexpr double kKilometrePerHour = 1.0 / 3.6;

constexpr ColumnUnit kUnits[] = {
    {"s", kTime, 1.0},
    {"sec", kTime, 1.0},
    {"ms", kTime, 1e-3},
    {"us", kTime, 1e-6},
    {"ns", kTime, 1e-9},
    {"rad", kAngle, 1.0},
    {"deg", kAngle, kDegree},
    {"rad_s", kAngularRate, 1.0},
    {"rad/s", kAngularRate, 1.0},
    {"radps", kAngularRate, 1.0},
    {"rps", kAngularRate, 1.0},
    {"deg_s", kAngularRate, kDegree},
    {"deg/s", kAngularRate, kDegree},
    {"degps", kAngularRate, kDegree},
    {"dps", kAngularRate, kDegree},
    {"mdps", kAngularRate, 1e-3 * kDegree},
    {"deg_h", kAngularRate, kDegree / 3600.0},
    {"dph", kAngularRate, kDegree / 3600.0},
    {"m", kLength, 1.0},
    {"mm", kLength, 1e-3},
    {"cm", kLength, 1e-2},
    {"km", kLength, 1e3},
    {"m_s", kSpeed, 1.0},
    {"m/s", kSpeed, 1.0},
    {"mps", kSpeed, 1.0},
    {"mm_s", kSpeed, 1e-3},
    {"km_h", kSpeed, kKilometrePerHour},
    {"kmh", kSpeed, kKilometrePerHour},
    {"kph", kSpeed, kKilometrePerHour},
    {"m_s2", kAcceleration, 1.0},
    {"m/s2", kAcceleration, 1.0},
    {"m/s^2", kAcceleration, 1.0},
    {"mps2", kAcceleration, 1.0},
    {"mpss", kAcceleration, 1.0},
    {"g", kAcceleration, kStandardGravity},
    {"mg", kAcceleration, kMilliG},
    {"m2", kArea, 1.0},
    {"m2_s2", kSpeedSquared, 1.0},
};

Error complaint(const Error& at, std::string what, std::string expected) {
  Error error = at;
  error.what = std::move(what);
  error.expected = std::move(expected);
  return error;
}

/// The known column with the longest name that `name` is, or begins with before an underscore.
const KnownColumn* known_of(std::string_view name, std::span<const KnownColumn> known) {
  const KnownColumn* found = nullptr;
  for (const KnownColumn& one : known) {
    const std::string_view its = one.name;
    const bool is = name == its || (name.size() > its.size() && name.starts_with(its) && name[its.size()] == '_' &&
                                    one.quantity != kPlain);
    if (is && (found == nullptr || its.size() > std::string_view(found->name).size())) found = &one;
  }
  return found;
}

}  // namespace

std::span<const ColumnUnit> column_units() {
  return kUnits;
}

std::optional<double> unit_value(Quantity quantity, std::string_view suffix) {
  for (const ColumnUnit& unit : kUnits)
    if (unit.quantity == quantity && suffix == unit.suffix) return unit.si;
  return std::nullopt;
}

std::optional<double> column_factor(std::string_view name) {
  const std::size_t star = name.find('*');
  if (star == std::string_view::npos) return 1.0;
  const std::string_view number = trimmed(name.substr(star + 1));
  double factor = 0.0;
  const auto [stop, status] = std::from_chars(number.data(), number.data() + number.size(), factor);
  if (status != std::errc() || stop != number.data() + number.size() || !std::isfinite(factor) || factor == 0.0)
    return std::nullopt;
  return factor;
}

Result<std::vector<PlacedColumn>> place_columns(const std::vector<std::string_view>& names,
                                                std::span<const KnownColumn> known, const Error& at) {
  std::vector<PlacedColumn> out;
  std::set<int> taken;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = lower_case(std::string(trimmed(names[i].substr(0, names[i].find('*')))));
    const KnownColumn* column = known_of(name, known);
    if (column == nullptr) continue;
    const std::string whole = "column \"" + std::string(trimmed(names[i])) + "\"";
    const auto factor = column_factor(names[i]);
    if (!factor) return complaint(at, whole + ": no factor", "a number after the star that is not zero");
    PlacedColumn placed{.field = i, .target = column->target, .factor = *factor, .unit = {}};
    const std::string_view its = column->name;
    const bool bare = name.size() == its.size();
    if (!bare) placed.unit = name.substr(its.size() + 1);
    const std::string_view unit = !bare ? std::string_view(placed.unit) : column->unit ? column->unit : "";
    if (!unit.empty()) {
      const auto value = unit_value(column->quantity, unit);
      if (!value) continue;  // something else of it, as lat_variance
      placed.factor *= *value;
    }
    if (!taken.insert(placed.target).second) return complaint(at, "two columns for " + std::string(its), "one");
    out.push_back(placed);
  }
  return out;
}

bool is_header_line(std::string_view line) {
  return line.find_first_of("abcdfghijklmnopqrstuvwxyzABCDFGHIJKLMNOPQRSTUVWXYZ_") != std::string_view::npos;
}

}  // namespace canyon
