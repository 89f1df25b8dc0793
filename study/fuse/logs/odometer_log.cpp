#include <cmath>

#include "canyon/core/messages.h"
#include "canyon/study/fuse/logs/aiding_logs.h"
#include "canyon/study/fuse/logs/timed_log.h"

namespace canyon::study {
namespace {

enum Target { kWeek = TimedLogLayout::kWeek, kTime = TimedLogLayout::kTime, kSpeed, kTicks, kInterval, kTargets };
constexpr KnownColumn kColumns[] = {
    {"gps_week", Quantity::kPlain, kWeek}, {"week", Quantity::kPlain, kWeek},   {"sow", Quantity::kTime, kTime},
    {"t", Quantity::kTime, kTime},         {"time", Quantity::kTime, kTime},    {"speed", Quantity::kSpeed, kSpeed},
    {"v", Quantity::kSpeed, kSpeed},       {"ticks", Quantity::kPlain, kTicks}, {"dt", Quantity::kTime, kInterval},
};

}  // namespace

Result<OdometerLog> read_odometer_log(const std::string& path, const FuseOdometerConfig& config) {
  CANYON_TRY(TimedLog in, TimedLog::open(path, {.columns = kColumns,
                                                .targets = kTargets,
                                                .expected = "columns t_s (or sow) and speed_m_s or ticks",
                                                .key = "odometer.columns",
                                                .columns_given = config.columns}));
  in.lacking = [](const TimedLog& log) {
    return log.has(kSpeed) || log.has(kTicks) ? nullptr : "neither speed nor ticks";
  };
  OdometerLog out;
  while (true) {
    CANYON_TRY(const bool more, in.next());
    if (!more) break;
    CANYON_TRY(const double speed, in.number(kSpeed));
    CANYON_TRY(const double ticks, in.number(kTicks));
    CANYON_TRY(double dt_s, in.number(kInterval));
    if (!(dt_s > 0.0)) dt_s = in.since_s();
    OdometerSample sample{.t = in.t(), .dt_s = dt_s, .ticks = 0, .speed_m_s = speed};
    if (in.has(kTicks) && std::abs(ticks) < 9e15) sample.ticks = static_cast<std::int64_t>(ticks);
    if (!in.has(kSpeed)) sample.speed_m_s = ticks * config.tick_m / dt_s;
    if (std::isfinite(sample.speed_m_s) && std::isfinite(dt_s))
      out.samples.push_back(sample);
    else if (!std::isnan(dt_s))  // the first line has no interval of its own
      in.pass_over();
  }
  if (out.samples.empty()) return in.empty_file("speeds");
  out.has_week = in.has_week();
  out.passed_over = in.passed_over();
  return out;
}

}  // namespace canyon::study
