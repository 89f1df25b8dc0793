#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/core/need.h"
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
///
/// What the filter's own integrator can leave out acts in every step, and is known there: it is carried along as it is
/// (fusion/observers/step_response.h), and moves a row by no more than twice the largest that it has moved any row up
/// to then, and five sigmas of what it would were the signs of its moves chance. Twice, for what is not of first order,
/// and for the gains and estimates of other seeds; the sigmas, since what it makes of noise is another draw there: at
/// the first rows, half a second after the start, that is all there is.
struct PositionChain {
  double most_gain = 0.0;
  std::vector<std::int64_t> seeds;  ///< that the tape was driven with
  std::vector<double> t_s;          ///< after the start, of each row
  std::vector<double> any, up;      ///< the estimate there, in space and along W's vertical
  double rms() const;               ///< of `any` over the rows: an RMS of errors moves by no more
  double rms_up() const;

  /// Of an effect of the filter's integrator.
  struct Strapdown {
    Need need;                    ///< in its own unit
    std::vector<double> any, up;  ///< as above, m
    double turned_rad = 0.0;      ///< the sum of what it turned the attitude by, |theta| of each step
  };
  std::vector<Strapdown> strapdown{};
  std::int64_t steps = 0;  ///< of the filter in a run
};

double rms_of(const std::vector<double>& values);

/// Drives sensor, IMU and filter along the tape, without LIDAR and autonomy, with the mission's seed and those after
/// it, `seeds` of them. Errors as of run_mission.
Result<PositionChain> position_chain(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                     const Tape& tape, int seeds = 3);

}  // namespace canyon::study
