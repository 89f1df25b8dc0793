#include "canyon/inertial/simulation/simulated_log.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <span>

#include "canyon/core/check.h"
#include "canyon/core/files/files.h"
#include "canyon/core/process/parallel.h"

namespace canyon::inertial {
namespace {

constexpr std::size_t kChunk = 256;            // samples
constexpr std::size_t kSamplesPerLook = 4096;  // at whether the user wants to stop

IncrementAccuracy worse(const IncrementAccuracy& a, const IncrementAccuracy& b) {
  return {std::max(a.dtheta_rad, b.dtheta_rad), std::max(a.dv_m_s, b.dv_m_s)};
}

/// Shortest text that reads back to the same bits.
void append_number(std::string& out, double value) {
  char buffer[32];
  const auto [end, status] = std::to_chars(buffer, buffer + sizeof buffer, value);
  out.append(buffer, end);
}

/// Seconds of the start's week, which go on past its end.
void append_time(std::string& out, const SimulatedLog& s, GpsTime t) {
  const std::int64_t ns = t.ns - GpsTime::from_week_sow(s.motion.start.week(), 0.0).ns;
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%lld.%09lld", static_cast<long long>(ns / kNsPerSecond),
                static_cast<long long>(ns % kNsPerSecond));
  out += buffer;
}

void append_six(std::string& out, const Eigen::Vector3d& a, const Eigen::Vector3d& b, char separator) {
  for (const Eigen::Vector3d* v : {&a, &b})
    for (int i = 0; i < 3; ++i) {
      out += separator;
      append_number(out, (*v)[i]);
    }
  out += '\n';
}

constexpr const char* kRatesHeader = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";

}  // namespace

std::size_t whole_samples(double duration_s, double rate_hz) {
  return static_cast<std::size_t>(std::floor(duration_s * rate_hz * (1.0 + 1e-12)));
}

SimulatedLog simulate_log(const PlacedMotion& motion, double rate_hz, std::size_t samples, ErrorChain& chain,
                          Progress& progress) {
  CANYON_CHECK(samples > 0 && rate_hz > 0.0, "samples = ", samples, ", rate_hz = ", rate_hz);
  SimulatedLog s;
  s.motion = motion;
  s.rate_hz = rate_hz;
  s.truth.resize(samples);
  std::vector<IncrementAccuracy> worst((samples - 1) / kChunk + 1);
  parallel_for(samples, kChunk, [&](std::size_t begin, std::size_t end) {
    IncrementAccuracy& of_chunk = worst[begin / kChunk];
    for (std::size_t k = begin; k < end; ++k) {
      throw_if_cancelled();
      IncrementAccuracy reached;
      s.truth[k] = motion_increments(s.motion, static_cast<double>(k) / s.rate_hz,
                                     static_cast<double>(k + 1) / s.rate_hz, &reached);
      of_chunk = worse(of_chunk, reached);
    }
    progress.advance(static_cast<double>(end - begin));
  });
  for (const IncrementAccuracy& of_chunk : worst) s.accuracy = worse(s.accuracy, of_chunk);
  s.measured = s.truth;
  for (std::size_t k = 0; k < samples; k += kSamplesPerLook) {
    throw_if_cancelled();
    chain.corrupt_batch(static_cast<std::int64_t>(k),
                        std::span(s.measured).subspan(k, std::min(kSamplesPerLook, samples - k)));
  }
  return s;
}

LogExtremes extremes(const SimulatedLog& s) {
  LogExtremes out;
  for (std::size_t k = 0; k < s.truth.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    out.speed_m_s = std::max(out.speed_m_s, s.motion.motion->at(static_cast<double>(k) / s.rate_hz).v_WB_W.norm());
    out.rate_rad_s = std::max(out.rate_rad_s, s.truth[k].dtheta_U.norm() / s.truth[k].dt_s);
    out.force_m_s2 = std::max(out.force_m_s2, s.truth[k].dv_U.norm() / s.truth[k].dt_s);
    out.lost += s.measured[k].lost ? 1 : 0;
  }
  return out;
}

std::string rates_csv(const SimulatedLog& s) {
  std::string out = kRatesHeader;
  for (std::size_t k = 0; k < s.truth.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const ImuSample& m = s.measured[k];
    append_time(out, s, m.t);
    append_six(out, m.dtheta_U / s.truth[k].dt_s, m.dv_U / s.truth[k].dt_s, ',');
  }
  return out;
}

std::string kf_gins_text(const SimulatedLog& s) {
  const Eigen::Vector3d frd(1.0, -1.0, -1.0);
  std::string out;
  for (std::size_t k = 0; k < s.measured.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const ImuSample& m = s.measured[k];
    append_time(out, s, m.t);
    append_six(out, frd.cwiseProduct(m.dtheta_U), frd.cwiseProduct(m.dv_U), ' ');
  }
  return out;
}

std::string errors_csv(const SimulatedLog& s) {
  std::string out = kRatesHeader;
  for (std::size_t k = 0; k < s.truth.size(); ++k) {
    if (k % kSamplesPerLook == 0) throw_if_cancelled();
    const ImuSample &m = s.measured[k], &t = s.truth[k];
    append_time(out, s, t.t);
    append_six(out, (m.dtheta_U - t.dtheta_U) / t.dt_s, (m.dv_U - t.dv_U) / t.dt_s, ',');
  }
  return out;
}

NavigationFile truth_file(const SimulatedLog& s) {
  NavigationFile file;
  file.gravity = "wgs84";
  file.records.resize(s.truth.size() + 1);
  parallel_for(file.records.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    throw_if_cancelled();
    for (std::size_t k = begin; k < end; ++k) {
      const KinematicState imu = s.motion.imu_at(static_cast<double>(k) / s.rate_hz);
      file.records[k] = {k == 0 ? s.motion.start : s.truth[k - 1].t, s.motion.frame.X_EW() * imu.X_WB,
                         s.motion.frame.R_EW() * imu.v_WB_W};
    }
  });
  return file;
}

Status write_simulated_log(const std::string& folder, const SimulatedLog& s) {
  CANYON_TRY_STATUS(write_text_file(folder + "/imu.csv", rates_csv(s)));
  CANYON_TRY_STATUS(write_text_file(folder + "/imu_kf_gins.txt", kf_gins_text(s)));
  CANYON_TRY_STATUS(write_text_file(folder + "/errors.csv", errors_csv(s)));
  return write_navigation_file(folder + "/truth.nav", truth_file(s));
}

}  // namespace canyon::inertial
