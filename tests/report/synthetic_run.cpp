#include "canyon/tests/report/synthetic_run.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::testing {
namespace {

constexpr double kNavRate_hz = 10;
constexpr std::uint64_t kSeed = 42;

struct SkyPlace {
  int prn;
  double elevation_deg, azimuth_deg;
};
/// A sky such as GPS gives at mid latitudes.
constexpr SkyPlace kSky[] = {{2, 71, 310}, {4, 48, 62},   {5, 33, 205}, {7, 12, 318}, {9, 58, 140}, {10, 24, 262},
                             {12, 17, 38}, {17, 41, 288}, {20, 9, 176}, {24, 65, 20}, {28, 28, 112}};

}  // namespace

SyntheticRun::SyntheticRun(const SyntheticCity& city, const SyntheticOptions& options, std::string fidelity,
                           std::string gnss, std::string imu)
    : city_(city), options_(options), fidelity_(std::move(fidelity)), gnss_(std::move(gnss)), imu_(std::move(imu)) {
  fails_ = gnss_ != "low";
  drive();
  receive();
  estimate();
  register_keyframes();
  if (options_.clouds) map();
}

void SyntheticRun::drive() {
  const double length_m = city_.route_length_m();
  const double end_m = length_m * (!fails_ ? 1.0 : gnss_ == "paper" ? 0.84 : imu_ == "low" ? 0.63 : 0.62);
  double along_m = 0, stopped_s = 0;
  std::size_t next = 0;
  for (int k = 0; along_m < end_m || stopped_s > 0; ++k) {
    const bool stopped = stopped_s > 0;
    epochs_.push_back({k / kNavRate_hz, along_m, stopped ? 0.0 : options_.speed_m_s, city_.at(along_m),
                       Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), static_cast<int>(next) + 1, stopped});
    if (stopped) {
      stopped_s -= 1 / kNavRate_hz;
      continue;
    }
    along_m = std::min(along_m + options_.speed_m_s / kNavRate_hz, length_m);
    if (next < city_.waypoints.size() && along_m >= city_.waypoints[next].at_m - 1e-9) {
      if (city_.waypoints[next].mission) stopped_s = kStop_s;
      if (next + 1 < city_.waypoints.size()) ++next;
    }
  }
}

const SyntheticRun::Epoch& SyntheticRun::epoch_at(double t_s) const {
  return epochs_[std::min(static_cast<std::size_t>(std::lround(t_s * kNavRate_hz)), epochs_.size() - 1)];
}

SyntheticRun::Fix SyntheticRun::receive_at(std::size_t k, const Epoch& epoch) const {
  const RandomStream random(kSeed, gnss_ == "paper" ? "synthetic.gnss.paper" : "synthetic.gnss");
  Fix fix{.t_s = epoch.t_s,
          .p = epoch.p,
          .solved = true,
          .gdop = NAN,
          .pdop = NAN,
          .hdop = NAN,
          .vdop = NAN,
          .multipath_max_m = NAN,
          .error = Eigen::Vector3d::Zero(),
          .sigma = Eigen::Vector3d::Constant(0.23),
          .satellites = {},
          .used = 0,
          .tracked = 0,
          .blocked = 0,
          .reflected = 0};
  if (gnss_ == "low") {
    fix.error = random.direction(99, k) * random.uniform(0.3, 0.5, 99, k, 2);
    return fix;
  }
  const double yaw_deg = city_.yaw_rad(epoch.along_m) / kDegree;
  const double canyon_m = city_.canyon_m(epoch.p);
  std::vector<Eigen::Vector4d> rows;
  std::vector<double> errors;
  for (const SkyPlace& place : kSky) {
    const auto prn = static_cast<std::uint32_t>(place.prn);
    Satellite s{
        place.prn, place.elevation_deg + 0.004 * epoch.t_s, place.azimuth_deg + 0.005 * epoch.t_s, 0, 45, true, true,
        0};
    // Across the street the houses stand about 12 m away, along it the view is free to 15 degrees.
    const double across = std::abs(std::sin((90 - s.azimuth_deg - yaw_deg) * kDegree));
    const double mask_deg = std::max(8.0, std::atan2(across * canyon_m * 0.55, 12) / kDegree);
    s.line_of_sight = s.elevation_deg > mask_deg;
    // Reflections last for some metres of the way, so they depend on where the vehicle is.
    const auto place_index = static_cast<std::uint64_t>(epoch.along_m / 12);
    if (!s.line_of_sight) {
      s.tracked = random.uniform(prn, place_index, 0) < 0.35;
      s.reflections = s.tracked ? 1 : 0;
      s.multipath_m = s.tracked ? random.uniform(2, 40, prn, place_index, 1) : 0;
      s.cn0_dbhz = 31;
    } else if (random.uniform(prn, place_index, 2) < 0.25) {
      s.reflections = 1;
      s.multipath_m = random.normal(prn, place_index, 3) * 0.9;
    }
    fix.satellites.push_back(s);
    if (!s.tracked) continue;
    ++fix.tracked;
    fix.blocked += s.line_of_sight ? 0 : 1;
    fix.reflected += s.reflections > 0 ? 1 : 0;
    fix.multipath_max_m = std::fmax(fix.multipath_max_m, std::abs(s.multipath_m));
    if (std::abs(s.multipath_m) > 25) continue;  // the receiver finds the worst
    const double e = s.elevation_deg * kDegree, a = s.azimuth_deg * kDegree;
    rows.emplace_back(std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e), 1);
    errors.push_back(0.35 * s.multipath_m + 0.4 * random.normal(prn, k, 4));
  }
  fix.used = static_cast<int>(rows.size());
  fix.solved = fix.used >= 4;
  if (!fix.solved) return fix;
  Eigen::MatrixXd H(rows.size(), 4);
  Eigen::VectorXd b(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    H.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
    b[static_cast<Eigen::Index>(i)] = -errors[i];
  }
  const Eigen::Matrix4d Q = (H.transpose() * H).inverse();
  fix.gdop = std::sqrt(Q.trace());
  fix.pdop = std::sqrt(Q.topLeftCorner<3, 3>().trace());
  fix.hdop = std::sqrt(Q(0, 0) + Q(1, 1));
  fix.vdop = std::sqrt(Q(2, 2));
  if (!(fix.gdop < 60)) {
    fix.solved = false;
    fix.gdop = fix.pdop = fix.hdop = fix.vdop = NAN;
    return fix;
  }
  fix.error = (Q * H.transpose() * b).head<3>();
  fix.sigma = 0.5 * Q.diagonal().head<3>().cwiseSqrt();
  return fix;
}

void SyntheticRun::receive() {
  const double interval_s = 1 / options_.gnss_rate_hz;
  for (std::size_t k = 0; static_cast<double>(k) * interval_s <= epochs_.back().t_s; ++k) {
    fixes_.push_back(receive_at(k, epoch_at(static_cast<double>(k) * interval_s)));
  }
}

void SyntheticRun::estimate() {
  // A smoothed fix plus a slow wander of the inertial unit: not a filter, but it looks like one.
  const RandomStream random(kSeed, "synthetic.imu");
  const double wander_m = imu_ == "low" ? 0.01 : 0.03;
  Eigen::Vector3d error = Eigen::Vector3d::Zero(), wander = Eigen::Vector3d::Zero();
  double sigma_m = 0.1;
  std::size_t next = 0;
  for (std::size_t i = 0; i < epochs_.size(); ++i) {
    wander += (wander_m / std::sqrt(kNavRate_hz)) * random.normal3(i);
    sigma_m += wander_m / kNavRate_hz;
    if (next < fixes_.size() && fixes_[next].t_s <= epochs_[i].t_s + 1e-9) {
      if (fixes_[next].solved) {
        const double gain = 0.18;
        error += gain * (fixes_[next].error - error);
        wander *= 1 - gain;
        sigma_m += 0.3 * (0.3 * fixes_[next].sigma.mean() + 0.05 - sigma_m);
      }
      ++next;
    }
    epochs_[i].error = error + wander;
    epochs_[i].sigma = sigma_m * Eigen::Vector3d(1, 1, 1.6);
  }
}

void SyntheticRun::register_keyframes() {
  const RandomStream random(kSeed, "synthetic.registration");
  double last_m = -10;
  for (const Epoch& e : epochs_) {
    if (e.along_m - last_m < 2) continue;
    last_m = e.along_m;
    const std::uint64_t k = keyframes_.size();
    const bool converged = random.uniform(0, k) > 0.01 + 0.02 * e.error.norm();
    const Eigen::Vector3d drift = 0.25 * e.error + 0.03 * random.normal3(k, 1);
    keyframes_.push_back({e.t_s, e.p, e.error, converged ? drift : e.error, converged});
  }
}

void SyntheticRun::map() {
  const RandomStream random(kSeed, "synthetic.map");
  std::uint64_t n = 0;
  for (const Keyframe& keyframe : keyframes_) {
    std::vector<const SyntheticCity::House*> near;
    for (const SyntheticCity::House& h : city_.houses) {
      const Eigen::Vector2d nearest = keyframe.p.cwiseMax(h.min).cwiseMin(h.max);
      if ((nearest - keyframe.p).norm() < 50) near.push_back(&h);
    }
    for (int i = 0; i < options_.cloud_points_per_keyframe; ++i, ++n) {
      const bool ground = near.empty() || random.uniform(0, n) < 0.35;
      Eigen::Vector3d p, normal;
      if (ground) {
        const double r_m = random.uniform(2, 12, 1, n), a = random.uniform(0, 2 * kPi, 2, n);
        p = {keyframe.p.x() + r_m * std::cos(a), keyframe.p.y() + r_m * std::sin(a), 0};
        normal = Eigen::Vector3d::UnitZ();
      } else {
        const SyntheticCity::House& h = *near[std::min(
            static_cast<std::size_t>(random.uniform(3, n) * static_cast<double>(near.size())), near.size() - 1)];
        const bool x_wall = random.uniform(4, n) < 0.5;
        const double s = random.uniform(5, n);
        const Eigen::Vector2d size = h.max - h.min;
        p.z() = random.uniform(0, h.height_m, 6, n);
        if (x_wall) {
          p.x() = keyframe.p.x() < h.min.x() ? h.min.x() : h.max.x();
          p.y() = h.min.y() + s * size.y();
        } else {
          p.x() = h.min.x() + s * size.x();
          p.y() = keyframe.p.y() < h.min.y() ? h.min.y() : h.max.y();
        }
        normal = x_wall ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
      }
      for (const bool registered : {false, true}) {
        const Eigen::Vector3d shift = (registered ? keyframe.registered : keyframe.prior) + 0.02 * random.normal3(n, 9);
        const Eigen::Vector3f q = (p + shift).cast<float>();
        (registered ? registered_points_ : prior_points_)
            .push_back({q.x(), q.y(), q.z(), 0.5f, static_cast<float>(std::abs(shift.dot(normal)))});
      }
    }
  }
}

}  // namespace canyon::testing
