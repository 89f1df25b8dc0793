#include <cmath>

#include "canyon/core/messages.h"
#include "canyon/study/fuse/logs/aiding_logs.h"
#include "canyon/study/fuse/logs/timed_log.h"

namespace canyon::study {
namespace {

struct OdometerColumn {
  enum : int { kWeek = TimedLogLayout::kWeek, kTime = TimedLogLayout::kTime, kSpeed, kTicks, kInterval, kTargets };
};
constexpr KnownColumn kOdometerColumns[] = {
    {"gps_week", Quantity::kPlain, OdometerColumn::kWeek}, {"week", Quantity::kPlain, OdometerColumn::kWeek},
    {"sow", Quantity::kTime, OdometerColumn::kTime},       {"t", Quantity::kTime, OdometerColumn::kTime},
    {"time", Quantity::kTime, OdometerColumn::kTime},      {"speed", Quantity::kSpeed, OdometerColumn::kSpeed},
    {"v", Quantity::kSpeed, OdometerColumn::kSpeed},       {"ticks", Quantity::kPlain, OdometerColumn::kTicks},
    {"dt", Quantity::kTime, OdometerColumn::kInterval},
};

}  // namespace

Result<OdometerLog> read_odometer_log(const std::string& path, const FuseOdometerConfig& config) {
  CANYON_TRY(TimedLog in, TimedLog::open(path, {.columns = kOdometerColumns,
                                                .targets = OdometerColumn::kTargets,
                                                .expected = "columns t_s (or sow) and speed_m_s or ticks",
                                                .key = "odometer.columns",
                                                .columns_given = config.columns}));
  in.lacking = [](const TimedLog& log) {
    return log.has(OdometerColumn::kSpeed) || log.has(OdometerColumn::kTicks) ? nullptr : "neither speed nor ticks";
  };
  OdometerLog out;
  while (true) {
    CANYON_TRY(const bool more, in.next());
    if (!more) break;
    CANYON_TRY(const double speed, in.number(OdometerColumn::kSpeed));
    CANYON_TRY(const double ticks, in.number(OdometerColumn::kTicks));
    CANYON_TRY(double dt_s, in.number(OdometerColumn::kInterval));
    if (!(dt_s > 0.0)) dt_s = in.since_s();
    OdometerSample sample{.t = in.t(), .dt_s = dt_s, .ticks = 0, .speed_m_s = speed};
    if (in.has(OdometerColumn::kTicks) && std::abs(ticks) < 9e15) sample.ticks = static_cast<std::int64_t>(ticks);
    if (!in.has(OdometerColumn::kSpeed)) sample.speed_m_s = ticks * config.tick_m / dt_s;
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
