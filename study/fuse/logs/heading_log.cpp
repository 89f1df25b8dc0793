#include <cmath>

#include "canyon/core/units.h"
#include "canyon/study/fuse/logs/aiding_logs.h"
#include "canyon/study/fuse/logs/timed_log.h"

namespace canyon::study {
namespace {

struct HeadingColumn {
  enum : int { kWeek = TimedLogLayout::kWeek, kTime = TimedLogLayout::kTime, kHeading, kSigma, kTargets };
};
constexpr KnownColumn kHeadingColumns[] = {
    {"gps_week", Quantity::kPlain, HeadingColumn::kWeek},
    {"week", Quantity::kPlain, HeadingColumn::kWeek},
    {"sow", Quantity::kTime, HeadingColumn::kTime},
    {"t", Quantity::kTime, HeadingColumn::kTime},
    {"time", Quantity::kTime, HeadingColumn::kTime},
    {"heading", Quantity::kAngle, HeadingColumn::kHeading, "deg"},
    {"yaw", Quantity::kAngle, HeadingColumn::kHeading, "deg"},
    {"sigma", Quantity::kAngle, HeadingColumn::kSigma, "deg"},
    {"sd", Quantity::kAngle, HeadingColumn::kSigma, "deg"},
    {"sigma_heading", Quantity::kAngle, HeadingColumn::kSigma, "deg"},
    {"sd_heading", Quantity::kAngle, HeadingColumn::kSigma, "deg"},
};

}  // namespace

Result<HeadingLog> read_heading_log(const std::string& path, const FuseHeadingConfig& config) {
  CANYON_TRY(TimedLog in, TimedLog::open(path, {.columns = kHeadingColumns,
                                                .targets = HeadingColumn::kTargets,
                                                .expected = "columns t_s (or sow), heading_deg and sigma_deg",
                                                .key = "heading.columns",
                                                .columns_given = config.columns}));
  in.lacking = [](const TimedLog& log) { return log.has(HeadingColumn::kHeading) ? nullptr : "no heading"; };
  HeadingLog out;
  while (true) {
    CANYON_TRY(const bool more, in.next());
    if (!more) break;
    CANYON_TRY(const double heading_rad, in.number(HeadingColumn::kHeading));
    CANYON_TRY(double sigma_rad, in.number(HeadingColumn::kSigma));
    if (!std::isfinite(heading_rad)) {
      in.pass_over();
      continue;
    }
    if (!(sigma_rad > 0.0)) sigma_rad = config.sigma_deg * kDegree;
    if (!(sigma_rad > 0.0))
      return in.error("a heading without a sigma, or with one of 0",
                      "a column sigma_deg, or heading.sigma_deg in --config");
    out.samples.push_back(
        {.t = in.t(), .heading_rad = heading_rad + config.offset_deg * kDegree, .sigma_rad = sigma_rad});
  }
  if (out.samples.empty()) return in.empty_file("headings");
  out.has_week = in.has_week();
  out.passed_over = in.passed_over();
  return out;
}

}  // namespace canyon::study
