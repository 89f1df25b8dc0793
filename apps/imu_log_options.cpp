#include "apps/imu_log_options.h"

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

const char* channel_unit(int channel) {
  return channel < 3 ? "rad/s" : "m/s^2";
}

}  // namespace canyon::apps
