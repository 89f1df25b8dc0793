#pragma once

#include <optional>
#include <span>
#include <vector>

#include "canyon/core/messages.h"
#include "canyon/fusion/strapdown.h"

namespace canyon::fusion {

/// Stamps nearer than this are the same instant.
inline constexpr double kSameInstant_s = 1e-6;

/// A reference solution at an instant between its states: velocity, and attitude as the rotation from the state before,
/// through up to six states around it (Lagrange; error of sixth order in their interval), position with the velocities
/// too (cubic of Hermite) or like them where there are none. Empty outside the reference and within its gaps, intervals
/// longer than one and a half usual ones.
std::optional<NavState> reference_at(std::span<const NavState> reference, GpsTime t);

/// Where free inertial navigation can start from a reference: the first instant that both cover. That is the first
/// state of a reference that begins within the log, whether a sample ends there or not; else the log's beginning, with
/// the reference interpolated there, or in a gap of it the state after the gap. A stamp within kSameInstant_s of a
/// sample's is taken for it. Empty if nothing is in common.
std::optional<NavState> first_common_state(std::span<const NavState> reference, std::span<const ImuSample> samples);

/// The start, and the reference's states after it.
std::vector<NavState> reference_from(const NavState& start, std::span<const NavState> reference);

}  // namespace canyon::fusion
