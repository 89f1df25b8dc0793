#pragma once

#include <memory>

#include "canyon/lidar/registration/registration.h"

/// Makers of the registration methods; each is defined in the method's own .cpp and has its row in
/// lidar/registration/registration.cpp.
namespace canyon::lidar {

std::unique_ptr<Registration> make_no_registration(const ModelParameters& own);
std::unique_ptr<Registration> make_gicp(const ModelParameters& own);

}  // namespace canyon::lidar
