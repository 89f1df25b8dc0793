#pragma once

#include <cstdint>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::study {

/// How far the estimate of position moves along a tape where every range of every fix is moved by up to b, at each row
/// of estimates that a run writes: all figures here are per metre of b.
///
/// Of a fix: the sum of |d position / d range| of that epoch's own weighted solution, with the satellites that are
/// tracked there (weights and tracking do not depend on the seed's noise). Epochs whose sum is above `most_gain` move
/// by nothing, since a run measures them in full. From fixes to estimates: the filter's summed absolute impulse
/// response (fusion/observers/fix_response.h) with the gains of its own covariance along the tape, each fix moved in
/// the worst direction. It is asked at every row, from the start to the tape's end: also where no fix comes any more.
///
/// Rigorous are the norms and the worst signs; first order is the linearization of solver and filter, whose remainder
/// falls with the square of b. Which fixes there are is decided by the seed's noise too (tests of residuals,
/// exclusion): the figures are the largest of those of `seeds`.
struct PositionChain {
  double most_gain = 0.0;
  std::vector<std::int64_t> seeds;  ///< that the tape was driven with
  std::vector<double> t_s;          ///< after the start, of each row
  std::vector<double> any, up;      ///< the estimate there, in space and along W's vertical
  double rms() const;               ///< of `any` over the rows: an RMS of errors moves by no more
  double rms_up() const;
};

/// Drives sensor, IMU and filter along the tape, without LIDAR and autonomy, with the mission's seed and those after
/// it, `seeds` of them. Errors as of run_mission.
Result<PositionChain> position_chain(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                     const Tape& tape, int seeds = 3);

}  // namespace canyon::study
