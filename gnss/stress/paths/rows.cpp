// Rows of waves and of facets that are looked at together, and the beams through which facets are met.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/gnss/paths/beam.h"
#include "canyon/gnss/paths/rows/facet_rows.h"
#include "canyon/gnss/paths/rows/near_waves.h"
#include "canyon/gnss/stress/paths/strewn_boxes.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using scene::Facet;

/// Every pair of an axis and a wave by their product in double precision: all that reach it, none that lack more than
/// the stated share of the axis's length, twice taken off by single precision; by axis and then by wave.
StressFigure near_waves() {
  int wrong = 0;
  const RandomStream draws(1, "stress.shortcuts");
  for (const int waves : {1, 7, 8, 37})
    for (const int count : {1, 63, 64, 65, 200}) {
      std::vector<Vector3d> sky;
      for (int i = 0; i < waves; ++i) sky.push_back(draws.direction(20, static_cast<std::uint64_t>(100 * waves + i)));
      WaveAxes axes;
      std::vector<Vector3d> axis;
      std::vector<double> least;
      axes.resize(5), axes.clear();
      for (int i = 0; i < count; ++i) {
        const auto k = static_cast<std::uint64_t>(i);
        const double length = draws.uniform(0.3, 40.0, 21, k);
        axis.push_back(length * draws.direction(22, k));
        least.push_back(length * draws.uniform(-0.2, 1.0, 23, k));
        axes.add(axis.back(), length, least.back());
      }
      wrong += axes.size() == static_cast<std::size_t>(count) ? 0 : 1;
      NearWaves near;
      near.fill(sky);
      std::vector<AxisAndWave> found{{7, 7}};
      near.find(axes, found);
      std::size_t at = 0;
      for (std::uint32_t a = 0; a < axis.size(); ++a)
        for (std::uint32_t w = 0; w < sky.size(); ++w) {
          const double more = axis[a].dot(sky[w]) - least[a], slack = 2.0 * WaveAxes::kRounding * axis[a].norm();
          const bool is = at < found.size() && found[at].axis == a && found[at].wave == w;
          wrong += is ? (more >= -slack ? 0 : 1) : (more >= 0.0 ? 1 : 0);
          at += is ? 1 : 0;
        }
      wrong += at == found.size() ? 0 : 1;
    }
  return {1.0 * wrong, 0.0};
}

/// Facets that may be met through a window, one by one in double precision: in front of the window's plane, within its
/// four sides, facing the apex, each with the ball's radius and a centimetre of slack; and half a millimetre either way
/// for single precision at 150 m.
StressFigure facets_through_windows() {
  int wrong = 0;
  std::size_t met_ones = 0;
  const auto boxes = strewn_boxes(2, 70, false);
  const auto& facets = boxes->facets().facets();
  FacetRows rows;
  // Not all of them, and no whole number of rows.
  for (std::uint32_t i = 0; i < facets.size(); ++i)
    if (i % 7 != 3) rows.ids.push_back(i);
  rows.fill(facets);
  for (std::uint32_t w = 0; w < facets.size(); w += 5) {
    const Facet& window = facets[w];
    const Vector3d antenna(1.0, -2.0, 1.5);
    const double to_plane = window.normal_W.dot(antenna) - window.offset_m;
    if (to_plane <= 0.0) continue;
    const Vector3d apex = antenna - 2.0 * to_plane * window.normal_W;
    std::vector<std::uint32_t> found{1, 2, 3};
    rows.meet(window, Beam(apex, window), found);
    met_ones += found.size();
    std::size_t at = 0;
    for (const std::uint32_t id : rows.ids) {
      const Facet& f = facets[id];
      double room = f.normal_W.dot(apex) - f.offset_m;
      room = std::min(room, window.normal_W.dot(f.center_W) - window.offset_m + f.radius_m);
      for (std::size_t k = 0; k < 4; ++k) {
        // Sides by the rectangle's corners, inward where its middle lies.
        const Vector3d a = window.rectangle_W[k] - apex, b = window.rectangle_W[(k + 1) % 4] - apex;
        Vector3d n = a.cross(b).normalized();
        if (n.dot(window.rectangle_W[(k + 2) % 4] - apex) < 0.0) n = -n;
        room = std::min(room, n.dot(f.center_W - apex) + f.radius_m);
      }
      const bool is = at < found.size() && found[at] == id;
      wrong += is ? (room + 0.01 > -5e-4 ? 0 : 1) : (room + 0.01 > 5e-4 ? 1 : 0);
      at += is ? 1 : 0;
    }
    wrong += at == found.size() ? 0 : 1;
  }
  wrong += met_ones > 200 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Points of the pyramid through a rectangle are in the beam, points beside it are not, and a ball is as far as it
/// reaches over.
StressFigure beams() {
  int wrong = 0;
  const RandomStream draws(3, "stress.shortcuts");
  const auto boxes = strewn_boxes(4, 12, false);
  std::uint64_t k = 0;
  for (const Facet& f : boxes->facets().facets()) {
    ++k;
    const Vector3d apex = f.center_W - draws.uniform(3.0, 60.0, 30, k) * f.normal_W + 2.0 * draws.direction(31, k);
    const Beam beam(apex, f);
    wrong += beam.apex_W == apex ? 0 : 1;
    for (int i = 0; i < 40; ++i) {
      const double u = draws.uniform(-0.5, 1.5, 32, 64 * k + static_cast<std::uint64_t>(i)),
                   v = draws.uniform(-0.5, 1.5, 33, 64 * k + static_cast<std::uint64_t>(i)),
                   far = draws.uniform(0.2, 5.0, 34, 64 * k + static_cast<std::uint64_t>(i));
      const auto& c = f.rectangle_W;
      const Vector3d point = apex + far * (c[0] + u * (c[1] - c[0]) + v * (c[3] - c[0]) - apex);
      const bool inside = u > 0.0 && u < 1.0 && v > 0.0 && v < 1.0;
      wrong += beam.may_meet(point, 0.0) == inside ? 0 : 1;
      double beyond_m = 0.0;
      for (const Vector3d& n : beam.inward_W) {
        wrong += std::abs(n.norm() - 1.0) < 1e-12 ? 0 : 1;
        beyond_m = worse(beyond_m, -n.dot(point - apex));
      }
      wrong +=
          beam.may_meet(point, 1.001 * beyond_m + 1e-9) && (inside || !beam.may_meet(point, 0.999 * beyond_m)) ? 0 : 1;
    }
  }
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> row_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "rows of waves and facets that are looked at together",
           "a row that is not filled up, slack that is taken off, a side of another facet's",
           "each by itself in double precision, to the stated slack: exact", "wrong"});
  rows.add("shortcuts/near_waves", near_waves)
      .add("shortcuts/facets_through_windows", facets_through_windows)
      .add("shortcuts/beams", beams);
  return rows.take();
}

}  // namespace canyon::gnss
