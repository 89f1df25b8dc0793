#pragma once

#include <vector>

#include "canyon/core/files/tape.h"

namespace canyon::study {

/// Pieces of a tape that together last `total_s`, spread evenly from its start to its end, each at least
/// kShortestPiece_s long; the tape itself where that is all of it. Times count from the start of each piece.
std::vector<Tape> spread_pieces(const Tape& tape, double total_s);

/// What a run needs for its first scans and fixes, and as much again to go on with.
inline constexpr double kShortestPiece_s = 3.0;

}  // namespace canyon::study
