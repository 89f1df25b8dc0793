#pragma once

#include <vector>

#include "canyon/core/files/tape.h"
#include "canyon/mission/config/mission_file.h"

namespace canyon::study {

/// How far the estimate of position moves along the mission's own route where every range of every fix is moved by up
/// to b: all figures here are per metre of b.
///
/// Of a fix: the sum of |d position / d range| of that epoch's own weighted solution, with the satellites that are
/// tracked there (weights and tracking do not depend on the seed's noise). Epochs whose sum is above `most_gain` move
/// by nothing, since a run measures them in full. From fixes to estimates: the filter's summed absolute impulse
/// response (fusion/fix_response.h) with the gains of its own covariance along the route, each fix moved in the worst
/// direction. Between two fixes the largest is at one of the ends, as the norm of what grows linearly is convex.
///
/// Rigorous are the norms and the worst signs; first order is the linearization of solver and filter, whose remainder
/// falls with the square of b. In a closed loop the vehicle goes another way, where gains differ.
struct PositionChain {
  double most_gain = 0.0;
  std::vector<double> fix_t_s;  ///< after the start, of each fix that the filter took
  std::vector<double> fix;      ///< how far it moves
  std::vector<double> any, up;  ///< the estimate from that fix to the next, in space and along W's vertical
  double rms() const;           ///< of `any` over the route: an RMS of errors moves by no more
  double rms_up() const;
  double most_after(double t_s) const;  ///< `any` of the interval that holds t_s; 0 before the first fix
};

/// Drives sensor, IMU and filter along the tape once, without LIDAR and autonomy. Errors as of run_mission.
Result<PositionChain> position_chain(const mission::MissionConfig& config, const mission::PreparedMission& mission,
                                     const Tape& tape);

}  // namespace canyon::study
