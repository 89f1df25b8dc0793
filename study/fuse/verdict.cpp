#include "canyon/study/fuse/verdict.h"

#include "canyon/core/output/printed.h"

namespace canyon::study {
namespace {

/// Errors twice as large, or half as large, as they are said to be.
constexpr double kOverconfident = 4.0, kUnderconfident = 0.25;

void judge(const char* what, const Eigen::Vector3d& ratio, const char* const axes[3], std::vector<std::string>& out) {
  for (int i = 0; i < 3; ++i) {
    if (ratio[i] > kOverconfident)
      out.push_back(printed("%s %s: errors %.1f times what the filter believes", axes[i], what, std::sqrt(ratio[i])));
    if (ratio[i] < kUnderconfident)
      out.push_back(
          printed("%s %s: errors %.1f times less than the filter believes", axes[i], what, 1.0 / std::sqrt(ratio[i])));
  }
}

}  // namespace

std::vector<std::string> fuse_verdict(const Fused& run, const FuseScore& score) {
  constexpr const char* kEnu[3] = {"east", "north", "up"};
  constexpr const char* kBody[3] = {"roll", "pitch", "yaw"};
  std::vector<std::string> out;
  judge("position", score.position_ratio, kEnu, out);
  judge("velocity", score.velocity_ratio, kEnu, out);
  judge("attitude", score.attitude_ratio, kBody, out);
  for (const auto& [name, measurement] : run.by_measurement) {
    const double nis = measurement.nis_mean();
    if (nis > kOverconfident)
      out.push_back(printed("%s: innovations %.1f times what is expected", name.c_str(), std::sqrt(nis)));
    if (2 * measurement.accepted < measurement.count)
      out.push_back(printed("%s: %zu of %zu rejected", name.c_str(), measurement.count - measurement.accepted,
                            measurement.count));
  }
  return out;
}

}  // namespace canyon::study
