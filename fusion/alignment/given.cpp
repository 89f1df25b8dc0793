#include <array>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/units.h"
#include "canyon/fusion/alignment/alignment.h"

namespace canyon::fusion {
namespace {

struct GivenStart {
  Eigen::Vector3d place_deg_deg_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ned_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d roll_pitch_heading_deg = Eigen::Vector3d::Zero();
};
void visit(FieldVisitor& f, GivenStart& p) {
  f.vector3("place_deg_deg_m", p.place_deg_deg_m, {-1e6, 1e6},
            "given: latitude, longitude and height of the IMU above the ellipsoid");
  f.vector3("velocity_ned_m_s", p.velocity_ned_m_s, {-1e4, 1e4}, "given: velocity north, east, down");
  f.vector3("roll_pitch_heading_deg", p.roll_pitch_heading_deg, {-360, 360},
            "given: attitude of forward-right-down in north-east-down");
}

}  // namespace

/// At the beginning of the first sample, with the filter's own initial uncertainty.
Result<Aligned> align_given(const ModelParameters& own, const AlignmentInputs& inputs) {
  const GivenStart& p = own.get<GivenStart>();
  const Geodetic at{p.place_deg_deg_m.x() * kDegree, p.place_deg_deg_m.y() * kDegree, p.place_deg_deg_m.z()};
  if (std::abs(p.place_deg_deg_m.x()) > 90.0)
    return Error{"", 0, "start.place_deg_deg_m", "a latitude beyond the pole", "degrees from -90 to 90"};
  const Eigen::Vector3d a = p.roll_pitch_heading_deg * kDegree, &v = p.velocity_ned_m_s;
  Aligned out;
  out.nav.t = inputs.imu.front().t - inputs.imu.front().dt_s;
  out.nav.p_EU_E = ecef_from_geodetic(at);
  out.nav.R_EU = attitude_from_ned(at, a.x(), a.y(), a.z());
  out.nav.v_EU_E = rotation_E_from_enu(at) * Eigen::Vector3d(v.y(), v.x(), -v.z());
  return out;
}

void given_parameters(ModelParameters& section) {
  section.add<GivenStart>();
}

}  // namespace canyon::fusion
