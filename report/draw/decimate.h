#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace canyon::report {

/// One piece of a line without gaps: indices into the series, increasing.
using LinePiece = std::vector<std::size_t>;

/// Which samples of a long series a chart must draw: of each of `buckets` equal intervals of x the first, the last, the
/// least and the greatest (M4, Jugel et al. 2014), so that at one bucket per pixel column the picture is the same and
/// no spike is lost. Samples whose y is NaN are gaps: the line is cut there, unless the gap lies inside one bucket. x
/// must not decrease. Series of up to 4 * buckets samples are kept whole. At most 4 * buckets indices come back.
std::vector<LinePiece> decimate(std::span<const double> x, std::span<const double> y, std::size_t buckets);

}  // namespace canyon::report
