// Dilution of precision from the best geometry to none.
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using stress::kEpsilon;

/// A frame that has nothing to do with the axes, so that no zeros help.
Eigen::Matrix3d some_frame() {
  return Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
}

std::vector<Eigen::Vector3d> turned(std::vector<Eigen::Vector3d> enu) {
  for (Eigen::Vector3d& line : enu) line = some_frame() * line;
  return enu;
}

/// One satellite at the zenith, `n` on a cone of half-angle `alpha` about it.
std::vector<Eigen::Vector3d> cone(int n, double alpha) {
  std::vector<Eigen::Vector3d> lines{Eigen::Vector3d::UnitZ()};
  for (int k = 0; k < n; ++k) {
    const double a = 2.0 * kPi * k / n;
    lines.emplace_back(std::sin(alpha) * std::cos(a), std::sin(alpha) * std::sin(a), std::cos(alpha));
  }
  return lines;
}

/// Of that geometry, with d = 1 - cos(alpha): HDOP^2 = 4 / (n sin^2), VDOP^2 = (n + 1) / (n d^2), TDOP^2 = (n cos^2 +
/// 1) / (n d^2). A change of G by delta changes its pseudoinverse by 2 |G+| |delta| of itself (Wedin 1973); lines round
/// by eps each, so |delta| <= 2 eps sqrt(n + 1), and |G+| <= GDOP.
StressFigure cone_dops(int n, double gdop) {
  // Near the zenith GDOP = sqrt(2 n + 2) / (sqrt(n) alpha^2 / 2).
  const double alpha = std::min(std::sqrt(2.0 * std::sqrt((2.0 * n + 2.0) / n) / gdop), 0.5 * kPi);
  const double d = 2.0 * std::pow(std::sin(0.5 * alpha), 2), c = std::cos(alpha), s = std::sin(alpha);
  const double h2 = 4.0 / (n * s * s), v2 = (n + 1.0) / (n * d * d), t2 = (n * c * c + 1.0) / (n * d * d);
  const Dop dop = dilution_of_precision(turned(cone(n, alpha)), some_frame(), true);
  const double exact = std::sqrt(h2 + v2 + t2);
  StressFigure out{0.0, 4.0 * std::sqrt(n + 1.0) * kEpsilon * exact + 32.0 * kEpsilon};
  take_worst(out, std::abs(dop.gdop / exact - 1.0));
  take_worst(out, std::abs(dop.vdop / std::sqrt(v2) - 1.0));
  take_worst(out, std::abs(dop.tdop / std::sqrt(t2) - 1.0));
  return out;
}

/// Four satellites at the corners of a regular tetrahedron: H'H = diag(4/3, 4/3, 4/3, 4), GDOP = sqrt(5/2), the least
/// that four can have.
StressFigure tetrahedron() {
  const Dop dop = dilution_of_precision(turned(cone(3, std::acos(-1.0 / 3.0))), some_frame(), true);
  StressFigure out{0.0, 64.0 * kEpsilon};
  take_worst(out, std::abs(dop.gdop - std::sqrt(2.5)));
  take_worst(out, std::abs(dop.pdop - 1.5));
  take_worst(out, std::abs(dop.tdop - 0.5));
  return out;
}

/// The smallest singular value is no more than the rounding of the lines, sqrt(n) eps; so 1 / GDOP is.
StressFigure inverse_gdop(const std::vector<Eigen::Vector3d>& lines) {
  const Dop dop = dilution_of_precision(turned(lines), some_frame(), true);
  return {std::isnan(dop.gdop) ? dop.gdop : 1.0 / dop.gdop,
          4.0 * std::sqrt(static_cast<double>(lines.size())) * kEpsilon};
}

std::vector<Eigen::Vector3d> ring(int n, double elevation_rad) {
  std::vector<Eigen::Vector3d> lines = cone(n, 0.5 * kPi - elevation_rad);
  lines.erase(lines.begin());
  return lines;
}

std::vector<Eigen::Vector3d> fan(int n) {
  std::vector<Eigen::Vector3d> lines;
  for (int k = 0; k < n; ++k) lines.emplace_back(0.0, std::cos(0.3 + 0.4 * k), std::sin(0.3 + 0.4 * k));
  return lines;
}

}  // namespace

std::vector<StressCase> dilution_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "dilution of precision of a narrow cone",
           "the normal equations have the square of the condition: no digit is left at a GDOP of 1e8",
           "closed form of a cone; relative error 4 sqrt(n + 1) eps GDOP + 32 eps (Wedin 1973)", ""});
  for (const double gdop : {1e1, 1e2, 1e4, 1e6, 1e8, 1e10}) {
    const std::string name = printed("%.0e", gdop);
    rows.add(std::string("dilution/four_in_a_cone_gdop_") + name, [gdop] { return cone_dops(3, gdop); });
  }
  rows.add("dilution/thirteen_in_a_cone_gdop_1e+06", [] { return cone_dops(12, 1e6); })
      .loose("the roundings of thirteen lines, evenly around, cancel in the one direction that matters");

  rows.of({StressGroup::kGeometry, "the least dilution that four satellites can have",
           "a clock column of the wrong sign or scale does not show in the position alone",
           "tetrahedron: GDOP sqrt(5/2), PDOP 3/2, TDOP 1/2 to 64 eps", ""});
  rows.add("dilution/tetrahedron", tetrahedron);

  rows.of({StressGroup::kGeometry, "a geometry without rank",
           "rounding hides the rank: a finite, plausible GDOP or a negative variance under the root",
           "1 / GDOP is no more than the rounding of the lines, 4 sqrt(n) eps", ""});
  rows.add("dilution/all_on_a_cone", [] { return inverse_gdop(ring(6, 0.7)); })
      .add("dilution/all_in_the_horizon", [] { return inverse_gdop(ring(5, 0.0)); })
      .add("dilution/all_in_a_vertical_plane", [] { return inverse_gdop(fan(7)); })
      .add("dilution/four_in_one_direction",
           [] {
             return inverse_gdop({4, Eigen::Vector3d(0.48, 0.6, 0.64)});
           })
      .add("dilution/three_and_one_twice",
           [] {
             auto lines = cone(2, 0.8);
             lines.push_back(lines.back());
             return inverse_gdop(lines);
           })
      .loose("two lines alike to the bit leave a singular value of 0 but for the decomposition's own underflow");
  return rows.take();
}

}  // namespace canyon::gnss
