#pragma once

#include <string>
#include <string_view>

/// Numbers and names as the page shows them. Nothing here depends on the process's locale.
namespace canyon::report {

/// `text` with & < > " ' replaced, safe in HTML and SVG text and in quoted attributes. Bytes that are not UTF-8 and
/// control characters become U+FFFD, so that a damaged name cannot damage the page.
std::string escape_html(std::string_view text);

/// For people: `significant` digits, U+2212 as minus, groups of three from 10 000 on; an en dash where undefined (NaN).
std::string show_number(double value, int significant = 3);
/// show_number and a unit, apart by a no-break space: "4.31 m". Degrees stand close: "1.2°".
std::string show_quantity(double value, std::string_view unit, int significant = 3);
/// A share of 1 in per cent: 0.123 -> "12.3 %".
std::string show_share(double share);
/// A whole number, grouped.
std::string show_count(double value);

/// For machines: at most `decimals` decimals, no trailing zeros, never an exponent; "0" for what rounds to zero. The
/// value must be finite.
std::string fixed(double value, int decimals);

/// "4 fixes", "1 fix": the number and the word in singular or plural.
std::string count_of(double n, std::string_view one, std::string_view many);

}  // namespace canyon::report
