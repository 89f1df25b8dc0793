#pragma once

#include <memory>

#include "canyon/fusion/strapdown.h"

/// Makers of the rows of the table in fusion/strapdown.cpp, each in the file of its model.
namespace canyon::fusion {

std::unique_ptr<Strapdown> make_euler(GravityFunction gravity);
std::unique_ptr<Strapdown> make_trapezoid(GravityFunction gravity);
std::unique_ptr<Strapdown> make_constant_rate(GravityFunction gravity);
std::unique_ptr<Strapdown> make_two_sample(GravityFunction gravity);
std::unique_ptr<Strapdown> make_three_sample(GravityFunction gravity);

/// The part that all but three_sample share: moves `state` by what `step` says happened in U. E turns by w_IE dt
/// exactly, if it does; gravity and Coriolis are taken at the middle of the interval. Position is the trapezoid of
/// velocity plus `bend_start_U`: by how much the double integral of the force, expressed in U at the start, differs
/// from dv dt / 2.
void move(NavState& state, const InertialStep& step, double dt_s, GravityFunction gravity, bool earth_turns = true,
          const Eigen::Vector3d& bend_start_U = Eigen::Vector3d::Zero());

/// Throws for coning, of a row that has none.
void check_has_no_coning(const StrapdownOmissions& omissions);

}  // namespace canyon::fusion
