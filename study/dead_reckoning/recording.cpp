#include "canyon/study/dead_reckoning/recording.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include "canyon/core/earth/gravity.h"
#include "canyon/core/files/files.h"
#include "canyon/core/process/progress.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/imu_log.h"

namespace canyon::study {
namespace {

constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop

/// Whether the file begins with a number: then it has no header, and is taken for the KF-GINS text format.
Result<bool> is_bare(const std::string& path) {
  std::string text(256, '\0');
  std::ifstream in(path, std::ios::binary);
  text.resize(static_cast<std::size_t>(in.read(text.data(), 256).gcount()));
  if (!in.is_open() || text.starts_with("\x1f\x8b")) {
    CANYON_TRY(text, read_text_or_gzip_file(path));
  }
  const std::size_t at = text.find_first_not_of(" \t\r\n");
  return at != std::string::npos && std::string_view("0123456789.-+").find(text[at]) != std::string_view::npos;
}

Status check_stamps(const std::string& path, const inertial::ImuLog& log, int week) {
  const double most_s = 9.2e9 - kSecondsPerWeek * (week + 1);
  if (std::max(std::abs(log.t_s.front()), std::abs(log.t_s.back())) < most_s) return Ok{};
  char text[80];
  std::snprintf(text, sizeof text, "stamps from %.6g to %.6g s", log.t_s.front(), log.t_s.back());
  return Error{path, 0, "", text, "seconds of the truth's GPS week"};
}

Result<inertial::ImuLog> read_log(const std::string& path, inertial::ImuLogFormat format,
                                  const std::function<void(const std::string&)>& warn) {
  auto log = inertial::read_imu_log(path, format);
  if (!log) {
    // What only a dead or saturated channel speaks against can still be integrated.
    const Error refused = log.error();
    format.live = false;
    log = inertial::read_imu_log(path, format);
    if (!log) return log.error();
    warn(refused.str());
  }
  for (const std::string& doubt : log->doubts) warn(doubt);
  return log;
}

}  // namespace

Result<ImuRecording> read_imu_recording(const std::string& path, const ImuRecordingFormat& format,
                                        const std::function<void(const std::string&)>& warn) {
  CANYON_TRY(const bool bare, is_bare(path));
  ImuRecording out;
  out.path = path;
  out.kf_gins = format.columns == "kf_gins" || (format.columns.empty() && bare);
  CANYON_TRY(const inertial::ImuLog log,
             read_log(path, {.columns = out.kf_gins ? "kf_gins" : format.columns, .mend = format.mend}, warn));
  out.passed_over = log.passed_over;
  CANYON_TRY_STATUS(check_stamps(path, log, format.gps_week));
  for (int c = 0; c < 6; ++c)
    if (log.channels[static_cast<std::size_t>(c)].empty())
      return Error{path, 0, "", std::string("no column for ") + inertial::kChannelNames[c], "all six channels"};
  const Eigen::Vector3d sign =
      format.forward_right_down && !out.kf_gins ? Eigen::Vector3d(1, -1, -1) : Eigen::Vector3d(1, 1, 1);
  const inertial::Sampling sampling = inertial::sampling_of(log.t_s, format.gap_factor);
  out.interval_s = sampling.interval_s;
  out.samples.reserve(log.size());
  for (const inertial::Segment& segment : sampling.segments) {
    if (segment.begin > 0) {
      out.after_gap.push_back(segment.begin);
      out.gaps.add(log.lines[segment.begin], log.t_s[segment.begin], log.t_s[segment.begin - 1]);
    }
    for (std::size_t k = segment.begin; k < segment.end; ++k) {
      if (k % kSamplesPerLook == 0) throw_if_cancelled();
      const auto& c = log.channels;
      ImuSample s;
      s.t = GpsTime::from_week_sow(format.gps_week, 0.0) + log.t_s[k];
      s.dt_s = k > segment.begin ? log.t_s[k] - log.t_s[k - 1] : sampling.interval_s;
      const double rate_s = log.increments[0] ? sampling.interval_s : s.dt_s;
      const double force_s = log.increments[1] ? sampling.interval_s : s.dt_s;
      // Of rates at the stamps the mean is that of both ends.
      const std::size_t before = k > segment.begin ? k - 1 : k;
      const auto mean = [&](std::size_t i) {
        return format.instantaneous && !log.increments[i / 3] ? 0.5 * (c[i][before] + c[i][k]) : c[i][k];
      };
      s.dtheta_U = rate_s * sign.cwiseProduct(Eigen::Vector3d(mean(0), mean(1), mean(2)));
      s.dv_U = force_s * sign.cwiseProduct(Eigen::Vector3d(mean(3), mean(4), mean(5)));
      out.samples.push_back(s);
    }
  }
  return out;
}

Status check_axes(const ImuRecording& recording, const fusion::NavState& initial, const std::string& advice) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), turned = force;
  for (const ImuSample& s : recording.samples) {
    if (s.t <= initial.t) continue;
    if (s.t - initial.t >= 1.0 || turned.norm() > 0.5) break;
    force += s.dv_U;
    turned += s.dtheta_U;
  }
  if ((initial.R_EU * force).dot(gravity_E(initial.p_EU_E)) <= 0.0) return Ok{};
  return Error{recording.path, 0, "", "in the initial attitude the specific force points down", advice};
}

}  // namespace canyon::study
