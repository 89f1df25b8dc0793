#include <cmath>

#include "core/check.h"
#include "inertial/motion/motion.h"
#include "inertial/true_increments.h"

namespace canyon::inertial {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

// Kronrod's extension of the Gauss rule of seven nodes (QUADPACK, Piessens et al. 1983, qk15): exact to degree 22, and
// its distance to the Gauss rule bounds the error.
constexpr double kNode[8] = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                             0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                             0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
                             0.207784955007898467600689403773245, 0.0};
constexpr double kKronrod[8] = {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr double kGauss[8] = {0.0, 0.129484966168869693270611432679082, 0.0, 0.279705391489276667901467771423780,
                              0.0, 0.381830050505118944950369775488975, 0.0, 0.417959183673469387755102040816327};
constexpr double kTolerance = 1e-12;
constexpr int kMaxHalvings = 40;  // a jump in the acceleration is then located to 1e-12 of the interval

Vector6 input_at(const PlacedMotion& placed, double t_s) {
  const InertialInput input = inertial_input(placed.motion->at(t_s), placed.frame, placed.lever_arm_m);
  Vector6 rates;
  rates << input.w_IU_U, input.f_U;
  return rates;
}

Vector6 integral(const PlacedMotion& placed, double from_s, double to_s, double tolerance, int halvings) {
  const double middle_s = 0.5 * (from_s + to_s), half_s = 0.5 * (to_s - from_s);
  const Vector6 centre = input_at(placed, middle_s);
  Vector6 fine = kKronrod[7] * centre, coarse = kGauss[7] * centre;
  for (int i = 0; i < 7; ++i) {
    const Vector6 pair =
        input_at(placed, middle_s - kNode[i] * half_s) + input_at(placed, middle_s + kNode[i] * half_s);
    fine += kKronrod[i] * pair;
    coarse += kGauss[i] * pair;
  }
  if (half_s * (fine - coarse).cwiseAbs().maxCoeff() <= tolerance || halvings == kMaxHalvings) return half_s * fine;
  return integral(placed, from_s, middle_s, 0.5 * tolerance, halvings + 1) +
         integral(placed, middle_s, to_s, 0.5 * tolerance, halvings + 1);
}

}  // namespace

ImuSample motion_increments(const PlacedMotion& placed, double from_s, double to_s) {
  CANYON_CHECK(from_s < to_s, "from ", from_s, " s to ", to_s, " s");
  const Vector6 sums = integral(placed, from_s, to_s, kTolerance, 0);
  CANYON_CHECK(sums.allFinite(), "true motion handed to the IMU is not finite between ", from_s, " s and ", to_s, " s");
  ImuSample sample;
  sample.t = placed.start + to_s;
  sample.dt_s = to_s - from_s;
  sample.dtheta_U = sums.head<3>();
  sample.dv_U = sums.tail<3>();
  return sample;
}

}  // namespace canyon::inertial
