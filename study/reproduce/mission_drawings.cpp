// Figures 8 to 10 as drawings: the scene, and where the vehicle was in it and was taken to be.
#include "canyon/study/reproduce/mission_drawings.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "canyon/mission/run.h"
#include "canyon/scene/scene.h"
#include "canyon/study/reproduce/from_above.h"

namespace canyon::study {
namespace {

constexpr double kRouteStep_m = 2.0;  // of the route as drawn; its own points are closer than a pixel

/// A closed outline after those before it, apart from them.
void add_ring(const std::vector<Eigen::Vector2d>& ring, std::vector<Eigen::Vector2d>& rings) {
  if (ring.empty()) return;
  rings.insert(rings.end(), ring.begin(), ring.end());
  rings.push_back(ring.front());
  rings.emplace_back(kNaN, kNaN);
}

std::vector<Eigen::Vector2d> building_rings(const scene::Scene& scene) {
  std::vector<Eigen::Vector2d> rings;
  for (const scene::Building& building : scene.buildings()) {
    add_ring(building.footprint_W, rings);
    for (const auto& courtyard : building.courtyards_W) add_ring(courtyard, rings);
  }
  return rings;
}

std::vector<Eigen::Vector2d> route_places(const mission::Path& route) {
  std::vector<Eigen::Vector2d> places;
  for (double s_m = 0.0; s_m < route.length_m(); s_m += kRouteStep_m) places.push_back(route.at(s_m));
  places.push_back(route.at(route.length_m()));
  return places;
}

/// The waypoints at which it stops and looks, or those that it only passes.
PaperCurve waypoints(const char* panel, const char* name, const std::vector<mission::Waypoint>& all, bool is_mission) {
  std::vector<Eigen::Vector2d> places;
  std::vector<std::string> names;
  for (const mission::Waypoint& waypoint : all) {
    if (waypoint.is_mission() != is_mission) continue;
    places.push_back(waypoint.p_m);
    names.push_back(waypoint.name);
  }
  PaperCurve curve = from_above(panel, name, places);
  curve.points = true;
  curve.labels = std::move(names);
  return curve;
}

/// Places in W by the time since the start.
struct Track {
  std::vector<double> t_s;
  std::vector<Eigen::Vector3d> p_W;
  void add(double t, const Eigen::Vector3d& p) {
    t_s.push_back(t);
    p_W.push_back(p);
  }
};

/// The places of a run, one a second, and of its fixes.
class Places final : public mission::Recorder {
 public:
  Places(const LocalFrame& frame, GpsTime start) : frame_(frame), start_(start) {}
  Status epoch(const mission::NavRow& row) override {
    const double t_s = row.t - start_;
    if (t_s < next_s_) return Ok{};
    next_s_ += 1.0;
    truth_.add(t_s, row.X_WB_true.p);
    output_.add(t_s, row.estimate.X_WB.p);
    return Ok{};
  }
  Status gnss(const mission::GnssRow& row) override {
    if (row.fix.status != FixStatus::kNone) fixes_.add(row.fix.t - start_, frame_.to_W(row.fix.p_A_E));
    return Ok{};
  }
  const Track& truth() const { return truth_; }
  const Track& output() const { return output_; }
  const Track& fixes() const { return fixes_; }

 private:
  LocalFrame frame_;
  GpsTime start_;
  double next_s_ = 0.0;
  Track truth_, output_, fixes_;
};

/// The same track in both views.
struct Views {
  std::vector<PaperCurve> above, height;
  void add(const std::string& name, const Track& track, bool points = false) {
    above.push_back(from_above("Fig. 9 and 10: tracks, from above", name, track.p_W));
    PaperCurve over_time{
        .panel = "Fig. 9 and 10: height above the scene's origin", .unit = "m", .name = name, .x = track.t_s, .y = {}};
    for (const Eigen::Vector3d& p : track.p_W) over_time.y.push_back(p.z());
    height.push_back(std::move(over_time));
    above.back().points = height.back().points = points;
  }
};

}  // namespace

std::vector<PaperCurve> scene_curves(const mission::MissionConfig& config, const mission::PreparedMission& mission) {
  constexpr const char* kPanel = "Fig. 8: the scene and its waypoints, from above";
  return {waypoints(kPanel, "mission waypoints", config.autonomy.waypoints, true),
          waypoints(kPanel, "waypoints passed", config.autonomy.waypoints, false),
          from_above(kPanel, "planned route", route_places(mission.prior.route)),
          from_above(kPanel, "buildings", building_rings(*mission.scene))};
}

Result<std::vector<PaperCurve>> track_curves(const Comparison& open) {
  Views views;
  for (std::size_t i = 0; i < open.plan.size(); ++i) {
    const mission::PreparedMission& mission = open.missions[i];
    const std::string& fidelity = open.plan[i].name;
    Places places(mission.scene->frame(), mission.start);
    CANYON_TRY_STATUS(
        mission::run_mission(open.configs[i], mission, nullptr,
                             {.tape = &*open.tape, .recorder = &places, .autonomy = nullptr, .omissions = nullptr}));
    if (i == 0) views.add("true path", places.truth());
    views.add(fidelity + ", output", places.output());
    if (i > 0) views.add(fidelity + ", fixes", places.fixes(), true);
  }
  std::vector<PaperCurve> curves = std::move(views.above);
  std::move(views.height.begin(), views.height.end(), std::back_inserter(curves));
  return curves;
}

}  // namespace canyon::study
