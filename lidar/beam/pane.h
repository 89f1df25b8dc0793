#pragma once

namespace canyon::lidar {

/// Share of unpolarised light that a pane of glass lets through at an angle, from its share at normal incidence. Two
/// faces of refractive index 1.52 reflect by Fresnel's formulas, back and forth without interference; what the glass
/// absorbs at normal incidence it absorbs along the longer way too. `at_normal` is 0..1; beyond 0.918, what two such
/// faces let through, the pane is coated: it absorbs nothing and dims with the angle all the same. `cos_incidence` is
/// 0..1.
double pane_transmittance(double at_normal, double cos_incidence);

}  // namespace canyon::lidar
