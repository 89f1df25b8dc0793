#pragma once

#include <string>

#include "canyon/gnss/single_point/single_point.h"

namespace canyon::gnss {

/// One row per epoch, solved or not: gps_week,sow,x_m,y_m,z_m,status,satellites,gdop,pdop,hdop,vdop,tdop,excluded,
/// sigma_e_m,sigma_n_m,sigma_u_m,clock_m,vx_m_s,vy_m_s,vz_m_s, the covariances of place and velocity in E (xx_m2, ...,
/// vzz_m2_s2; upper triangles, row by row), reason. status: single, differential or none; what is not known is empty.
/// core/tables/state_table.h reads it.
std::string solution_csv(const SinglePointResult& result);

}  // namespace canyon::gnss
