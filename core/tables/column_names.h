#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"

namespace canyon {

/// What the numbers of a column are.
enum class Quantity { kTime, kAngle, kAngularRate, kLength, kSpeed, kAcceleration, kArea, kSpeedSquared, kPlain };

/// A unit as column names spell it, in lower case: `rad_s`, `radps`, `rps` and `rad/s` are one.
struct ColumnUnit {
  const char* suffix;
  Quantity quantity;
  double si;
};
std::span<const ColumnUnit> column_units();
/// The SI value of one; nullopt: no such unit of that quantity.
std::optional<double> unit_value(Quantity quantity, std::string_view suffix);

/// A column that a reader knows. A file may give its name as it stands, which is then in SI (angles of names that end
/// in _deg: degrees), or with a unit after it: `vn`, `vn_m_s`, `vn_kmh`.
struct KnownColumn {
  const char* name;
  Quantity quantity;
  int target;                  ///< the reader's own number of it; several names may have the same
  const char* unit = nullptr;  ///< the unit of a bare name; null: SI
};

/// Where a column of the file goes.
struct PlacedColumn {
  std::size_t field = 0;
  int target = 0;
  double factor = 1.0;  ///< to SI
  std::string unit;     ///< as spelt, empty for a bare name
};

/// The columns of a header, or of a list of names, that `known` names; others are passed over, and so are those with a
/// unit that there is not. A name may be followed by `*FACTOR`, for counts and for axes that point the other way. An
/// Error, at `at`, for a factor that is none, and for two columns of one target.
Result<std::vector<PlacedColumn>> place_columns(const std::vector<std::string_view>& names,
                                                std::span<const KnownColumn> known, const Error& at);

/// The factor after the star of a name, "gx_deg_s*0.05"; 1 without one, nullopt where it is no number, or zero.
std::optional<double> column_factor(std::string_view name);

/// Whether a line of a text file of numbers is one of names: it has letters that no number has.
bool is_header_line(std::string_view line);

}  // namespace canyon
