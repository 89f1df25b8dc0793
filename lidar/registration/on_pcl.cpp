// The rows that stand on PCL; what they do is in its part.
#include "canyon/lidar/registration/pcl_part.h"
#include "canyon/lidar/registration/registration_methods.h"

namespace canyon::lidar {
namespace {

const PclPart& pcl_part() {
  return library_part("pcl", &canyon_pcl_part);
}

}  // namespace

std::unique_ptr<Registration> make_pcl_shell_gicp(const ModelParameters& own) {
  return pcl_part().make_shell_gicp(own.get<MatchingParameters>());
}
std::unique_ptr<Registration> make_pcl_icp_normals(const ModelParameters& own) {
  return pcl_part().make_icp_normals(own.get<MatchingParameters>());
}
std::unique_ptr<Registration> make_pcl_gicp(const ModelParameters& own) {
  return pcl_part().make_gicp(own.get<MatchingParameters>());
}
std::unique_ptr<Registration> make_pcl_ndt(const ModelParameters& own) {
  return pcl_part().make_ndt(own.get<MatchingParameters>());
}

}  // namespace canyon::lidar
