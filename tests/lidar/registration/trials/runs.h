#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "canyon/tests/lidar/registration/trials/judging.h"

namespace canyon::lidar::trials {

/// Who is asked.
struct Asked {
  std::string method = "gicp";
  std::vector<std::string> forms{"calibrated"};  ///< of covariance; the first gives Outcome::verdict
  bool pcl = false;                              ///< pcl_gicp beside
  double leaf_m = 0.5;                           ///< as missions have it
};

struct Outcome {
  Verdict verdict;
  RegistrationStatus status = RegistrationStatus::kNotConverged;
  bool ambiguous = false;  ///< as Trial's
  int open_in_truth = 0;   ///< directions that the place leaves open
  bool all_right = false;  ///< within the bounds in all others, whatever is called open
  bool pcl_converged = false, pcl_right = false;
  std::vector<Verdict> forms;  ///< as asked
  double overlap = kNaN;
  std::size_t points = 0;
};

/// Trials first .. first + count - 1 of a place, a sensor and a ring. The same for any number of threads.
std::vector<Outcome> run_trials(const Asked& asked, const Place& place, const Sensor& sensor, const Ring& ring,
                                std::uint64_t seed, std::uint64_t count);

}  // namespace canyon::lidar::trials
