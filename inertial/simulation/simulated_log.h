#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "canyon/core/files/navigation_file.h"
#include "canyon/core/process/progress.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/inertial/motion/motion.h"

namespace canyon::inertial {

/// What an IMU would have recorded on a motion of its own, and the truth beside it, sample by sample.
struct SimulatedLog {
  PlacedMotion motion;
  double rate_hz = 0.0;
  std::vector<ImuSample> truth, measured;
  IncrementAccuracy accuracy;  ///< of the least accurate true increment
};

/// How many samples end within a time; rounding of the product does not cost the last one.
std::size_t whole_samples(double duration_s, double rate_hz);

/// `samples` of at least 1 from the motion's start on, corrupted by `chain`. All are held in memory.
SimulatedLog simulate_log(const PlacedMotion& motion, double rate_hz, std::size_t samples, ErrorChain& chain,
                          Progress& progress);

/// The largest magnitudes of a log, and what it lost.
struct LogExtremes {
  double speed_m_s = 0.0, rate_rad_s = 0.0, force_m_s2 = 0.0;
  std::size_t lost = 0;
};
LogExtremes extremes(const SimulatedLog& log);

/// Mean rates over the true intervals, forward-left-up: an error of the clock is in the stamps alone. Times of all
/// files are seconds of the start's week, which go on past its end.
std::string rates_csv(const SimulatedLog& log);
/// Increments, forward-right-down, as KF-GINS reads them.
std::string kf_gins_text(const SimulatedLog& log);
/// What the chain has added, as rates: the truth record of the log, row by row.
std::string errors_csv(const SimulatedLog& log);
/// The IMU at the start and at every sample's end.
NavigationFile truth_file(const SimulatedLog& log);

/// imu.csv, imu_kf_gins.txt, errors.csv and truth.nav, into an existing folder; and in what frames they are.
Status write_simulated_log(const std::string& folder, const SimulatedLog& log);
inline constexpr const char* kSimulatedLogFrames =
    "imu.csv, errors.csv: forward-left-up, means over the interval that ends at t_s; imu_kf_gins.txt: "
    "forward-right-down, increments (rad, m/s) over the same; truth.nav: the IMU, forward-right-down "
    "in north-east-down; times are seconds of the start's GPS week";

}  // namespace canyon::inertial
