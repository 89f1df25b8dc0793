#include <cmath>

#include "canyon/core/earth/earth.h"
#include "canyon/fusion/alignment/alignment.h"

namespace canyon::fusion {
namespace {

constexpr ModelRow<Align> kAlignments[] = {
    {"given", align_given, "as the keys say, at the log's first sample", given_parameters},
    {"static", align_static,
     "at rest: levelled with the mean force, heading as given, or from the Earth's rate if the gyroscopes are good "
     "enough, or unknown",
     static_parameters},
    {"in_motion", align_in_motion, "levelled, and heading along the course, once the fixes move fast enough",
     in_motion_parameters},
};

}  // namespace

ModelTable<Align> alignments() {
  return kAlignments;
}

Eigen::Quaterniond attitude_from_force(const Eigen::Vector3d& p_E, const Eigen::Vector3d& force_U,
                                       const Eigen::Vector3d& force_E, double heading_rad) {
  const Eigen::Matrix3d R_E_enu = rotation_E_from_enu(geodetic_from_ecef(p_E));
  const Eigen::Vector3d force = (R_E_enu.transpose() * force_E).normalized();
  const Eigen::Quaterniond levelled = Eigen::Quaterniond::FromTwoVectors(force_U, force);
  // What is left is a turn about the force; along it x comes nearest to the course, level or not.
  const Eigen::Vector3d course(std::sin(heading_rad), std::cos(heading_rad), 0.0),
      x = levelled * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d wanted = course - course.dot(force) * force, has = x - x.dot(force) * force;
  const double turn = std::atan2(force.dot(has.cross(wanted)), has.dot(wanted));
  const Eigen::Quaterniond R_enu = Eigen::Quaterniond(Eigen::AngleAxisd(turn, force)) * levelled;
  return (Eigen::Quaterniond(R_E_enu) * R_enu).normalized();
}

}  // namespace canyon::fusion
