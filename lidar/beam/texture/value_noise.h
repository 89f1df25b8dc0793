#pragma once

#include <cstdint>

#include "canyon/lidar/beam/texture/places.h"

namespace canyon::lidar {

/// What varies how much, how finely and independently of what else, by lane.
struct alignas(64) Grains {
  float widest[scene::RayPacket::kRays];  ///< half the width of what the corners of the cubes have; 0: uniform
  float per_m[scene::RayPacket::kRays];   ///< cubes per metre
  std::uint32_t key[scene::RayPacket::kRays];
};

/// How much brighter than its mean a surface is at a place: a factor from 1 - widest to 1 + widest, of mean 1.
///
/// Value noise (Perlin's lattice noise with values, Ebert et al., Texturing and Modeling, 2003, ch. 2): space is cut
/// into cubes of a grain's size, each corner has a hash of its indices and the key, uniform in [-1, 1), and between
/// corners it is linear in each coordinate. It depends on the place alone, so it is the same from every side, on every
/// pass and for any number of threads. The cubes are turned against W by a fixed irrational rotation: no wall and no
/// level ground lies along them, so that every large surface meets all of a cube and has the same standard deviation,
/// widest sqrt(8 / 81). Two places more than sqrt(3) grains apart have nothing in common. Beyond 2^31 grains from W's
/// origin it repeats, beyond 2^51 it means nothing, within the same limits.
void vary(const Places& places, const Grains& grains, float* factor);
/// The same of one place, to the bit.
float vary(const Eigen::Vector3d& p_W, float widest, float per_m, std::uint32_t key);

}  // namespace canyon::lidar
