#include "canyon/apps/answers/dead_reckoning.h"

#include <cstdio>
#include <filesystem>

#include "canyon/core/earth/earth.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/fusion/reference_track.h"
#include "canyon/report/draw/picture.h"

namespace canyon::apps {

namespace {

constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop

void tell_scored(const study::DeadReckoning& o) {
  const study::Unscored left = study::unscored(o);
  std::printf("  scored from %s at %zu instants", study::of_week(o.errors.front().t, o.errors.back().t).c_str(),
              o.errors.size() - 1);
  if (left.before_s > fusion::kSameInstant_s || left.behind_s > fusion::kSameInstant_s)
    std::printf("; of the log %.3f s before and %.3f s after are not", left.before_s, left.behind_s);
  std::printf("\n");
}

}  // namespace

void print_dead_reckoning(const study::DeadReckoning& o) {
  std::printf("%s: %zu samples, %.3f s from %.3f s of the week; %s, gravity %s\n", o.recording.path.c_str(),
              o.states.size() - 1, o.states.back().t - o.states.front().t, o.states.front().t.sow_s(),
              o.integrator.c_str(), o.gravity.c_str());
  if (o.errors.size() < 2) {
    const Geodetic at = geodetic_from_ecef(o.states.back().p_EU_E);
    std::printf("  at the end: %.9f, %.9f deg, %.3f m\n", at.lat_rad / kDegree, at.lon_rad / kDegree, at.h_m);
    if (!(o.held.rounding_m <= fusion::kReferenceTells_m))
      std::printf("  of it rounding alone, which grows as e^(t / 570 s), may be %.2g m\n", o.held.rounding_m);
    return;
  }
  tell_scored(o);
  if (!o.holds())
    std::printf("  position and velocity hold until %.6g s; %s. Up to there:\n", o.since_start_s(*o.held.until),
                study::rounding_reason(o).c_str());
  const auto& s = o.held_ones;
  const auto row = [](const char* what, const Eigen::Vector3d& v, const char* unit) {
    std::printf("  %-32s %12.6g %12.6g %12.6g %s\n", what, v.x(), v.y(), v.z(), unit);
  };
  row("position RMS, east north up", s.position_rms_enu_m, "m");
  row("velocity RMS, east north up", s.velocity_rms_enu_m_s, "m/s");
  if (o.holds()) row("attitude RMS, roll pitch yaw", o.statistics.attitude_rms_rad / kDegree, "deg");
  row(o.holds() ? "at the end, east north up" : "at that time, east north up", o.held_errors().back().position_enu_m,
      "m");
  std::printf("  %s error %.6g m, of it horizontal %.6g m\n", o.holds() ? "final" : "then", s.final_error_m,
              s.final_horizontal_m);
  if (!o.holds()) row("attitude RMS of all the time", o.statistics.attitude_rms_rad / kDegree, "deg");
}

std::string dead_reckoning_svg(const study::DeadReckoning& o, const study::PlainIntegrals& plain) {
  using report::Panel;
  const char* const axes[3] = {"x", "y", "z"};
  Panel rates{.title = "Angular rate (as the paper's figure 2)", .unit = "deg/s"};
  Panel angles{.title = "Integral of each gyroscope (as figures 3 and 7)", .unit = "deg"};
  for (std::size_t i = 0; i < 3; ++i) {
    rates.lines.push_back({.run = i, .name = axes[i], .x = plain.t_s, .y = plain.rate_deg_s[i]});
    angles.lines.push_back({.run = i, .name = axes[i], .x = plain.t_s, .y = plain.angle_deg[i]});
  }
  std::vector<Panel> panels = {std::move(rates), std::move(angles)};
  if (!o.errors.empty()) {
    Panel attitude{.title = "Attitude error", .unit = "deg"},
        position{.title = "Position error (as figure 7)", .unit = "m"};
    for (const char* name : {"roll", "pitch", "yaw"})
      attitude.lines.push_back({.run = attitude.lines.size(), .name = name});
    for (const char* name : {"east", "north", "up"})
      position.lines.push_back({.run = position.lines.size(), .name = name});
    for (std::size_t k = 0; k < o.errors.size(); ++k) {
      if (k % kSamplesPerLook == 0) throw_if_cancelled();
      const fusion::NavError& e = o.errors[k];
      for (int i = 0; i < 3; ++i) {
        const auto u = static_cast<std::size_t>(i);
        for (Panel* panel : {&attitude, &position}) panel->lines[u].x.push_back(o.since_start_s(e.t));
        attitude.lines[u].y.push_back(e.attitude_rad[i] / kDegree);
        position.lines[u].y.push_back(k < o.held.count ? e.position_enu_m[i] : kNaN);
      }
    }
    panels.push_back(std::move(attitude));
    panels.push_back(std::move(position));
  }
  return report::picture_svg(report::time_picture(
      "Dead reckoning of " + std::filesystem::path(o.recording.path).filename().string() + ", " + o.integrator,
      std::move(panels)));
}

}  // namespace canyon::apps
