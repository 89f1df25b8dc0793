#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "canyon/tests/lidar/free_ground.h"

/// The ground that a recording grazes, beside what a scanner of ours in the same place makes of it.
namespace canyon::lidar::testing {

/// A turn of the head or a part of one, its columns in the order of their directions.
struct RecordedTurn {
  std::vector<ShotColumn> columns;
  GroundPlane ground;  ///< distances from where L has its origin
};
/// A recording, and the scanner that is held against it.
struct GroundRecording {
  std::string beams;                ///< the table of its sensor
  std::vector<std::size_t> lasers;  ///< of these, by number, those whose shots the columns have
  std::size_t steps = 0;            ///< columns of a whole turn
  std::ptrdiff_t beside = 0;        ///< by so many columns a scan's rays may be off (count_ground)
  std::vector<RecordedTurn> turns;
};
/// What a configuration of ours makes of the same beams.
struct GroundScan {
  std::string name;
  std::string keys;  ///< of [lidar]
};

/// The beam of `high` (missions/fidelities.toml), where a target of 10 % is seen up to so far.
std::string beam_of_high(double range_at_10_percent_m, const std::string& reflection = "rough");

struct GroundComparison {
  GroundBins recorded;              ///< intensity as the sensor gives it
  std::vector<GroundBins> scanned;  ///< by each scan; intensity in per cent

  /// Bins beyond 10 m with 200 shots and more, by the range from which they begin, m.
  std::vector<double> judged_m() const;
  /// Those of them where the share that a scan returns is off by a factor of 1.5 or more.
  std::vector<double> misses_m(std::size_t scan) const;
  /// Those where 20 shots and more came back both in the recording and in a scan, and of these the ones where the
  /// median intensity of what came back is off by that factor.
  std::vector<double> intensities_judged_m(std::size_t scan) const;
  std::vector<double> intensity_misses_m(std::size_t scan) const;
  /// Expects of every bin beyond 10 m that as many simulated shots are bound for free ground as were recorded, up to
  /// what lies between columns (GroundBin::least, most).
  void expect_as_much_ground() const;
};

/// Scans level asphalt from as high and as askew as the recording sensor saw its ground, with a wall in each column
/// where its free ground ends, and prints both bin by bin: shots, share returned and intensity.
GroundComparison compare_ground(const GroundRecording& recording, const std::vector<GroundScan>& scans);

}  // namespace canyon::lidar::testing
