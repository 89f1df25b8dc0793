#pragma once

#include <array>
#include <vector>

#include "canyon/study/drive_check/drive_signals.h"

namespace canyon::study {

/// How well the range error of each measured signal is foretold, by the continuous ranked probability score of draws
/// (CRPS, m; Gneiting & Raftery 2007; the form that is fair to few draws, Ferro 2014): mean distance of the draws from
/// what came, less half their mean distance from one another. Lower is better.
struct DriveScore {
  int signals = 0, draws = 0;
  double foretold_share = kNaN;  ///< at least two draws track the signal; for others stand all draws of their kind
  /// Mean over signals: by the simulation; by measured errors of any satellite; by those of satellites at most 5
  /// degrees higher or lower. The measured ones are of the drive outside the signal's own block of 20 s and 5 s
  /// about it.
  double simulation_m = kNaN, blind_m = kNaN, elevation_m = kNaN;
  /// Simulation less the other: 95 % of 2000 block bootstraps. Below zero: geometry tells more.
  std::array<double, 2> against_blind_m{kNaN, kNaN}, against_elevation_m{kNaN, kNaN};
};

/// Signals of the measured drive with an error, at epochs that the draws have too. Nothing without draws, or where the
/// drive is too short for another block.
DriveScore drive_score(const std::vector<DriveEpoch>& measured, const std::vector<std::vector<DriveEpoch>>& draws,
                       std::uint64_t seed);

/// CRPS of draws, at least two.
double crps(const std::vector<double>& draws, double came);

}  // namespace canyon::study
