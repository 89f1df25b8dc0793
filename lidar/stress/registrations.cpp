// Registration of what cannot be registered: a status, never an exception, never a covariance that is partly NaN.
#include <cmath>
#include <cstdio>
#include <limits>

#include <Eigen/Eigenvalues>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/registration.h"
#include "canyon/lidar/registration/registration_covariance.h"
#include "canyon/lidar/stress/made_clouds.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using made::Cloud, made::corridor, made::level, made::line, made::room;
using stress::kInfinity;

std::unique_ptr<Registration> make(const std::string& method) {
  RegistrationConfig config;
  config.method.name = method;
  auto made = make_registration(config);
  return made.ok() ? *std::move(made) : nullptr;
}

/// A result that keeps what its header promises: a pose that is finite where the guess was, a covariance that is finite
/// as a whole, symmetric and positive, or NaN as a whole; converged only with one.
bool keeps_promise(const RegistrationResult& r, bool guess_finite) {
  const bool pose = r.X_TS.matrix().allFinite() || !guess_finite;
  bool covariance = r.covariance.array().isNaN().all();
  if (r.covariance.allFinite()) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(r.covariance);
    const double largest = eigen.eigenvalues().maxCoeff<Eigen::PropagateNaN>();
    covariance = eigen.eigenvalues().minCoeff<Eigen::PropagateNaN>() > -1e-12 * largest &&
                 (r.covariance - r.covariance.transpose()).norm() <= 1e-9 * largest;
  }
  return pose && covariance && (r.status != RegistrationStatus::kConverged || r.covariance.allFinite());
}

/// Of PCL's own methods a pose is a pose: they have no covariance, and may believe in anything.
bool of_pcl(const std::string& method) {
  return method == "pcl_icp_normals" || method == "pcl_gicp" || method == "pcl_ndt";
}

/// Pairs of odd clouds, from odd guesses; a figure counts broken promises and fixes where there can be none.
StressFigure odd(const std::string& name, const std::vector<std::pair<Cloud, Cloud>>& pairs,
                 const std::vector<Pose>& guesses, bool may_converge = false) {
  const auto method = make(name);
  StressFigure out;
  for (const auto& [source, target] : pairs) {
    const auto s = method->prepare(source), t = method->prepare(target);
    for (const Pose& guess : guesses) {
      const Registration::Placed placed{t, Pose{}};
      const RegistrationResult r = method->align(*s, {&placed, 1}, guess);
      const bool finite = guess.matrix().allFinite();
      const bool right = of_pcl(name)
                             ? (r.X_TS.matrix().allFinite() || !finite) && r.covariance.array().isNaN().all()
                             : keeps_promise(r, finite) && (may_converge || r.status != RegistrationStatus::kConverged);
      out.figure += right ? 0.0 : 1.0;
    }
  }
  return out;
}

Pose moved(double x, double y, double yaw_deg) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_deg * kDegree, Eigen::Vector3d::UnitZ())), {x, y, 0.0}};
}

/// Sigma that is told of a motion along a direction, in the source frame, where the clouds are the same place.
double told_sigma(const RegistrationResult& r, const Vector6d& along) {
  return std::sqrt(along.dot(r.covariance * along));
}

/// Which of the six motions of a source onto a target of the same surfaces are told to be open: sigma of at least 0.9
/// times the documented 10 m (rotations: at the cloud's radius), the others below 0.3 m or 0.03 rad. A figure counts
/// what differs.
StressFigure open_directions(const std::string& name, const Cloud& source, const Cloud& target,
                             const std::array<bool, 6>& open, double radius_m) {
  const auto method = make(name);
  const auto s = method->prepare(source), t = method->prepare(target);
  const Registration::Placed placed{t, Pose{}};
  const RegistrationResult r = method->align(*s, {&placed, 1}, moved(0.05, -0.03, 0.3));
  if (!r.covariance.allFinite()) return {6.0, 0.0};
  StressFigure out;
  for (int k = 0; k < 6; ++k) {
    const double sigma = told_sigma(r, Vector6d::Unit(k)) * (k < 3 ? radius_m : 1.0);
    out.figure +=
        open[static_cast<std::size_t>(k)] == (sigma > 9.0) && (open[static_cast<std::size_t>(k)] || sigma < 0.3) ? 0.0
                                                                                                                 : 1.0;
  }
  return out;
}

/// A room from a guess that is off: the pose within five of its own sigmas, each of 1 cm noise over thousands of
/// points, or the documented steps of convergence, 2e-4 m and 2e-5 rad; clouds `place_m` from the map's origin.
StressFigure found(const std::string& name, double off_m, double off_deg, double place_m) {
  const auto method = make(name);
  const Pose truth{Eigen::Quaterniond::Identity(), {place_m, -place_m, 0.0}};
  const auto s = method->prepare(room(1)), t = method->prepare(room(2));
  const Registration::Placed placed{t, truth};
  const RegistrationResult r = method->align(*s, {&placed, 1}, truth * moved(off_m, -off_m, off_deg));
  if (r.status != RegistrationStatus::kConverged) return {kInfinity, 1.0};
  const Vector6d error = (truth.inverse() * r.X_TS).log();
  StressFigure out{0.0, 1.0};
  for (int k = 0; k < 6; ++k)
    take_worst(out, std::abs(error[k]) / (5.0 * std::sqrt(r.covariance(k, k)) + (k < 3 ? 2e-5 : 2e-4)));
  return out;
}

/// The precision of matches by themselves: of unit normals of all directions without tilt every direction is
/// determined; of points on one line the turn about it is open: no covariance. A figure counts what differs.
StressFigure precision_of_a_line() {
  std::vector<Correspondence> all, on_line;
  for (int k = 0; k < 600; ++k) {
    Correspondence m;
    m.p_S = 10.0 * Eigen::Vector3d(std::sin(1.0 * k), std::cos(1.7 * k), std::sin(2.3 * k + 1.0));
    const Eigen::Vector3d n = Eigen::Vector3d(std::cos(0.7 * k), std::sin(1.1 * k), std::cos(1.9 * k)).normalized();
    m.information = n * n.transpose() * 1000.0 + 0.5 * Eigen::Matrix3d::Identity();
    m.residual = 0.01 * std::sin(13.0 * k) * n;
    all.push_back(m);
    m.p_S = Eigen::Vector3d(0.01 * k, 0.0, 0.0);
    on_line.push_back(m);
  }
  StressFigure out;
  const auto good = registration_precision(all, Eigen::Matrix3d::Identity(), 2.0),
             bad = registration_precision(on_line, Eigen::Matrix3d::Identity(), 2.0);
  out.figure += good.covariance.allFinite() && good.unconstrained == 0 ? 0.0 : 1.0;
  out.figure += bad.covariance.array().isNaN().all() ? 0.0 : 1.0;
  return out;
}

/// Priors of no, of endless, of no full and of no meaningful covariance, about a pose that is right and one that is
/// off: the promise, and with a prior that is certain its pose, to roundings of the room, where that is right, and no
/// success where it is wrong. A figure counts what is broken.
StressFigure odd_priors(const std::string& name) {
  const auto method = make(name);
  const auto s = method->prepare(room(1)), t = method->prepare(room(2));
  const Registration::Placed placed{t, Pose{}};
  Matrix6d one = Matrix6d::Zero(), skew = Matrix6d::Identity(), partly = Matrix6d::Identity();
  one(3, 3) = 1.0;
  skew(0, 5) = 1e3;
  partly(2, 2) = std::numeric_limits<double>::quiet_NaN();
  StressFigure out;
  for (const Pose& at : {Pose{}, moved(0.3, -0.2, 2.0), moved(40.0, 0.0, 90.0)})
    for (const Matrix6d& P : {Matrix6d(Matrix6d::Zero()), one, Matrix6d(1e-300 * Matrix6d::Identity()),
                              Matrix6d(1e6 * Matrix6d::Identity()), Matrix6d(1e300 * Matrix6d::Identity()),
                              Matrix6d(-Matrix6d::Identity()), skew, partly}) {
      const RegistrationResult r = method->align_with_prior(*s, {&placed, 1}, {at, P});
      const bool converged = r.status == RegistrationStatus::kConverged, right = at.p.isZero(0.0);
      const bool believed = converged && (at.inverse() * r.X_TS).log().norm() < 1e-9;
      out.figure += keeps_promise(r, true) && (!P.isZero(0.0) || (right ? believed : !converged)) ? 0.0 : 1.0;
    }
  return out;
}

/// Cases of one method; `mark` goes before what each is about.
void add_method(StressRows& rows, const std::string& method, const std::string& mark) {
  const std::vector<Pose> usual{Pose{}, moved(0.3, -0.2, 2.0)};
  const std::string of = "registrations/" + mark;
  rows.of({StressGroup::kData, "registration of clouds that are hardly any",
           "a library that throws or divides by the number of matches",
           "a status that is not converged; pose and covariance whole or absent", "broken"});
  rows.add(of + "no_overlap",
           [=] {
             Cloud far = room(2);
             for (auto& p : far) p.x() += 500.0f;
             return odd(method, {{room(1), far}}, usual);
           })
      .add(of + "empty_one_two_and_identical_points",
           [=] {
             const Cloud two{{1, 2, 3}, {4, 5, 6}}, same(5000, Eigen::Vector3f(1, 2, 3));
             return odd(method,
                        {{{}, {}},
                         {{}, room(1)},
                         {room(1), {}},
                         {two, two},
                         {two, room(1)},
                         {same, same},
                         {same, room(1)},
                         {room(1), same}},
                        usual);
           })
      .add(of + "a_line",
           [=] {
             return odd(method, {{line(), line()}}, usual);
           })
      .add(of + "points_at_1e9_m",
           [=] {
             Cloud far = room(1);
             for (auto& p : far) p += Eigen::Vector3f(1e9f, -1e9f, 0.0f);
             return odd(method, {{far, far}, {far, room(1)}, {room(1), far}}, usual);
           })
      .add(of + "points_not_finite", [=] {
        Cloud bad(5000, Eigen::Vector3f(std::numeric_limits<float>::quiet_NaN(), 1, 1));
        return odd(method, {{bad, bad}, {bad, room(1)}, {room(1), bad}}, usual);
      });
  rows.of({StressGroup::kData, "a guess that is far off or none",
           "map coordinates in single precision, NaN through the first transform",
           "a status that is not converged; pose and covariance whole or absent", "broken"});
  rows.add(of + "guess_off_by_1e7_m",
           [=] {
             return odd(method, {{room(1), room(2)}}, {moved(1e7, 0, 0), moved(-1e7, 1e7, 90.0), moved(1e300, 0, 0)});
           })
      .add(of + "guess_not_finite",
           [=] {
             Pose turned = moved(0, 0, 0);
             turned.R.x() = std::numeric_limits<double>::quiet_NaN();
             return odd(method, {{room(1), room(2)}},
                        {moved(std::numeric_limits<double>::quiet_NaN(), 0, 0), moved(kInfinity, 0, 0), turned});
           })
      .add(of + "guess_upside_down", [=] {
        return odd(method, {{room(1), room(2)}},
                   {Pose{Eigen::Quaterniond(0, 1, 0, 0), {0, 0, 0}}, moved(0, 0, 180.0), moved(0.9, 0.9, 20.0)}, true);
      });
  if (of_pcl(method)) return;
  rows.of({StressGroup::kGeometry, "directions that the surfaces leave open",
           "a sigma of millimetres along a corridor: the map slides, and knows nothing of it",
           "open ones are told with 10 m, the others with less than 0.3 m", "wrong"});
  rows.add(of + "room",
           [=] {
             return open_directions(method, room(1), room(2), {false, false, false, false, false, false}, 6.0);
           })
      .add(of + "corridor",
           [=] {
             return open_directions(method, corridor(1), corridor(2), {false, false, false, true, false, false}, 20.0);
           })
      .add(of + "plane", [=] {
        return open_directions(method, level(1), level(2), {false, false, true, true, true, false}, 16.0);
      });
  rows.of({StressGroup::kGeometry, "registration near and far from the map's origin",
           "single precision of map coordinates: a metre at 1e7 m",
           "the true pose within five of its sigmas, or 2e-4 m and 2e-5 rad", "of the bound"});
  rows.add(of + "room_off_by_10_cm", [=] { return found(method, 0.1, 1.0, 0.0); })
      .add(of + "room_off_by_40_cm_and_3_deg", [=] { return found(method, 0.4, 3.0, 0.0); })
      .add(of + "room_at_1e7_m", [=] { return found(method, 0.1, 1.0, 1e7); });
}

}  // namespace

std::vector<StressCase> registration_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "the curvature of matches on a line",
           "the inverse of a matrix without rank: sigmas of rounding",
           "no covariance, where all directions are met a finite one", "wrong"});
  rows.add("registrations/precision_of_a_line", precision_of_a_line);
  const std::string usual = RegistrationConfig{}.method.name;
  for (const auto& method : registration_methods()) {
    if (method.make.make == nullptr || !method.make.registers) continue;
    add_method(rows, method.name, method.name == usual ? "" : std::string(method.name) + "_");
  }
  rows.of({StressGroup::kData, "what is known before, with a covariance without rank, size or meaning",
           "the inverse of a prior that has none; a search over endless sigmas",
           "pose and covariance whole or absent; of a certain prior its pose where it is right", "broken"});
  for (const char* method : {"point_to_plane", "gicp", "vgicp"})
    rows.add(std::string("registrations/") + method + "_priors", [method] { return odd_priors(method); });
  return rows.take();
}

}  // namespace canyon::lidar
