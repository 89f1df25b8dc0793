#include "canyon/tests/mutation/format.h"

namespace canyon::testing {
namespace {

/// Level ground with a house and walls, and streets to drive on: a mission of a second.
constexpr const char* kTown = R"({"type":"FeatureCollection","features":[{"type":"Feature",
"properties":{"id":"town hall","height":12.0},"geometry":{"type":"Polygon","coordinates":[
[[5.0,45.0],[5.0003,45.0],[5.0003,45.0002],[5.0,45.0002],[5.0,45.0]]]}},
{"type":"Feature","properties":{"highway":"residential"},"geometry":{"type":"LineString",
"coordinates":[[4.9999,44.9999],[5.0004,44.9999],[5.0004,45.0003]]}}]})";

constexpr const char* kMission = R"([run]
name = "short"
seed = 3
[scene]
file = "town.geojson"
undulation_m = 40.0
lat_deg = 45.0
lon_deg = 5.0
[time]
start = "2010-11-17T13:00:00"
limit_s = 0.5
[vehicle]
start_m = [-12.0, -22.0]
start_heading_deg = 0.0
[gnss]
rate_hz = 2.0
systems = "GR"
mask_deg = 10.0
[imu]
rate_hz = 100.0
sensor = "high_grade_mems"
lever_arm_m = [0.1, 0.0, 0.5]
[lidar]
beams = "vlp16"
rate_hz = 10.0
azimuth_steps = 90
[registration]
method = "none"
[autonomy]
[[autonomy.waypoint]]
name = "1"
p_m = [10.0, -22.0]
[fidelity.careful.gnss]
rate_hz = 1.0
)";

constexpr const char* kLayered = R"(base = "vicksburg"
[run]
name = "layered"
[scene]
file = "town.geojson"
undulation_m = 40.0
[vehicle]
start_m = [-12.0, -22.0]
[fidelity.careful.gnss]
rate_hz = 1.0
[fidelity.careful.imu]
errors = "full"
[[autonomy.waypoint]]
name = "a"
p_m = [10.0, -22.0]
)";

std::vector<Companion> town() {
  return {{"town.geojson", kTown}};
}

std::vector<Companion> town_and_mission() {
  return {{"town.geojson", kTown}, {"short.toml", kMission}};
}

}  // namespace

std::vector<Format> mission_formats() {
  return {{.name = "Plan",
           .command = {"run", "short.toml", "--out", "out", "--force", "--plan", "@"},
           .read = {},
           .seeds =
               [] {
                 return written_by_canyon({"plan", "short.toml", "--for", "position", "--write", "a.plan"}, {"a.plan"},
                                          town_and_mission());
               },
           .beside = town_and_mission},
          {.name = "MissionToml",
           .command = {"scene", "info", "@"},
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{{"short.toml", kMission}, {"layered.toml", kLayered}};
               },
           .beside = town},
          {.name = "MissionSky",
           .command = {"gnss", "sky", "--scene", "@", "--xy", "-12,-22"},
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{{"short.toml", kMission}, {"layered.toml", kLayered}};
               },
           .beside = town},
          {.name = "MissionScan",
           .command = {"lidar", "scan", "--scene", "@", "--at", "-12,-22,2,0", "--azimuth-steps", "90"},
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{{"short.toml", kMission}, {"layered.toml", kLayered}};
               },
           .beside = town},
          {.name = "MissionRun",
           .command = {"run", "@", "--fidelity", "low", "--out", "results"},
           .read = {},
           .seeds =
               [] {
                 return std::vector<Seed>{{"short.toml", kMission}};
               },
           .beside = town}};
}

}  // namespace canyon::testing
