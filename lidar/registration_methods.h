#pragma once

#include <memory>

#include "lidar/registration.h"

/// Makers of the registration methods; each is defined in the method's own .cpp and has its row in
/// lidar/registration.cpp.
namespace canyon::lidar {

std::unique_ptr<Registration> make_no_registration(const RegistrationConfig& config);
std::unique_ptr<Registration> make_gicp(const RegistrationConfig& config);  // lidar/pcl_gicp.cpp

}  // namespace canyon::lidar
