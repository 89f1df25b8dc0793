#pragma once

#include <memory>

#include "canyon/lidar/registration/registration.h"

/// Makers of the registration methods; each is defined in the method's own .cpp and has its row in
/// lidar/registration/registration.cpp.
namespace canyon::lidar {

std::unique_ptr<Registration> make_no_registration(const ModelParameters& own);
std::unique_ptr<Registration> make_point_to_plane(const ModelParameters& own);
std::unique_ptr<Registration> make_gicp(const ModelParameters& own);
std::unique_ptr<Registration> make_vgicp(const ModelParameters& own);
std::unique_ptr<Registration> make_pcl_shell_gicp(const ModelParameters& own);
std::unique_ptr<Registration> make_pcl_icp_normals(const ModelParameters& own);
std::unique_ptr<Registration> make_pcl_gicp(const ModelParameters& own);
std::unique_ptr<Registration> make_pcl_ndt(const ModelParameters& own);

}  // namespace canyon::lidar
