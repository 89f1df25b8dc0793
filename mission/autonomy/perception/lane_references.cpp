#include "canyon/mission/autonomy/perception/lane_reference.h"

namespace canyon::mission {
namespace {

/// The route alone, wherever the estimate puts it.
class RouteAlone final : public LaneReference {
 public:
  double middle_m(const LaneTask&) override { return 0.0; }
};

std::unique_ptr<LaneReference> make_route_alone() {
  return std::make_unique<RouteAlone>();
}

constexpr ModelRow<MakeLaneReference> kLaneReferences[] = {
    {"seen_street", make_seen_street, "the route, moved by what is seen to both sides of it", seen_street_parameters},
    {"seen_kerbs", make_seen_kerbs, "the route, moved by the kerbs that are seen on both sides of it",
     seen_kerbs_parameters},
    {"route", without_keys<make_route_alone>, "the route, wherever the estimate puts it"},
};

}  // namespace

ModelTable<MakeLaneReference> lane_references() {
  return kLaneReferences;
}

}  // namespace canyon::mission
