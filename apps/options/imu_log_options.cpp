#include "canyon/apps/options/imu_log_options.h"

#include <algorithm>
#include <cstdio>

#include "canyon/apps/line/verb.h"
#include "canyon/core/units.h"

namespace canyon::apps {

void declare_imu_log(Arguments& arguments, ImuLogOptions& options) {
  std::string layouts;
  for (const inertial::ImuLogLayout& layout : inertial::imu_log_layouts())
    layouts += (layouts.empty() ? "" : "; ") + std::string(layout.name) + " (" + layout.doc + ")";
  arguments
      .option("LOG", options.log,
              "CSV or columns apart by blanks, plain or gzip; the header names channels and units: t_s, gx_rad_s "
              "(or _deg_s, _deg_h, _rad and _deg for increments), ax_m_s2 (or _g, _mg, _m_s)")
      .required();
  arguments.option("--rate", options.rate_hz, "samples per second: for a log without times, or instead of its times")
      .within(1e-3, 1e6);
  arguments.option(
      "--columns", options.columns,
      "column names for a log without header, with *FACTOR for counts: t_us,gx_deg_s*0.05,...; or a layout: " +
          layouts);
}

Result<inertial::ImuLog> read_log(const ImuLogOptions& options, bool live) {
  return inertial::read_imu_log(options.log, {.columns = options.columns, .rate_hz = options.rate_hz, .live = live});
}

void tell_doubts(const inertial::ImuLog& log) {
  print_warnings(log.doubts);
}

void tell_motion(const std::string& path, const inertial::MotionFound& motion) {
  constexpr std::size_t kListed = 3;
  if (!motion.moves()) return;
  std::string where;
  char text[160];
  for (std::size_t i = 0; i < std::min(kListed, motion.intervals.size()); ++i) {
    const inertial::MovingInterval& m = motion.intervals[i];
    std::snprintf(text, sizeof text, "%s%.6g to %.6g s", i > 0 ? ", " : "", m.from_s, m.to_s);
    where += text;
  }
  if (motion.intervals.size() > kListed)
    where += " and " + std::to_string(motion.intervals.size() - kListed) + " more times";
  const inertial::MovingInterval& worst = motion.worst();
  const bool gyro = worst.channel < 3;
  std::snprintf(text, sizeof text, "%s %s by %.3g %s", inertial::kChannelNames[worst.channel],
                worst.shakes ? "shakes" : "differs from rest", worst.amount / (gyro ? kDegree : 1.0),
                gyro ? "deg/s" : "m/s^2");
  print_warning(path + " moves from " + where + " of its time (" + text +
                "): the figures are of noise and motion together");
}

}  // namespace canyon::apps
