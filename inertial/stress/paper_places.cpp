// The paper's figures: their parameters, and places by their speeds.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/paper_figures.h"
#include "canyon/inertial/stress/subjects.h"

namespace canyon::inertial {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// The paper's figures: places are sums of mean speeds over each sample, and speeds of what the same chain adds; the
/// text's parameters are those of its figure but for what it prints otherwise.
StressFigure paper_places() {
  Looks looks;
  const auto all = paper_figures();
  looks.right(all.size() == 3);
  const double seconds[] = {1200.0, 600.0, 600.0};
  for (std::size_t i = 0; i < all.size() && i < 3; ++i) looks.right(all[i].seconds == seconds[i]);
  const CatalogueEntry text = all[2].entry(), figure = all[1].entry();
  looks.right(text.paper.gyro.quality_factor == 0.15 && text.paper.accel.quality_factor == 0.15 &&
              text.paper.gyro.white_process == 0.30 && text.paper.accel.white_process == 0.15);
  looks.right(figure.paper.gyro.white_process == 0.15 && figure.paper.accel.white_process == 0.12 &&
              figure.paper.gyro.quality_factor == 0.2);
  for (const char* name : {"paper", "paper_as_printed"}) {
    PaperFigure short_one = all[1];
    short_one.seconds = 20.0;
    const auto found = paper_drift(short_one, name, 4);
    const auto chain = make_error_chain(name, {.entry = figure, .seed = 4, .rate_hz = 125.0});
    if (!found || !chain || found->t_s.size() != 2500) return {kInfinity, 1.0};
    Vector3d speed = Vector3d::Zero(), place = Vector3d::Zero();
    for (std::int64_t k = 0; k < 2500; ++k) {
      ImuSample s;
      s.dt_s = 1.0 / 125.0;
      (*chain)->corrupt(k, s);
      const auto i = static_cast<std::size_t>(k);
      looks.near(found->t_s[i], static_cast<double>(k + 1) / 125.0, 1e-12);
      const Vector3d before = speed;
      speed += s.dv_U;
      place += 0.5 / 125.0 * (before + speed);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        looks.close(found->rate_deg_s[axis][i], s.dtheta_U[a] * 125.0 * 180.0 / kPi, 16.0);
        looks.near(found->position_m[axis][i], place[a], 2500.0 * 8.0 * kEpsilon * (std::abs(place[a]) + 1.0));
      }
    }
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> paper_place_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "the paper's figures", "a place by the speed at one end",
           "sums of mean speeds of the same chain: roundings", "of the bound"});
  rows.add("elements/places_of_the_paper", paper_places);
  return rows.take();
}

}  // namespace canyon::inertial
