// Corridors of a plan: where and when they hold, and what is said of leaving them.
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress/looks.h"
#include "canyon/mission/corridor_guard.h"
#include "canyon/mission/stress/runs/subjects.h"

namespace canyon::mission {
namespace {

using stress::Looks;

/// Three pieces of 20 m, one after another, 2 m to each side, each with its own number of reflections.
std::vector<PlannedPlace> pieces() {
  std::vector<PlannedPlace> out;
  for (int k = 0; k < 3; ++k) {
    PlannedPlace place;
    place.segment = {.points_W = {{20.0 * k, 0, 0}, {20.0 * (k + 1), 0, 0}},
                     .start_m = 20.0 * k,
                     .end_m = 20.0 * (k + 1),
                     .half_width_m = 2.0,
                     .low_m = -1.0,
                     .high_m = 1.0};
    place.paths.most_reflections = k;
    place.paths.foliage = k == 1;
    place.around.clear_m = 5.0 + k;
    out.push_back(place);
  }
  return out;
}

Pose at_place(double x, double y) {
  return {Eigen::Quaterniond::Identity(), {x, y, 0.0}};
}

/// In each piece what that piece says, there and back; beside them, above them or after their time nothing is left
/// out, then and for good, and the first such place is told.
StressFigure guarded() {
  Looks looks;
  const gnss::PathOmissions nothing;
  CorridorGuard guard(pieces(), 30.0);
  looks.right(guard.place() != nullptr);
  // Pieces reach half their width beyond their ends, and the one found last is asked first.
  for (const double x : {1.0, 15.0, 17.0, 30.0, 45.0, 55.0, 30.0, 10.0, 55.0, 10.0}) {
    const int piece = x < 22.0 ? 0 : x < 42.0 ? 1 : 2;
    const gnss::PathOmissions found = guard.at(0.2 * x, at_place(x, 1.5));
    looks.right(found.most_reflections == piece && found.foliage == (piece == 1) && !guard.left());
    looks.right(guard.place() != nullptr && guard.place()->around.clear_m == 5.0 + piece);
  }
  looks.right(guard.at(30.0, at_place(10.0, -1.9)).most_reflections == 0 && !guard.left());
  looks.right(guard.at(12.34, at_place(31.0, -2.31)) == nothing && guard.place() == nullptr);
  const std::string first =
      "left the plan's corridor at 12.34 s, x 31.0 m, y -2.3 m: nothing is left out from there on";
  looks.right(guard.left() == first);
  looks.right(guard.at(13.0, at_place(30.0, 0.0)) == nothing && guard.at(99.0, at_place(300.0, 0.0)) == nothing &&
              guard.left() == first);
  CorridorGuard late(pieces(), 30.0);
  looks.right(
      late.at(30.01, at_place(10.0, 0.5)) == nothing &&
      late.left() ==
          "drives beyond the plan's time limit at 30.01 s, x 10.0 m, y 0.5 m: nothing is left out from there on");
  CorridorGuard above(pieces(), 30.0);
  Pose high = at_place(10.0, 0.0);
  high.p.z() = 1.2;
  looks.right(above.at(1.0, high) == nothing && above.left().has_value());
  CorridorGuard none({}, 0.0);
  looks.right(none.at(5.0, at_place(1e6, 0.0)) == nothing && !none.left() && none.place() == nullptr);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> corridor_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "a plan's corridor, in it and beside it",
           "a piece's omissions for another's, a corridor that is entered again, a limit of the other side",
           "each piece's own, and none once it is left: exact", "of the bound"});
  rows.add("corridors/guarded", guarded);
  return rows.take();
}

}  // namespace canyon::mission
