#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/true_increments.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector2d;
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
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kTolerance = 1e-12;  // rad, m/s: of the whole interval
// What the computation of rate and force rounds, in epsilons of its terms; QUADPACK's figure (qk15, resabs).
constexpr double kRoundings = 50.0;
// One panel integrates two turns to 1e-11 of their amplitude, so these do for a vibration of 100 kHz (the limit of its
// key) in samples at 200 Hz. More would be needed only where the last ones are said to be worse.
constexpr int kMostPanels = 256;
constexpr double kTurnsPerPanel = 2.0;

/// Rate and force at an instant, and the largest of the terms that they are the sums of.
struct Input {
  Vector6 value;
  Vector2d terms;
};

Input input_at(const PlacedMotion& placed, double t_s) {
  const KinematicState k = placed.motion->at(t_s);
  InertialInput input = inertial_input(k, placed.frame, placed.lever_arm_m);
  if (placed.R_BU) input = {placed.R_BU->conjugate() * input.w_IU_U, placed.R_BU->conjugate() * input.f_U};
  const double w = k.w_WB_B.norm(), arm_m = placed.lever_arm_m.norm();
  Input out;
  out.value << input.w_IU_U, input.f_U;
  out.terms = {w + Wgs84::rate_rad_s, input.f_U.norm() + k.a_WB_W.norm() + (k.alpha_WB_B.norm() + w * w) * arm_m +
                                          Wgs84::rate_rad_s * (k.v_WB_W.norm() + w * arm_m)};
  return out;
}

/// The two triads' largest components, gyroscope's and accelerometer's.
Vector2d largest(const Vector6& v) {
  return {v.head<3>().cwiseAbs().maxCoeff(), v.tail<3>().cwiseAbs().maxCoeff()};
}

/// The integral over a part of the interval.
struct Panel {
  double from_s, to_s;
  Vector6 sum = Vector6::Zero();
  Vector2d error, rounding;  ///< of the two triads: of the rule; what rounding alone may put there

  Panel(const PlacedMotion& placed, double from, double to) : from_s(from), to_s(to) {
    const double middle_s = 0.5 * (from + to), half_s = 0.5 * (to - from);
    std::array<Input, 15> nodes;
    std::array<double, 15> t;
    for (std::size_t i = 0; i < 15; ++i) {
      t[i] = i < 8 ? middle_s - kNode[i] * half_s : middle_s + kNode[14 - i] * half_s;
      nodes[i] = input_at(placed, t[i]);
    }
    Vector6 coarse = kGauss[7] * nodes[7].value;
    sum = kKronrod[7] * nodes[7].value;
    Vector2d terms = kKronrod[7] * nodes[7].terms, slope = Vector2d::Zero();
    for (std::size_t i = 0; i < 7; ++i) {
      const Vector6 pair = nodes[i].value + nodes[14 - i].value;
      sum += kKronrod[i] * pair;
      coarse += kGauss[i] * pair;
      terms += kKronrod[i] * (nodes[i].terms + nodes[14 - i].terms);
    }
    for (std::size_t i = 0; i + 1 < 15; ++i)
      if (t[i + 1] > t[i]) slope = slope.cwiseMax(largest(nodes[i + 1].value - nodes[i].value) / (t[i + 1] - t[i]));
    error = half_s * largest(sum - coarse);
    sum *= half_s;
    // A node's time, and the phase that a path makes of it, is rounded too: what varies fast cannot be had closer.
    const double t_rounding_s = kEpsilon * std::max(std::abs(from), std::abs(to));
    rounding = half_s * (kRoundings * kEpsilon * terms + 2.0 * t_rounding_s * 2.0 * slope);
  }
};

/// Panels in the order of time, the worst of them halved until all together are within the tolerance, none is worse
/// than its rounding, or there are as many as there may be.
class Quadrature {
 public:
  Quadrature(const PlacedMotion& placed, double from_s, double to_s) : placed_(placed) {
    panels_.emplace_back(placed, from_s, to_s);
    if (good_enough()) return;
    const double turns = turns_of(from_s, to_s);
    const int first = static_cast<int>(std::clamp(std::ceil(turns / kTurnsPerPanel), 1.0, 1.0 * kMostPanels));
    if (first > 1) {
      panels_.clear();
      for (int i = 0; i < first; ++i)
        panels_.emplace_back(placed, at(from_s, to_s, i, first), at(from_s, to_s, i + 1, first));
    }
    while (panels_.size() < kMostPanels && !good_enough() && halve_worst()) {
    }
  }

  Vector6 sum() const {
    Vector6 out = panels_.front().sum;
    for (std::size_t i = 1; i < panels_.size(); ++i) out += panels_[i].sum;
    return out;
  }
  /// Of the rule or of rounding, whichever is larger.
  IncrementAccuracy accuracy() const {
    const Vector2d a = total(&Panel::error).cwiseMax(total(&Panel::rounding));
    return {a[0], a[1]};
  }

 private:
  static double at(double from_s, double to_s, int i, int n) {
    return i == 0 ? from_s : i == n ? to_s : from_s + (to_s - from_s) * i / n;
  }
  double turns_of(double from_s, double to_s) const {
    const double middle_s = 0.5 * (from_s + to_s);
    double w = 0.0;
    for (const double t : {from_s, middle_s, to_s}) w = std::max(w, placed_.motion->at(t).w_WB_B.norm());
    return std::isfinite(w) ? w * (to_s - from_s) / (2.0 * kPi) : 0.0;
  }
  Vector2d total(Vector2d Panel::*of) const {
    Vector2d out = Vector2d::Zero();
    for (const Panel& p : panels_) out += p.*of;
    return out;
  }

  Vector2d allowed() const { return total(&Panel::rounding).cwiseMax(Vector2d::Constant(kTolerance)); }
  bool good_enough() const { return (total(&Panel::error).array() <= allowed().array()).all(); }

  /// False if there is none whose halving could make it better.
  bool halve_worst() {
    const Vector2d limit = allowed();
    std::size_t worst = panels_.size();
    double most = 0.0;
    for (std::size_t i = 0; i < panels_.size(); ++i) {
      const Panel& p = panels_[i];
      const double middle_s = 0.5 * (p.from_s + p.to_s);
      const bool divisible = p.from_s < middle_s && middle_s < p.to_s;
      const double excess = p.error.cwiseQuotient(limit).maxCoeff();
      if (!divisible || !((p.error.array() > p.rounding.array()).any()) || !(excess > most)) continue;
      most = excess;
      worst = i;
    }
    if (worst == panels_.size()) return false;
    const double from_s = panels_[worst].from_s, to_s = panels_[worst].to_s, middle_s = 0.5 * (from_s + to_s);
    panels_[worst] = Panel(placed_, from_s, middle_s);
    panels_.insert(panels_.begin() + static_cast<std::ptrdiff_t>(worst) + 1, Panel(placed_, middle_s, to_s));
    return true;
  }

  const PlacedMotion& placed_;
  std::vector<Panel> panels_;
};

}  // namespace

ImuSample motion_increments(const PlacedMotion& placed, double from_s, double to_s, IncrementAccuracy* reached) {
  CANYON_CHECK(from_s < to_s, "from ", from_s, " s to ", to_s, " s");
  const Quadrature quadrature(placed, from_s, to_s);
  const Vector6 sums = quadrature.sum();
  CANYON_CHECK(sums.allFinite(), "true motion handed to the IMU is not finite between ", from_s, " s and ", to_s, " s");
  if (reached != nullptr) *reached = quadrature.accuracy();
  ImuSample sample;
  sample.t = placed.start + to_s;
  sample.dt_s = to_s - from_s;
  sample.dtheta_U = sums.head<3>();
  sample.dv_U = sums.tail<3>();
  return sample;
}

}  // namespace canyon::inertial
