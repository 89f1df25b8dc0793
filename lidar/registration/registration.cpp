#include "canyon/lidar/registration/registration.h"

#include "canyon/lidar/files/map_files.h"
#include "canyon/lidar/registration/engine/engine_registration.h"
#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {
namespace {

#ifdef CANYON_WITH_PCL
#define CANYON_ON_PCL(make, engine) \
  { make, "CANYON_WITH_PCL", engine }
#else
#define CANYON_ON_PCL(make, engine) \
  { nullptr, "CANYON_WITH_PCL", engine }
#endif

constexpr ModelRow<RegistrationMethod> kMethods[] = {
    {"none", {make_no_registration, "", "none", false}, "believes the prior pose"},
    {"point_to_plane", {make_point_to_plane, "", "own"}, "distances across the target's planes", engine_parameters},
    {"gicp",
     {make_gicp, "", "own; the method that had this name before is pcl_shell_gicp"},
     "generalized ICP, plane to plane",
     engine_parameters},
    {"vgicp", {make_vgicp, "", "own"}, "the same onto means over voxels of 2 leaf_m", engine_parameters},
    {"pcl_shell_gicp",
     CANYON_ON_PCL(make_pcl_shell_gicp, "PCL's with own search and Newton step; had the name gicp before"),
     "PCL's generalized ICP with our search and Newton step", parameters_of<MatchingParameters>},
    {"pcl_icp_normals", CANYON_ON_PCL(make_pcl_icp_normals, "PCL's"), "PCL's ICP of points to planes",
     parameters_of<MatchingParameters>},
    {"pcl_gicp", CANYON_ON_PCL(make_pcl_gicp, "PCL's"), "PCL's generalized ICP", parameters_of<MatchingParameters>},
    {"pcl_ndt", CANYON_ON_PCL(make_pcl_ndt, "PCL's"), "PCL's normal distributions transform",
     parameters_of<MatchingParameters>},
};

constexpr ModelRow<RegistrationStatus> kStatuses[] = {
    {"converged", RegistrationStatus::kConverged, "a pose with its covariance"},
    {"not_converged", RegistrationStatus::kNotConverged,
     "it ended with more to go, or the prior leads off the surfaces"},
    {"too_few_points", RegistrationStatus::kTooFewPoints,
     "fewer than 50 in a cloud once it is thinned; pcl_shell_gicp: or matched"},
    {"degenerate", RegistrationStatus::kDegenerate, "what was matched determines no pose"},
    {"diverged", RegistrationStatus::kDiverged, "guess or solution are not finite"},
    {"ambiguous", RegistrationStatus::kAmbiguous, "another pose within the prior fits about as well"},
    {"too_little_overlap", RegistrationStatus::kTooLittleOverlap, "most of the source has nothing to be matched to"},
    {"beyond_prior", RegistrationStatus::kBeyondPrior,
     "where the surfaces have it by themselves is outside of the 99.9 % ellipsoid of their covariance and the prior's "
     "together"},
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
  f.integer("submap_keyframes", c.submap_keyframes, {1, 1000},
            "keyframes that form the target: 1 is scan to scan registration, more is scan to map");
  f.number("keyframe_distance_m", c.keyframe_distance_m, {0, 1e4}, "a new keyframe after this way");
  f.number("keyframe_angle_deg", c.keyframe_angle_deg, {0, 360}, "or after this turn");
  f.number("alignment_floor_m", c.alignment_floor_m, {1e-6, 10},
           "1-sigma of an alignment's position, per axis, beyond what its covariance says");
  f.number("alignment_floor_deg", c.alignment_floor_deg, {1e-6, 10}, "likewise of its attitude");
  f.number(
      "motion_floor_m_s", c.motion_floor_m_s, {1e-6, 100},
      "1-sigma of the motion since the keyframe before as the filter predicts it, per axis and second, beyond what "
      "its covariance says");
  f.number("motion_floor_deg_s", c.motion_floor_deg_s, {1e-6, 1000}, "likewise of its turn");
  f.number("prior_correlation_s", c.prior_correlation_s, {0, 1e6},
           "how long the error of the filter's pose stays alike: so long it counts as one piece of knowledge");
  f.file("prior_map", c.prior_map, "",
         "points of a map that was there before, in W (PCD, PLY, LAS, .bin): each keyframe is registered onto it too");
  f.number("prior_map_sigma_m", c.prior_map_sigma_m, {1e-6, 100}, "1-sigma of that map's own places, per axis");
  f.number("prior_map_sigma_deg", c.prior_map_sigma_deg, {1e-6, 10}, "likewise of its attitude");
  f.number("prior_map_correlation_m", c.prior_map_correlation_m, {0, 1e6},
           "how far on the map's error stays alike: so far it counts as one piece of knowledge");
}

ModelTable<RegistrationMethod> registration_methods() {
  return kMethods;
}

ModelTable<RegistrationStatus> registration_statuses() {
  return kStatuses;
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

Result<std::shared_ptr<const PreparedCloud>> make_prior_map(const RegistrationConfig& config,
                                                            const Registration& registration) {
  if (config.prior_map.empty()) return std::shared_ptr<const PreparedCloud>();
  CANYON_TRY(const ReadMap map, read_prior_map(config.prior_map));
  return registration.prepare(map.points);
}

}  // namespace canyon::lidar
