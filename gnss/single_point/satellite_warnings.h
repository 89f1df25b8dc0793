#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/core/result.h"

namespace canyon::gnss {

/// Satellites observed without an ephemeris: told once each.
class MissingEphemerides {
 public:
  explicit MissingEphemerides(std::string file) : file_(std::move(file)) {}
  void add(SatelliteId sv, int line, GpsTime t);
  std::vector<std::string> list() const;

 private:
  struct Missing {
    int count = 0, line = 0;
    GpsTime t;
  };
  std::string file_;
  std::map<SatelliteId, Missing> by_satellite_;
};

/// Satellites that are used with something missing: told in one line, with the first epoch's number.
class Shortcomings {
 public:
  Shortcomings(std::string file, std::string what) : file_(std::move(file)), what_(std::move(what)) {}
  void add(SatelliteId sv, int line);
  void append_to(std::vector<std::string>& warnings) const;

 private:
  std::string file_, what_;
  int line_ = 0;
  std::set<SatelliteId> satellites_;
};

}  // namespace canyon::gnss
