#include "canyon/tests/report/synthetic_run.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include <Eigen/Dense>

#include "canyon/core/files/pcd.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"

namespace canyon::testing {
namespace {

constexpr double kNavRate_hz = 10;
constexpr double kStop_s = 6;
constexpr std::uint64_t kSeed = 42;

struct SkyPlace {
  int prn;
  double elevation_deg, azimuth_deg;
};
/// A sky such as GPS gives at mid latitudes.
constexpr SkyPlace kSky[] = {{2, 71, 310}, {4, 48, 62},   {5, 33, 205}, {7, 12, 318}, {9, 58, 140}, {10, 24, 262},
                             {12, 17, 38}, {17, 41, 288}, {20, 9, 176}, {24, 65, 20}, {28, 28, 112}};

/// Writes a number, or nothing for NaN.
std::string field(double v, int precision = 6) {
  if (!std::isfinite(v)) return {};
  std::ostringstream out;
  out.precision(precision);
  out << v;
  return out.str();
}

double rms(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return v.empty() ? 0 : std::sqrt(sum / static_cast<double>(v.size()));
}

double quantile(std::vector<double> v, double share) {
  if (v.empty()) return 0;
  for (double& x : v) x = std::abs(x);
  std::sort(v.begin(), v.end());
  return v[static_cast<std::size_t>(share * static_cast<double>(v.size() - 1))];
}

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

nlohmann::ordered_json SyntheticRun::summary() const {
  using nlohmann::ordered_json;
  const auto or_null = [](double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(nullptr); };
  const char* kind = !fails_ ? "success" : gnss_ == "paper" ? "stuck" : "collision";
  ordered_json out{{"fidelity", fidelity_}, {"gnss", gnss_}, {"imu", imu_}, {"outcome", kind}};
  const Epoch& last = epochs_.back();
  out["failure"] = nullptr;
  if (fails_) {
    out["failure"] = {{"kind", kind},
                      {"t_s", last.t_s},
                      {"x_m", last.p.x()},
                      {"y_m", last.p.y()},
                      {"detail", gnss_ == "paper" ? "blocked for 20 s" : "front right corner touched building 217"}};
  }
  int reached = 0, mission_reached = 0;
  for (const auto& w : city_.waypoints) {
    if (last.along_m < w.at_m - 1e-6) continue;
    ++reached;
    mission_reached += w.mission ? 1 : 0;
  }
  out["waypoints_reached"] = reached;
  out["mission_waypoints_reached"] = mission_reached;
  out["waypoints_planned"] = city_.waypoints.size();
  out["mission_waypoints_planned"] = 3;
  out["duration_s"] = last.t_s;
  out["distance_m"] = last.along_m;

  std::vector<double> all;
  for (const Epoch& e : epochs_) all.push_back(e.error.norm());
  out["position_error_rms_m"] = rms(all);
  out["position_error_p95_m"] = quantile(all, 0.95);
  out["position_error_max_m"] = quantile(all, 1);
  const char* axes[] = {"e", "n", "up"};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> v;
    for (const Epoch& e : epochs_) v.push_back(e.error[axis]);
    const std::string key = std::string("position_error_") + axes[axis];
    out[key + "_rms_m"] = rms(v);
    out[key + "_p95_m"] = quantile(v, 0.95);
    out[key + "_max_m"] = quantile(v, 1);
  }
  const double attitude = imu_ == "low" ? 0.02 : 0.3;
  out["attitude_error_roll_rms_deg"] = 0.31 * attitude;
  out["attitude_error_pitch_rms_deg"] = 0.28 * attitude;
  out["attitude_error_yaw_rms_deg"] = attitude;

  std::vector<double> gdops, pdops, fix_errors;
  double jumps = 0, lost = 0, used = 0, tracked = 0, blocked = 0, reflected = 0;
  for (std::size_t i = 0; i < fixes_.size(); ++i) {
    const Fix& f = fixes_[i];
    if (i > 0 && has_satellites()) {
      const Fix& b = fixes_[i - 1];
      jumps += f.solved != b.solved || std::abs(f.gdop - b.gdop) > 2 ? 1 : 0;
    }
    lost += f.solved ? 0 : 1;
    used += f.used, tracked += f.tracked, blocked += f.blocked, reflected += f.reflected;
    if (!f.solved) continue;
    fix_errors.push_back(f.error.norm());
    gdops.push_back(f.gdop);
    pdops.push_back(f.pdop);
  }
  const bool sky = has_satellites();
  out["gdop_median"] = or_null(sky ? quantile(gdops, 0.5) : NAN);
  out["gdop_max"] = or_null(sky ? quantile(gdops, 1) : NAN);
  out["pdop_median"] = or_null(sky ? quantile(pdops, 0.5) : NAN);
  out["dop_jumps"] = or_null(sky ? jumps : NAN);
  out["satellites_mean"] = or_null(sky ? used / static_cast<double>(fixes_.size()) : NAN);
  out["nlos_share"] = or_null(sky ? blocked / tracked : NAN);
  out["multipath_share"] = or_null(sky ? reflected / tracked : NAN);
  out["fix_error_rms_m"] = rms(fix_errors);
  out["fixes_due"] = fixes_.size();
  out["fixes_lost"] = lost;

  std::vector<double> prior, registered;
  double converged = 0;
  for (const Keyframe& k : keyframes_) {
    prior.push_back(k.prior.norm());
    registered.push_back(k.registered.norm());
    converged += k.converged ? 1 : 0;
  }
  out["registration_error_rms_m"] = rms(registered);
  out["registration_error_prior_rms_m"] = rms(prior);
  out["keyframes"] = keyframes_.size();
  out["keyframes_registered"] = keyframes_.size() - 1;
  out["keyframes_converged"] = converged;
  for (const bool is_prior : {false, true}) {
    std::vector<double> errors;
    for (const Point& p : is_prior ? prior_points_ : registered_points_) errors.push_back(static_cast<double>(p.error));
    const std::string middle = is_prior ? "_prior" : "";
    out["map_error" + middle + "_rms_m"] = or_null(errors.empty() ? NAN : rms(errors));
    out["map_error_up" + middle + "_rms_m"] = or_null(errors.empty() ? NAN : 0.6 * rms(errors));
    out[std::string("map_error_p95") + (is_prior ? "_prior_m" : "_m")] =
        or_null(errors.empty() ? NAN : quantile(errors, 0.95));
  }
  out["map_points"] = registered_points_.size();
  out["mission_waypoints"] = ordered_json::array();
  for (std::size_t i = 0; i < city_.waypoints.size(); ++i) {
    const auto& w = city_.waypoints[i];
    if (!w.mission) continue;
    const bool there = last.along_m >= w.at_m - 1e-6;
    out["mission_waypoints"].push_back({{"name", std::to_string(i + 1)},
                                        {"reached", there},
                                        {"closest_m", there ? 0.31 : (city_.at(w.at_m) - last.p).norm()},
                                        {"stopped_s", there ? kStop_s : 0.0},
                                        {"facade_seen_share", there ? ordered_json(0.76) : ordered_json(nullptr)}});
  }
  out["counters"] = {{"lidar_rays", 1'152'000.0 * last.t_s / 10}, {"registrations", keyframes_.size()}};
  if (sky) {
    out["counters"]["gnss_rays"] = static_cast<double>(fixes_.size()) * 11;
    out["counters"]["facets_tested"] = static_cast<double>(fixes_.size()) * 4321;
    out["counters"]["reflected_paths"] = reflected;
  }
  const double s = last.t_s;
  out["timing"] = {{"real_time_factor", sky ? 11.3 : 17.9},
                   {"wall_s", s / (sky ? 11.3 : 17.9)},
                   {"cpu_s", 1.6 * s / (sky ? 11.3 : 17.9)},
                   {"cpu_per_simulated_s", 1.6 / (sky ? 11.3 : 17.9)}};
  out["timing"]["parts"] = {{{"name", "lidar"}, {"cpu_s", 0.061 * s}},
                            {{"name", "registration"}, {"cpu_s", 0.042 * s}},
                            {{"name", "gnss"}, {"cpu_s", (sky ? 0.033 : 0.0002) * s}},
                            {{"name", "autonomy"}, {"cpu_s", 0.012 * s}},
                            {{"name", "inertial"}, {"cpu_s", 0.002 * s}},
                            {{"name", "fusion"}, {"cpu_s", 0.006 * s}},
                            {{"name", "vehicle"}, {"cpu_s", 0.001 * s}}};
  return out;
}

std::string SyntheticRun::nav_csv() const {
  std::ostringstream out;
  out << "t_s,gps_week,sow,true_x_m,true_y_m,true_z_m,true_yaw_deg,true_pitch_deg,true_roll_deg,true_speed_m_s,est_x_m,"
         "est_y_m,est_z_m,"
         "est_yaw_deg,est_pitch_deg,est_roll_deg,est_speed_m_s,sigma_e_m,sigma_n_m,sigma_u_m,sigma_yaw_deg,error_e_m,"
         "error_n_m,error_u_m,"
         "error_roll_deg,error_pitch_deg,error_yaw_deg,command_speed_m_s,command_curvature_1_m,waypoint,state\n";
  for (const Epoch& e : epochs_) {
    const double yaw_deg = city_.yaw_rad(e.along_m) / kDegree;
    out << field(e.t_s) << ",1590," << field(392400 + e.t_s, 9) << "," << field(e.p.x()) << "," << field(e.p.y())
        << ",1.2," << field(yaw_deg) << ",0,0," << field(e.speed_m_s) << "," << field(e.p.x() + e.error.x()) << ","
        << field(e.p.y() + e.error.y()) << "," << field(1.2 + e.error.z()) << "," << field(yaw_deg + 0.1) << ",0,0,"
        << field(e.speed_m_s) << "," << field(e.sigma.x()) << "," << field(e.sigma.y()) << "," << field(e.sigma.z())
        << ",0.5," << field(e.error.x()) << "," << field(e.error.y()) << "," << field(e.error.z()) << ",0,0,0.1,"
        << field(options_.speed_m_s) << ",0," << e.waypoint << "," << (e.stopped ? "observing" : "driving") << "\n";
  }
  return out.str();
}

std::string SyntheticRun::gnss_csv() const {
  std::ostringstream out;
  out << "t_s,gps_week,sow,status,satellites,above_mask,tracked,nlos,reflected,gdop,pdop,hdop,vdop,fix_x_m,fix_y_m,fix_"
         "z_m,sigma_e_m,sigma_n_m,"
         "sigma_u_m,true_x_m,true_y_m,true_z_m,error_e_m,error_n_m,error_u_m,multipath_max_m,accepted,nis,reason\n";
  for (const Fix& f : fixes_) {
    const bool sky = has_satellites();
    const auto if_sky = [sky](double v) { return field(sky ? v : NAN); };
    const auto if_solved = [&f](double v) { return field(f.solved ? v : NAN); };
    out << field(f.t_s) << ",1590," << field(392400 + f.t_s, 9) << "," << (f.solved ? "differential" : "none") << ","
        << if_sky(f.used) << "," << if_sky(static_cast<double>(f.satellites.size())) << "," << if_sky(f.tracked) << ","
        << if_sky(f.blocked) << "," << if_sky(f.reflected) << "," << field(f.gdop) << "," << field(f.pdop) << ","
        << field(f.hdop) << "," << field(f.vdop) << "," << if_solved(f.p.x() + f.error.x()) << ","
        << if_solved(f.p.y() + f.error.y()) << "," << if_solved(2 + f.error.z()) << "," << if_solved(f.sigma.x()) << ","
        << if_solved(f.sigma.y()) << "," << if_solved(f.sigma.z()) << "," << field(f.p.x()) << "," << field(f.p.y())
        << ",2," << if_solved(f.error.x()) << "," << if_solved(f.error.y()) << "," << if_solved(f.error.z()) << ","
        << if_sky(f.multipath_max_m) << "," << (f.solved ? (f.error.norm() < 12 ? "1" : "0") : "") << ","
        << if_solved(f.error.squaredNorm()) << "," << (f.solved ? "" : "\"fewer than 4 satellites, or poor geometry\"")
        << "\n";
  }
  return out.str();
}

std::string SyntheticRun::satellites_csv() const {
  std::ostringstream out;
  out << "t_s,satellite,elevation_deg,azimuth_deg,line_of_sight,tracked,reflections,cn0_dbhz,multipath_m,ionosphere_m,"
         "troposphere_m,ephemeris_m,noise_m\n";
  for (const Fix& f : fixes_) {
    for (const Satellite& s : f.satellites) {
      out << field(f.t_s) << ",G" << (s.prn < 10 ? "0" : "") << s.prn << "," << field(s.elevation_deg) << ","
          << field(s.azimuth_deg) << "," << s.line_of_sight << "," << s.tracked << "," << s.reflections << ","
          << field(s.tracked ? s.cn0_dbhz : NAN) << "," << field(s.tracked ? s.multipath_m : NAN)
          << ",0.01,0.02,0.01,0.3\n";
    }
  }
  return out.str();
}

std::string SyntheticRun::keyframes_csv() const {
  std::ostringstream out;
  out << "t_s,points,true_x_m,true_y_m,true_z_m,prior_error_m,prior_error_up_m,registered_error_m,registered_error_up_"
         "m,status,iterations,rms_m\n";
  for (const Keyframe& k : keyframes_) {
    out << field(k.t_s) << ",14200," << field(k.p.x()) << "," << field(k.p.y()) << ",1.2," << field(k.prior.norm())
        << "," << field(k.prior.z()) << "," << field(k.registered.norm()) << "," << field(k.registered.z()) << ","
        << (k.converged ? "converged" : "not_converged") << ",9,0.08\n";
  }
  return out.str();
}

std::string SyntheticRun::cloud_pcd(bool registered) const {
  const std::vector<Point>& points = registered ? registered_points_ : prior_points_;
  std::string out = pcd_header({{.name = "x"}, {.name = "y"}, {.name = "z"}, {.name = "intensity"}, {.name = "error"}},
                               points.size());
  static_assert(sizeof(Point) == 20);
  out.append(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(Point));
  return out;
}

}  // namespace canyon::testing
