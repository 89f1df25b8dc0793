#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"

/// A configuration with a field of every kind, for the tests of the reader and the writers.
namespace canyon::config_example {

struct Waypoint {
  Eigen::Vector2d at_m{std::nan(""), std::nan("")};  // required
  double stop_s = 5.0;
};

inline void visit(FieldVisitor& f, Waypoint& c) {
  f.vector2("at_m", c.at_m, kAnyNumber, "east and north");
  f.number("stop_s", c.stop_s, kNotNegative, "time to stop");
}

struct Gnss {
  double rate_hz = 1.0;
  double sigma_m = 0.23;
  std::int64_t channels = 12;
  std::string receiver = "high";
  std::vector<std::string> systems = {"GPS"};
};

inline void visit(FieldVisitor& f, Gnss& c) {
  f.number("rate_hz", c.rate_hz, {0.1, 20}, "fixes per second");
  f.number("sigma_m", c.sigma_m, kPositive, "of one axis");
  f.integer("channels", c.channels, {1, 64}, "satellites at once");
  f.choice("receiver", c.receiver, {"low", "paper", "high"}, "model");
  f.texts("systems", c.systems, "constellations");
}

struct Mission {
  std::string title = "recon";
  bool loop = false;
  Eigen::Vector3d lever_m{0.1, 0.2, 0.3};
  std::vector<double> levels{0.5};
  std::string map = "city";
  std::vector<std::string> logs;
  Gnss gnss;
  std::vector<Waypoint> waypoint;
};

inline void visit(FieldVisitor& f, Mission& c) {
  f.text("title", c.title, "name of the mission");
  f.flag("loop", c.loop, "drive it again");
  f.vector3("lever_m", c.lever_m, {-10, 10}, "antenna in B");
  f.numbers("levels", c.levels, 0, {0, 1}, "any | several");
  f.file("map", c.map, ".osm", "where to drive");
  f.files("logs", c.logs, "what to replay");
  f.group("gnss", c.gnss, "receiver");
  f.list("waypoint", c.waypoint, "places to go");
}

}  // namespace canyon::config_example
