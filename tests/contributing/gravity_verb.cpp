// A verb that nobody planned, as somebody would add it: this file, its line in apps/line/verb.h and its place in the
// list of apps/line/command_line.cpp.
#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/output/json.h"
#include "canyon/core/units.h"

namespace canyon::apps {

Verb gravity_verb();

namespace {

struct Options {
  CommonOptions common;
  double lat_deg = 45.0, height_m = 0.0;
};

Result<int> run(const Options& options) {
  const Geodetic at{options.lat_deg * kDegree, 0.0, options.height_m};
  const double gravity_m_s2 = gravity_E(ecef_from_geodetic(at)).norm();
  if (options.common.json)
    std::printf("%s\n", Json{{"gravity_m_s2", gravity_m_s2}}.dump().c_str());
  else
    std::printf("%.9f m/s^2\n", gravity_m_s2);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments.option("--lat", options->lat_deg, "geodetic latitude, degrees").default_shown().within(-90.0, 90.0);
  arguments.option("--height", options->height_m, "above the ellipsoid, metres")
      .default_shown()
      .within(-500.0, 20000.0);
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb gravity_verb() {
  return {"gravity", "normal gravity at a place", "canyon gravity --lat 52.5", declare};
}

}  // namespace canyon::apps
