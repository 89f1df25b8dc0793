#include "canyon/lidar/registration/registration.h"

#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {
namespace {

constexpr ModelRow<RegistrationMethod> kMethods[] = {
    {"none", {make_no_registration, "", false}, "believes the prior pose"},
#ifdef CANYON_WITH_PCL
    {"gicp",
     {make_gicp, "CANYON_WITH_PCL"},
     "generalized ICP, plane to plane (PCL)",
     parameters_of<MatchingParameters>},
#else
    {"gicp", {nullptr, "CANYON_WITH_PCL"}, "generalized ICP, plane to plane (PCL)", parameters_of<MatchingParameters>},
#endif
};

}  // namespace

void visit(FieldVisitor& f, MatchingParameters& c) {
  f.number("leaf_m", c.leaf_m, {0.01, 100}, "voxel size to which both clouds are thinned");
  f.number("max_correspondence_m", c.max_correspondence_m, {0.01, 100}, "points farther apart are not matched");
  f.integer("max_iterations", c.max_iterations, {1, 1000}, "rounds of matching");
}

void visit(FieldVisitor& f, RegistrationConfig& c) {
  // Every known method is a valid choice here; make_registration says what this build can do.
  visit_choice(f, "method", c.method, "how keyframes are registered onto the map");
  f.integer("submap_keyframes", c.submap_keyframes, {1, 1000}, "keyframes that form the target");
  f.number("keyframe_distance_m", c.keyframe_distance_m, {0, 1e4}, "a new keyframe after this way");
  f.number("keyframe_angle_deg", c.keyframe_angle_deg, {0, 360}, "or after this turn");
  f.number("alignment_floor_m", c.alignment_floor_m, {1e-6, 10},
           "1-sigma of an alignment's position, per axis, beyond what its covariance says");
  f.number("alignment_floor_deg", c.alignment_floor_deg, {1e-6, 10}, "likewise of its attitude");
  f.number("prior_correlation_s", c.prior_correlation_s, {0, 1e6},
           "how long the error of the filter's pose stays alike: so long it counts as one piece of knowledge");
}

ModelTable<RegistrationMethod> registration_methods() {
  return kMethods;
}

bool registers(const RegistrationConfig& config) {
  return model_row(registration_methods(), config.method.name).make.registers;
}

Result<std::unique_ptr<Registration>> make_registration(const RegistrationConfig& config) {
  CANYON_TRY(const auto* row, config.method.row("registration.method"));
  if (row->make.make != nullptr) return row->make.make(config.method.own);
  return Error{"", 0, "registration.method", '"' + config.method.name + "\" was not compiled in",
               std::string("a build with ") + row->make.build_option + "=ON"};
}

}  // namespace canyon::lidar
