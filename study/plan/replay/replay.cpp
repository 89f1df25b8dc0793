#include "canyon/study/plan/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/random/random.h"
#include "canyon/gnss/paths/need/path_question.h"

namespace canyon::study {

namespace {

std::size_t place_of(const mission::Omissions& omissions, double t_s, const Pose& X_WB) {
  const auto& corridor = omissions.corridor;
  if (t_s > omissions.corridor_until_s) return corridor.size();
  std::size_t i = 0;
  while (i < corridor.size() && !corridor[i].segment.contains(X_WB)) ++i;
  return i;
}

/// 0 for the same bits, NaN among them; infinite where only one is a number.
double apart(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
  const double d = std::abs(a - b);
  return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

}  // namespace

GnssReplay::GnssReplay(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
                       const mission::Omissions& omissions, std::int64_t count)
    : config_(config), mission_(mission), scene_(*mission.scene) {
  const RandomStream stream(static_cast<std::uint64_t>(config.run.seed), "plan.replay");
  const scene::Scene& scene = *mission.scene;
  const auto& corridor = omissions.corridor;
  const double last = static_cast<double>(tape.nodes.size() - 1);
  for (std::int64_t k = 0; k < count; ++k) {
    const double share = count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 0.0;
    const KinematicState& truth = tape.nodes[static_cast<std::size_t>(std::llround(share * last))].motion;
    const double t_s = truth.t - tape.nodes.front().motion.t;
    Pose X_WB = truth.X_WB;
    const std::size_t on = place_of(omissions, t_s, X_WB);
    if (on < corridor.size()) {
      const double half_m = corridor[on].segment.half_width_m;
      const double side_m = stream.uniform(-half_m, half_m, 0, static_cast<std::uint64_t>(k));
      Pose moved{X_WB.R, X_WB * Eigen::Vector3d(0.0, side_m, 0.0)};
      const auto here = scene.ground(X_WB.p.x(), X_WB.p.y()), there = scene.ground(moved.p.x(), moved.p.y());
      if (here && there) moved.p.z() = X_WB.p.z() + there->height_m - here->height_m;
      if (here && there && place_of(omissions, t_s, moved) < corridor.size()) X_WB = moved;
    }
    epochs_.push_back(
        {k, mission.start + t_s, place_of(omissions, t_s, X_WB), X_WB * config.gnss.lever_arm_m, truth.v_WB_W});
  }
}

Result<std::unique_ptr<gnss::GnssSensor>> GnssReplay::sensor() const {
  return gnss::make_gnss_sensor(config_.gnss, static_cast<std::uint64_t>(config_.run.seed), mission_.start,
                                epochs_.empty() ? mission_.start : epochs_.back().t, *mission_.scene);
}

gnss::GnssOutput GnssReplay::measure(gnss::GnssSensor& sensor, const Epoch& epoch,
                                     const gnss::PathOmissions& leave_out) {
  if (!mission_.traffic.empty()) scene_.set_instances(mission_.traffic.at(epoch.t - mission_.start));
  sensor.leave_out(leave_out);
  return sensor.measure(epoch.index, epoch.t, epoch.p_A_W, epoch.v_A_W, scene_);
}

gnss::PathOmissions only(const char* effect, const gnss::PathOmissions& all, const gnss::PathOmissions& others) {
  const std::string asked = effect;
  gnss::PathOmissions out = others;
  if (asked == gnss::kOcclusion) out.occlusion = all.occlusion;
  if (asked == gnss::kFoliage) out.foliage = all.foliage;
  if (asked == gnss::kDiffraction) out.diffraction = all.diffraction;
  // Ways over k walls alone cannot be left out while those over more are searched.
  for (int k = 1; k <= 3; ++k)
    if (asked == gnss::kReflections[k - 1]) out.most_reflections = std::max(all.most_reflections, k - 1);
  return out;
}

double difference_m(const gnss::GnssOutput& a, const gnss::GnssOutput& b) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const auto &of_a = a.epoch.observations, &of_b = b.epoch.observations;
  if (a.fix.status != b.fix.status || of_a.size() != of_b.size()) return kInfinite;
  double most = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    most = std::max(most, apart(a.fix.p_A_E[axis], b.fix.p_A_E[axis]));
    most = std::max(most, apart(a.fix.v_A_E[axis], b.fix.v_A_E[axis]));
    for (int column = 0; column < 3; ++column)
      most = std::max(most, apart(a.fix.covariance_E(axis, column), b.fix.covariance_E(axis, column)));
  }
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    if (of_a[i].sv != of_b[i].sv || of_a[i].used != of_b[i].used || of_a[i].slipped != of_b[i].slipped)
      return kInfinite;
    most = std::max({most, apart(of_a[i].pseudorange_m, of_b[i].pseudorange_m),
                     apart(of_a[i].cn0_dbhz, of_b[i].cn0_dbhz), apart(of_a[i].doppler_hz, of_b[i].doppler_hz),
                     apart(of_a[i].carrier_phase_cycles, of_b[i].carrier_phase_cycles),
                     apart(of_a[i].second.pseudorange_m, of_b[i].second.pseudorange_m)});
  }
  return most;
}

}  // namespace canyon::study
