#include "canyon/study/plan/replay/tape_pieces.h"

#include <algorithm>
#include <cmath>

namespace canyon::study {

namespace {

Tape piece_of(const Tape& tape, std::size_t first, std::size_t last) {
  Tape piece = tape;
  piece.nodes.assign(tape.nodes.begin() + static_cast<std::ptrdiff_t>(first),
                     tape.nodes.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  const TapeNode start = piece.nodes.front();
  for (TapeNode& node : piece.nodes) {
    node.motion.t.ns -= start.motion.t.ns;
    node.distance_m -= start.distance_m;
  }
  return piece;
}

}  // namespace

std::vector<Tape> spread_pieces(const Tape& tape, double total_s) {
  constexpr double kMostPieces = 20.0;
  const double duration_s = tape.duration_s();
  if (!(total_s < duration_s) || duration_s <= kShortestPiece_s) return {tape};
  const double count = std::clamp(std::floor(total_s / kShortestPiece_s), 1.0, kMostPieces);
  const double length_s = std::max(total_s / count, kShortestPiece_s);
  const double nodes_each_s = static_cast<double>(tape.nodes.size() - 1) / duration_s;
  const auto length = static_cast<std::size_t>(std::ceil(length_s * nodes_each_s));
  if (length + 1 >= tape.nodes.size()) return {tape};
  std::vector<Tape> pieces;
  for (double k = 0.0; k < count; ++k) {
    const double share = count > 1.0 ? k / (count - 1.0) : 0.5;
    const auto first =
        static_cast<std::size_t>(std::llround(share * static_cast<double>(tape.nodes.size() - 1 - length)));
    pieces.push_back(piece_of(tape, first, first + length));
  }
  return pieces;
}

}  // namespace canyon::study
