// Sizes of what lasts of fixes, velocities and pseudoranges.
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/fusion/states/fix_error.h"
#include "canyon/fusion/states/range_errors.h"
#include "canyon/fusion/states/velocity_error.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/block_rows.h"
#include "canyon/fusion/stress/parts/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::Looks;

/// Sizes of what lasts of fixes, velocities and pseudoranges by their definitions: squares of shares are covariances,
/// along the axes of what is stated; growth by decades between its ends.
StressFigure lasting_errors() {
  Looks looks;
  DrawnNumbers draw(6);
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix3d stated = draw.positive(3, 0.1);
    for (const double power : {1.0, 2.0, 0.5}) {
      FixErrorParameters p;
      p.fix_error_sigma_m = 0.4, p.fix_error_scale = 1.7, p.fix_error_power = power;
      const Matrix3d C = p.covariance(stated), S = p.share(stated);
      looks.near((S * S * 0.16 - C).norm() / C.norm(), 0.0, 1e-12),
          looks.near((S - S.transpose()).norm(), 0.0, 1e-13 * S.norm());
      const Matrix3d grown = (C - 0.16 * Matrix3d::Identity()) / (1.7 * 1.7);
      // To the power one it is what is stated, to two its square; of one half its root.
      const Matrix3d expected = power == 1.0   ? stated
                                : power == 2.0 ? Matrix3d(stated * stated)
                                               : Matrix3d(grown * grown);
      looks.near(((power == 0.5 ? stated : grown) - expected).norm() / expected.norm(), 0.0, 1e-11);
      p.fix_error_scale = 0.0;
      looks.right(p.share(stated) == Matrix3d::Identity());
    }
    VelocityErrorParameters v;
    v.velocity_error_scale = 0.7, v.velocity_error_up_scale = 3.0;
    const Vector3d up = draw.three().normalized();
    const Matrix3d S = v.share(stated, up), along = up * up.transpose(), across = Matrix3d::Identity() - along;
    const Matrix3d stretched = 0.49 * (across + 3.0 * along) * stated * (across + 3.0 * along);
    looks.near((S * S - stretched).norm() / stretched.norm(), 0.0, 1e-12),
        looks.near((S - S.transpose()).norm(), 0.0, 1e-13 * S.norm());
  }
  const FixErrorParameters fix;
  const VelocityErrorParameters velocity;
  RangeErrorsParameters r;
  looks.right(fix.fix_error_sigma_m == 0.3 && fix.fix_error_scale == 1.5 && fix.fix_error_power == 1.5 &&
              fix.fix_error_tau_s == 20.0 && fix.fix_error_way_m == 1e9);
  looks.right(velocity.velocity_error_scale == 0.5 && velocity.velocity_error_up_scale == 6.0 &&
              velocity.velocity_error_tau_s == 2.0);
  looks.right(r.range_error_slots == 24 && r.range_error_sigma_m == 2.0 && r.range_error_decade_db == 14.0 &&
              r.range_error_most_m == 25.0 && r.range_error_mean == 1.0 && r.range_error_tau_s == 60.0 &&
              r.range_error_way_m == 50.0);
  for (const double cn0 : {60.0, 45.0, 38.0, 31.0, 30.0, 29.0, 10.0}) {
    const double grown = cn0 >= 45.0 ? 1.0 : std::pow(10.0, (45.0 - cn0) / 14.0), held = grown < 12.5 ? grown : 12.5;
    looks.close(r.growth(cn0), held, 16.0), looks.close(r.sigma_m(cn0), 2.0 * held, 16.0);
    looks.near(r.mean_m(cn0), 2.0 * held - 2.0, 1e-13);
  }
  r.range_error_mean = 0.4, r.range_error_most_m = 1.0;  // below the least: it stays that
  looks.close(r.growth(20.0), 1.0, 1.0), looks.near(r.mean_m(20.0), 0.0, 1e-300);
  r.range_error_most_m = 25.0;
  looks.near(r.mean_m(31.0), 0.4 * 18.0, 1e-12);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> lasting_error_cases() {
  StressRows rows = block_rows();
  rows.add("states/lasting_errors", lasting_errors);
  return rows.take();
}

}  // namespace canyon::fusion
