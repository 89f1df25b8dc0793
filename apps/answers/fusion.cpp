#include "canyon/apps/answers/fusion.h"

#include <cmath>
#include <cstdio>

#include "canyon/core/process/progress.h"
#include "canyon/core/units.h"
#include "canyon/report/draw/picture.h"
#include "canyon/study/dead_reckoning/reference.h"

namespace canyon::apps {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

void row(const char* what, const Eigen::Vector3d& v, const char* unit, const Eigen::Vector3d& ratio) {
  std::printf("  %-32s %12.6g %12.6g %12.6g %-4s %10.2f %8.2f %8.2f\n", what, v.x(), v.y(), v.z(), unit, ratio.x(),
              ratio.y(), ratio.z());
}

void print_score(const study::FuseScore& s) {
  std::printf("  scored from %s at %zu instants\n", study::of_week(s.first, s.last).c_str(), s.instants);
  std::printf("  %-76s %s\n", "", "(error/sigma)^2");
  row("position RMS, east north up", s.position_rms_m, "m", s.position_ratio);
  if (s.velocity_rms_m_s.allFinite()) row("velocity RMS, east north up", s.velocity_rms_m_s, "m/s", s.velocity_ratio);
  if (s.attitude_rms_rad.allFinite())
    row("attitude RMS, roll pitch yaw", s.attitude_rms_rad / kDegree, "deg", s.attitude_ratio);
  std::printf("  3-D RMS %.6g m, at the end %.6g m; NEES %.2f per state\n", s.rms_3d_m, s.final_error_m, s.nees_mean);
}

void print_outages(const std::vector<study::OutageWindow>& windows) {
  if (windows.empty()) return;
  const study::OutageScore o = study::outage_score(windows);
  std::printf("  %zu outages, RMS of the largest errors: horizontal %.4g m, vertical %.4g m\n", o.count,
              o.horizontal_rms_of_max_m, o.vertical_rms_of_max_m);
}

}  // namespace

void print_fused(const study::FuseInputs& in, const study::Fused& run, const study::FuseSmoothed* smoothed) {
  std::printf("%s: %zu samples, %zu of %zu fixes accepted, %.3f s from %.3f s of the week; start: %s\n",
              in.imu.path.c_str(), run.samples, run.fixes_accepted, run.fixes_given, run.end - run.start,
              run.start.sow_s(), run.start_from.c_str());
  std::printf("  states %s; measurements %s\n", joined(run.states).c_str(), joined(run.measurements).c_str());
  for (const auto& [name, score] : run.by_measurement)
    std::printf("  %-14s %7zu innovations, %7zu accepted, NIS %.2f per dimension\n", name.c_str(), score.count,
                score.accepted, score.nis_mean());
  if (run.gaps_bridged > 0 || run.restarts > 0)
    std::printf("  %zu gaps bridged for %.3f s, %zu new starts\n", run.gaps_bridged, run.bridged_s, run.restarts);
  if (const std::string wrong = run.incidents.text(); !wrong.empty()) std::printf("  mended: %s\n", wrong.c_str());
  const study::FuseScore s = study::fuse_score(run.errors);
  if (s.instants > 0) print_score(s);
  print_outages(run.windows);
  if (smoothed != nullptr) {
    std::printf("  smoothed by %s: %zu states\n", smoothed->smoother.c_str(), smoothed->epochs.size());
    const study::FuseScore of_it = study::fuse_score(smoothed->errors);
    if (of_it.instants > 0) print_score(of_it);
    print_outages(smoothed->windows);
  }
  for (const std::string& line : fusion::verdict_lines(run.verdict)) std::printf("  verdict: %s\n", line.c_str());
}

std::string fused_svg(const study::Fused& run) {
  using report::Panel;
  struct Part {
    const char *title, *unit;
    const char* names[3];
    const Eigen::Vector3d study::FuseError::*error;
    double scale;
  };
  const Part parts[] = {
      {"Position error", "m", {"east", "north", "up"}, &study::FuseError::position_enu_m, 1.0},
      {"Velocity error", "m/s", {"east", "north", "up"}, &study::FuseError::velocity_enu_m_s, 1.0},
      {"Attitude error", "deg", {"roll", "pitch", "yaw"}, &study::FuseError::attitude_rad, 1.0 / kDegree}};
  std::vector<Panel> panels;
  for (const Part& part : parts) {
    Panel panel{.title = part.title, .unit = part.unit};
    for (std::size_t i = 0; i < 3; ++i) panel.lines.push_back({.run = i, .name = part.names[i]});
    for (const study::FuseError& e : run.errors) {
      throw_if_cancelled();
      for (std::size_t i = 0; i < 3; ++i) {
        panel.lines[i].x.push_back(e.t - run.start);
        panel.lines[i].y.push_back((e.*part.error)[static_cast<Eigen::Index>(i)] * part.scale);
      }
    }
    if (std::isfinite((run.errors.front().*part.error).x())) panels.push_back(std::move(panel));
  }
  return report::picture_svg(report::time_picture("Errors of the estimate", std::move(panels)));
}

}  // namespace canyon::apps
