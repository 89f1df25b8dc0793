#include "canyon/inertial/imu_log.h"
#include "canyon/core/output/printed.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "canyon/core/process/staging_litter.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

/// A file that is gone with this.
class LogFile {
 public:
  explicit LogFile(const std::string& text) {
    static int count = 0;
    path_ = (std::filesystem::temp_directory_path() /
             ("canyon_stress_" + std::to_string(::getpid()) + "_" + std::to_string(count++) + ".csv"))
                .string();
    add_litter(path_, {});
    std::ofstream(path_) << text;
  }
  ~LogFile() {
    std::remove(path_.c_str());
    forget_litter(path_);
  }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Coning of 90 degrees at 50 Hz: 314 rad/s on each of two axes in turn, gravity all around. Taken as named.
StressFigure fast_coning() {
  std::string text = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
  const double w = 2.0 * kPi * 50.0;
  std::vector<std::array<double, 6>> rows;
  for (int k = 0; k < 400; ++k) {
    const double a = w * 0.0017 * k;
    rows.push_back(
        {-w * std::sin(a), w * std::cos(a), -w + 1e-6 * k, 9.8 * std::cos(a), 9.8 * std::sin(a), 1e-3 * std::sin(a)});
    text += printed("%.4f,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", 0.0017 * k, rows.back()[0], rows.back()[1],
                    rows.back()[2], rows.back()[3], rows.back()[4], rows.back()[5]);
  }
  const LogFile file(text);
  const auto log = read_imu_log(file.path(), {});
  if (!log.ok()) return {stress::kInfinity, 0.0};
  int wrong = 0;
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t c = 0; c < 6; ++c) wrong += log->channels[c][k] == rows[k][c] ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// One field of one line is no number, too large, missing, or its time does not increase.
StressFigure damaged_lines() {
  int passed = 0;
  for (const char* bad : {"0.02,nan,0,0,0,0,9.8", "0.02,0,inf,0,0,0,9.8", "0.02,0,0,1e300,0,0,9.8", "nan,0,0,0,0,0,9.8",
                          "inf,0,0,0,0,0,9.8", "0.01,0,0,0,0,0,9.8", "0.005,0,0,0,0,0,9.8", "0.02,0,0,0,0,9.8",
                          "0.02,0,0,0,0,0,", "0.02,0,0,0,0,-inf,9.8", "0.02,0,0,0,1e999,0,9.8", "0.02,a,0,0,0,0,9.8"}) {
    std::string text =
        "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n0.00,0.1,0,0,0,0,9.81\n0.01,0,0.1,0,0,0,9.8\n";
    text += std::string(bad) + "\n0.03,0.1,0,0.2,0.1,0.1,9.79\n0.04,0.1,0.2,0.3,0.1,0.2,9.79\n";
    ImuLogFormat format;
    format.live = false;
    passed += read_imu_log(LogFile(text).path(), format).ok() ? 1 : 0;
  }
  return {1.0 * passed, 0.0};
}

}  // namespace

std::vector<StressCase> imu_log_cases() {
  const StressMechanism units{StressGroup::kData, "a guess at units from the size of numbers",
                              "314 rad/s is taken for deg/s, and a true log is refused (2026-11-22)",
                              "what the header names is taken as named: every number to the bit", "numbers"};
  const StressMechanism damage{StressGroup::kData, "fields that are no numbers, and times that do not increase",
                               "not a number passes every comparison with a limit, an equal time divides by zero",
                               "each line is refused", "let through"};
  StressRows rows;
  rows.of(units).add("imu_log/coning_90_deg_at_50_hz", fast_coning);
  rows.of(damage).add("imu_log/damaged_lines", damaged_lines);
  return rows.take();
}

}  // namespace canyon::inertial
