#pragma once

#include <complex>
#include <span>

#include <Eigen/Core>

#include "canyon/gnss/paths/diffraction/fresnel.h"
#include "canyon/scene/surfaces/material.h"

namespace canyon::gnss {

/// One specular reflection, as polarization sees it.
struct Bounce {
  Eigen::Vector3d incoming_W;  ///< unit, direction of propagation before it
  Eigen::Vector3d normal_W;    ///< unit, towards the side of the wave
  Fresnel coefficients;
  double factor = 1.0;  ///< further loss of field, both polarizations: roughness, size
};

/// At that carrier, off a material: its slab if it has a thickness, else a half-space; its own roughness and a further
/// one, independent of it. Nothing comes back from an absorber.
Bounce bounce_off(const scene::Material& material, const Eigen::Vector3d& incoming_W, const Eigen::Vector3d& normal_W,
                  double further_roughness_m, double carrier_hz);

/// What a facet of that area reflects at most of the field that an infinite one does: area x cos(incidence) /
/// (wavelength x distance from the antenna along the way), physical optics; 1 from its first Fresnel zone on.
double finite_facet_factor(double area_m2, double cos_incidence, double wavelength_m, double distance_m);

/// Field of a right-hand circular wave of amplitude 1 after reflections, in the order of propagation.
struct CircularField {
  std::complex<double> copolar = 1.0, crosspolar = 0.0;
};

/// Between two reflections the plane of incidence turns about the way by psi, which shifts the phases of right- and
/// left-hand parts by -psi and +psi; within one, [co cross; cross co] acts on both. Phases are those relative to the
/// first and the last plane of incidence, so that one reflection gives its coefficients.
CircularField reflected_field(std::span<const Bounce> bounces);

/// Rayleigh roughness: what is left of the specular field of a surface whose height varies with standard deviation
/// `sigma_m`: exp(-2 (2 pi sigma cos(incidence) / wavelength)^2) (Ament 1953; ITU-R P.1546 and P.1411 use the same).
double roughness_factor(double sigma_m, double cos_incidence, double wavelength_m);

/// Walls whose normal's vertical part is at most this count as upright, and scatter.
inline constexpr double kUprightSlope = 0.5;
/// What is left of the mirror's field where an upright wall scatters that share of the power.
double mirror_factor(const Eigen::Vector3d& normal_W, double scattered_share);

}  // namespace canyon::gnss
