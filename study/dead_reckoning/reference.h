#pragma once

#include <string>
#include <vector>

#include "canyon/core/files/navigation_file.h"
#include "canyon/study/dead_reckoning/recording.h"

namespace canyon::study {

/// Where an integration starts and what it is compared with.
struct Reference {
  fusion::NavState initial;
  std::vector<fusion::NavState> truth;  ///< the start and what comes after it; empty: none
  std::string gravity;                  ///< that the truth file states
};

/// The first instant that a reference solution and the log have in common; `path`: of the solution. An error where
/// there is none, or no velocity.
Result<Reference> reference_from_file(const NavigationFile& truth, const std::string& path,
                                      const ImuRecording& recording);

/// The gravity that the file states must be one that we have.
Status check_stated_gravity(const NavigationFile& truth, const std::string& path);

/// A start at the log's first stamp, without anything to compare with. Velocity north, east, down; angles of
/// forward-right-down in north-east-down.
struct InitialState {
  Geodetic place;
  Eigen::Vector3d v_ned_m_s = Eigen::Vector3d::Zero();
  double roll_rad = 0.0, pitch_rad = 0.0, heading_rad = 0.0;
};
Reference reference_from_state(const InitialState& state, const ImuRecording& recording);

/// At rest all the time: levelled with the mean force of the first seconds, heading as given.
Reference reference_at_rest(const Geodetic& place, double heading_rad, double level_s, const ImuRecording& recording);

/// "12.000 to 34.000 s of the week" of the first; they go on past its end.
std::string of_week(GpsTime first, GpsTime last);

}  // namespace canyon::study
