#include "canyon/lidar/registration/registration.h"

#include "canyon/core/config/text.h"
#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {
namespace {

struct Row {
  const char* name;
  std::unique_ptr<Registration> (*make)(const RegistrationConfig&);  ///< nullptr: left out when Canyon was built
  const char* needs;                                                 ///< the build option
  const char* doc;
};

constexpr Row kMethods[] = {
    {"none", &make_no_registration, "", "believes the prior pose"},
#ifdef CANYON_WITH_PCL
    {"gicp", &make_gicp, "CANYON_WITH_PCL", "generalized ICP, plane to plane (PCL)"},
#else
    {"gicp", nullptr, "CANYON_WITH_PCL", "generalized ICP, plane to plane (PCL)"},
#endif
};

}  // namespace

void visit(FieldVisitor& f, RegistrationConfig& c) {
  // Every known method is a valid choice here; make_registration says what this build can do.
  std::vector<std::string> known;
  for (const Row& row : kMethods) known.emplace_back(row.name);
  f.choice("method", c.method, known, "how keyframes are registered onto the map");
  f.number("leaf_m", c.leaf_m, {0.01, 100}, "voxel size to which both clouds are thinned");
  f.number("max_correspondence_m", c.max_correspondence_m, {0.01, 100}, "points farther apart are not matched");
  f.integer("max_iterations", c.max_iterations, {1, 1000}, "rounds of matching");
  f.integer("submap_keyframes", c.submap_keyframes, {1, 1000}, "keyframes that form the target");
  f.number("keyframe_distance_m", c.keyframe_distance_m, {0, 1e4}, "a new keyframe after this way");
  f.number("keyframe_angle_deg", c.keyframe_angle_deg, {0, 360}, "or after this turn");
  f.number("alignment_floor_m", c.alignment_floor_m, {1e-6, 10},
           "1-sigma of an alignment's position, per axis, beyond what its covariance says");
  f.number("alignment_floor_deg", c.alignment_floor_deg, {1e-6, 10}, "likewise of its attitude");
  f.number("prior_correlation_s", c.prior_correlation_s, {0, 1e6},
           "how long the error of the filter's pose stays alike: so long it counts as one piece of knowledge");
}

Result<std::unique_ptr<Registration>> make_registration(const RegistrationConfig& config) {
  for (const Row& row : kMethods) {
    if (config.method != row.name) continue;
    if (row.make) return row.make(config);
    return Error{"", 0, "registration.method", '"' + config.method + "\" was not compiled in",
                 "one of " + plain_list(registration_methods()) + " (build with " + row.needs + "=ON)"};
  }
  return Error{"", 0, "registration.method", "unknown method \"" + config.method + '"',
               "one of " + plain_list(registration_methods())};
}

std::vector<std::string> registration_methods() {
  std::vector<std::string> names;
  for (const Row& row : kMethods) {
    if (row.make) names.emplace_back(row.name);
  }
  return names;
}

}  // namespace canyon::lidar
