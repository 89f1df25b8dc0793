#include "canyon/lidar/beam/firing_pattern.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::lidar {

FiringPattern::FiringPattern(BeamTable table, double rate_hz, std::size_t steps)
    : table_(std::move(table)), period_s_(1.0 / rate_hz), steps_(steps), free_running_(steps == 0) {
  CANYON_CHECK(!free_running_ || table_.cycle_s > 0, "table ", table_.name, " has no cycle to run free at");
  step_s_ = free_running_ ? table_.cycle_s : period_s_ / static_cast<double>(steps);
  firing_order_.resize(lasers());
  std::iota(firing_order_.begin(), firing_order_.end(), std::size_t{0});
  std::stable_sort(firing_order_.begin(), firing_order_.end(),
                   [&](std::size_t a, std::size_t b) { return table_.beams[a].firing_s < table_.beams[b].firing_s; });
  const auto most = static_cast<std::size_t>(std::ceil(period_s_ / step_s_)) + 2 + AimPacket::kShots;
  for (std::size_t c = 0; c < most && !table_.rosette; ++c) {
    const double azimuth = 2.0 * kPi * (static_cast<double>(c) * step_s_) / period_s_;
    cosine_.push_back(static_cast<float>(std::cos(azimuth)));
    sine_.push_back(static_cast<float>(std::sin(azimuth)));
  }
}

FiringPattern::Sweep FiringPattern::sweep(std::int64_t index) const {
  CANYON_CHECK(index >= 0, "index = ", index);
  const double last_s = table_.last_firing_s();
  const auto scan = static_cast<double>(index);
  if (!free_running_) {
    Sweep s;
    s.start_s = step_s_ - last_s - period_s_;
    s.cycles = steps_;
    s.first_cycle = static_cast<std::uint64_t>(index) * steps_;
    s.since_first_s = scan * period_s_;
    s.beams = beams(0.0);
    return s;
  }
  // Cycles m with scan * period < m * step + last <= (scan + 1) * period; to a nanosecond, so that the two borders of
  // neighbouring scans agree.
  const auto first_after = [&](double scans) {
    return static_cast<std::int64_t>(std::floor((scans * period_s_ - last_s + 1e-9) / step_s_)) + 1;
  };
  const std::int64_t first = std::max<std::int64_t>(0, first_after(scan));
  const std::int64_t end = std::max(first, first_after(scan + 1.0));
  Sweep s;
  s.since_first_s = static_cast<double>(first) * step_s_;
  s.start_s = s.since_first_s - (scan + 1.0) * period_s_;
  s.cycles = static_cast<std::size_t>(end - first);
  s.first_cycle = static_cast<std::uint64_t>(first);
  s.turn_rad = 2.0 * kPi * (s.since_first_s / period_s_ - scan);
  s.beams = beams(s.turn_rad);
  return s;
}

std::vector<HeadBeam> FiringPattern::beams(double turn_rad) const {
  std::vector<HeadBeam> out;
  for (const Beam& beam : table_.beams) {
    const double turn = turn_rad + 2.0 * kPi * beam.firing_s / period_s_;
    const double azimuth = turn + beam.azimuth_offset_rad;
    out.push_back({.cos_turn = static_cast<float>(std::cos(turn)),
                   .sin_turn = static_cast<float>(std::sin(turn)),
                   .cos_azimuth = static_cast<float>(std::cos(azimuth)),
                   .sin_azimuth = static_cast<float>(std::sin(azimuth)),
                   .cos_elevation = static_cast<float>(std::cos(beam.elevation_rad)),
                   .sin_elevation = static_cast<float>(std::sin(beam.elevation_rad)),
                   .origin_out = static_cast<float>(beam.origin_out_m),
                   .origin_left = static_cast<float>(beam.origin_left_m),
                   .origin_up = static_cast<float>(beam.origin_up_m)});
  }
  return out;
}

void FiringPattern::aim(const Sweep& sweep, std::size_t laser, std::size_t cycle, AimPacket& out) const {
  if (table_.rosette) return aim_rosette(sweep, laser, cycle, out);
  aim_head(sweep.beams[laser], {cosine_.data() + cycle, sine_.data() + cycle}, out);
}

void FiringPattern::fire(const Sweep& sweep, std::size_t laser, std::size_t cycle,
                         std::span<const PlacementPacket> placements, float late_s, float max_m,
                         scene::RayPacket* out) const {
  if (!table_.rosette)
    return fire_head(sweep.beams[laser], {cosine_.data() + cycle, sine_.data() + cycle}, placements.data(),
                     placements.size(), late_s, max_m, out);
  AimPacket aims;
  for (std::size_t k = 0; k < placements.size(); ++k) {
    aim_rosette(sweep, laser, cycle + k * AimPacket::kShots, aims);
    place_shots(aims, placements[k], late_s, max_m, out[k]);
  }
}

void FiringPattern::aim_rosette(const Sweep& sweep, std::size_t laser, std::size_t cycle, AimPacket& out) const {
  const Rosette& r = *table_.rosette;
  const double middle = 0.5 * (r.elevation_max_rad + r.elevation_min_rad);
  const double half = 0.5 * (r.elevation_max_rad - r.elevation_min_rad);
  const double share = static_cast<double>(laser) / static_cast<double>(lasers());
  for (std::size_t i = 0; i < AimPacket::kShots; ++i) {
    const double t = sweep.since_first_s + static_cast<double>(cycle + i) * step_s_ + table_.beams[laser].firing_s;
    // Whole turns are taken off first, so that angles stay small over hours.
    const double head = t * r.head_hz, swing = t * r.swing_hz + share;
    const double azimuth = 2.0 * kPi * (head - std::floor(head));
    const double elevation = middle + half * std::sin(2.0 * kPi * (swing - std::floor(swing)));
    out.direction_x[i] = static_cast<float>(-std::cos(elevation) * std::cos(azimuth));
    out.direction_y[i] = static_cast<float>(std::cos(elevation) * std::sin(azimuth));
    out.direction_z[i] = static_cast<float>(std::sin(elevation));
    out.origin_x[i] = out.origin_y[i] = out.origin_z[i] = 0.0f;
  }
}

}  // namespace canyon::lidar
