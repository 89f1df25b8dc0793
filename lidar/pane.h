#pragma once

namespace canyon::lidar {

/// Share of unpolarised light that a pane of glass lets through at an angle, from its share at normal incidence. Two
/// faces of refractive index 1.52 reflect by Fresnel's formulas, back and forth without interference; what the glass
/// absorbs at normal incidence it absorbs along the longer way too.
double pane_transmittance(double at_normal, double cos_incidence);

}  // namespace canyon::lidar
