#include "canyon/study/plan/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
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

template <class Values>
double apart_in(const Values& a, const Values& b) {
  double most = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) most = std::max(most, apart(a.data()[i], b.data()[i]));
  return most;
}

double apart(const GnssFix& a, const GnssFix& b) {
  return std::max({apart_in(a.p_A_E, b.p_A_E), apart_in(a.covariance_E, b.covariance_E), apart_in(a.v_A_E, b.v_A_E),
                   apart_in(a.velocity_covariance_E, b.velocity_covariance_E), apart(a.clock_m, b.clock_m),
                   apart(a.dop.gdop, b.dop.gdop), apart(a.dop.pdop, b.dop.pdop), apart(a.dop.hdop, b.dop.hdop),
                   apart(a.dop.vdop, b.dop.vdop), apart(a.dop.tdop, b.dop.tdop)});
}

/// Of the same names in either: a first and a second signal.
template <class Signal>
double signals_apart(const Signal& a, const Signal& b) {
  return std::max({apart(a.pseudorange_m, b.pseudorange_m), apart(a.doppler_hz, b.doppler_hz),
                   apart(a.carrier_phase_cycles, b.carrier_phase_cycles), apart(a.cn0_dbhz, b.cn0_dbhz)});
}

double apart(const GnssObservation& a, const GnssObservation& b) {
  return std::max({signals_apart(a, b), signals_apart(a.second, b.second), apart(a.sigma_m, b.sigma_m),
                   apart_in(a.p_E, b.p_E), apart_in(a.v_E, b.v_E), apart(a.clock_m, b.clock_m),
                   apart(a.correction_m, b.correction_m)});
}

/// What is no number.
bool of_one_kind(const GnssFix& a, const GnssFix& b) {
  return a.t == b.t && a.status == b.status && a.satellites == b.satellites && a.reason == b.reason;
}
bool of_one_kind(const GnssObservation& a, const GnssObservation& b) {
  return a.sv == b.sv && a.band == b.band && a.used == b.used && a.slipped == b.slipped &&
         a.second.band == b.second.band && a.second.slipped == b.second.slipped;
}

}  // namespace

GnssReplay::GnssReplay(const mission::MissionConfig& config, const mission::PreparedMission& mission, const Tape& tape,
                       const mission::Omissions& omissions, std::int64_t count)
    : config_(config), mission_(mission), scene_(*mission.scene) {
  const RandomStream stream(static_cast<std::uint64_t>(config.run.seed), "plan.replay");
  const scene::Scene& scene = *mission.scene;
  const auto& corridor = omissions.corridor;
  const double until_s =
      corridor.empty() ? tape.duration_s() : std::min(omissions.corridor_until_s, mission.time_limit_s);
  for (std::int64_t k = 0; k < count; ++k) {
    const auto draw = static_cast<std::uint64_t>(k);
    // A plan holds anywhere on its route at any time of its span, whichever way the body heads: nothing of this is as
    // the tape had it.
    const double t_s =
        until_s * (static_cast<double>(k) + stream.uniform(0.0, 1.0, 1, draw)) / static_cast<double>(count);
    const double last = static_cast<double>(tape.nodes.size() - 1);
    const KinematicState& truth = tape.nodes[static_cast<std::size_t>(last * stream.uniform(0.0, 1.0, 2, draw))].motion;
    Pose X_WB = truth.X_WB;
    const std::size_t on = place_of(omissions, t_s, X_WB);
    if (on < corridor.size()) {
      const double half_m = corridor[on].segment.half_width_m;
      const double side_m = stream.uniform(-half_m, half_m, 0, draw);
      Pose moved{X_WB.R, X_WB * Eigen::Vector3d(0.0, side_m, 0.0)};
      const auto here = scene.ground(X_WB.p.x(), X_WB.p.y()), there = scene.ground(moved.p.x(), moved.p.y());
      if (here && there) moved.p.z() = X_WB.p.z() + there->height_m - here->height_m;
      if (here && there && place_of(omissions, t_s, moved) < corridor.size()) X_WB = moved;
    }
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(stream.uniform(-kPi, kPi, 3, draw), Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d v_WB_W = X_WB.R * (turn * (X_WB.R.conjugate() * truth.v_WB_W));
    X_WB.R = (X_WB.R * turn).normalized();
    epochs_.push_back({k, mission.start + t_s, place_of(omissions, t_s, X_WB), X_WB * config.gnss.lever_arm_m, v_WB_W});
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
  if (a.epoch.t != b.epoch.t || !of_one_kind(a.fix, b.fix) || of_a.size() != of_b.size()) return kInfinite;
  double most = apart(a.fix, b.fix);
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    if (!of_one_kind(of_a[i], of_b[i])) return kInfinite;
    most = std::max(most, apart(of_a[i], of_b[i]));
  }
  return most;
}

bool same(const GnssFix& a, const GnssFix& b) {
  return of_one_kind(a, b) && apart(a, b) == 0.0;
}

}  // namespace canyon::study
